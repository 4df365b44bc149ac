// The paper's figure 10: the same script for every resolver.
#include <algorithm>
#include <cmath>

#include "device/script_hand.hpp"
#include "experiments/experiment_list.hpp"
#include "experiments/statistics.hpp"
#include "experiments/trial.hpp"
#include "peg_in_hole/peg_scene.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kForceVibrationHz = 30;
// Stalled: slower than this (m/s, over so many ticks) while the pen is at least so far ahead (m).
constexpr double kStallSpeed = 1e-3, kAhead = 0.5e-3;
constexpr std::size_t kStallTicks = 20;
constexpr double kTip = 0.025;       // from the peg's center to its tip, m
constexpr double kHoleDepth = 0.04;  // depth of the hole, m

struct Run {
  std::vector<Sample> samples;
  double vibration = 0, force_vibration = 0;  // m, N
  double stalled = 0;                         // s
  double speed = 0;                           // from the tip's to the center's reaching the surface, m/s
  double depth = 0;                           // of the tip at the end, m
  std::int64_t intersecting = 0;
};

Run measure(const SceneFile& file, const std::string& resolver) {
  Scene scene = file.scene;
  scene.contact.resolver = resolver_kind(resolver);
  ScriptHand hand(file.script);
  Run r;
  r.samples = run_trial(scene, file.device, hand, nullptr, file.script.end() + kSettleTime, nullptr);
  const auto tip = [](const Sample& s) { return (s.X * Vec3(0, 0, -kTip)).z(); };
  std::vector<Vec3> center, force;
  double at_surface = NAN, center_in = NAN;
  for (std::size_t i = 0; i < r.samples.size(); ++i) {
    const Sample& s = r.samples[i];
    if (std::isnan(at_surface) && tip(s) <= 0) at_surface = s.t;
    if (std::isnan(center_in) && s.center.z() <= 0) center_in = s.t;
    if (std::isnan(at_surface)) continue;
    center.push_back(s.center);
    force.push_back(s.wrench.force);
    if (i < kStallTicks || tip(s) < -kHoleDepth + 1e-3) continue;
    const double way = r.samples[i - kStallTicks].center.z() - s.center.z();
    if (way < kStallSpeed * 1e-3 * kStallTicks && s.X.p.z() - s.Y.p.z() > kAhead) r.stalled += 1e-3;
  }
  r.vibration = rms_above(center, 1e-3, kForceVibrationHz);
  r.force_vibration = rms_above(force, 1e-3, kForceVibrationHz);
  r.speed = kTip / (center_in - at_surface);
  r.depth = -tip(r.samples.back());
  r.intersecting = count_intersecting(scene, r.samples, 400);
  return r;
}

template <typename F>
Plot over_time(const std::string& title, const std::string& label, const std::vector<std::string>& names,
               const std::vector<Run>& runs, double from, double to, F value) {
  Plot p{title, {"time (s)"}, {label}, {}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    Series s{names[i], {}, {}};
    for (const Sample& a : runs[i].samples) {
      if (a.t < from || a.t > to) continue;
      s.x.push_back(a.t);
      s.y.push_back(value(a));
    }
    thin(s, 1400);
    p.series.push_back(s);
  }
  return p;
}

Section section(double ratio, const std::vector<std::string>& names, const std::vector<Run>& runs) {
  Section s{
      "Ratio " + apps::ratio_text(ratio),
      "The hand misses the hole by two millimeters and three degrees, slides over the rim (1.6 to 2.4 s), goes in "
      "tilted until it jams (3.2 s), straightens up, and rocks its way to the bottom.",
      {}};
  s.plots.push_back(over_time("depth of the center of mass", "z (mm)", names, runs, 1, 8,
                              [](const Sample& a) { return 1e3 * a.center.z(); }));
  s.plots.push_back(
      over_time("sideways", "x (mm)", names, runs, 1, 8, [](const Sample& a) { return 1e3 * a.center.x(); }));
  Plot trace{"path of the center of mass", {"x (mm)"}, {"z (mm)"}, {}, true};
  for (std::size_t i = 0; i < names.size(); ++i) {
    Series path{names[i], {}, {}};
    for (const Sample& a : runs[i].samples) {
      if (a.t < 1) continue;
      path.x.push_back(1e3 * a.center.x());
      path.y.push_back(1e3 * a.center.z());
    }
    thin(path, 1400);
    trace.series.push_back(path);
  }
  s.plots.push_back(trace);
  s.plots.push_back(over_time("force on the pen while it rocks", "force (N)", names, runs, 4.8, 5.8,
                              [](const Sample& a) { return a.wrench.force.norm(); }));
  Table t{"",
          {"resolver", "vibration of the center (µm)", "vibration of the force (mN)", "stalled (s)",
           "insertion speed (mm/s)", "depth at the end (mm)", "intersecting poses"}};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Run& r = runs[i];
    t.rows.push_back({names[i], 1e6 * r.vibration, 1e3 * r.force_vibration, r.stalled, 1e3 * r.speed, 1e3 * r.depth,
                      r.intersecting});
  }
  s.tables.push_back(t);
  return s;
}

Csv csv_of(double ratio, const std::string& name, const Run& run) {
  Csv csv{"insertion_" + apps::ratio_text(ratio) + "_" + name,
          {"t_s", "x_mm", "y_mm", "z_mm", "pen_z_mm", "fx_n", "fy_n", "fz_n", "contacts"}};
  for (const Sample& a : run.samples)
    csv.rows.push_back({a.t, 1e3 * a.center.x(), 1e3 * a.center.y(), 1e3 * a.center.z(), 1e3 * a.Y.p.z(),
                        a.wrench.force.x(), a.wrench.force.y(), a.wrench.force.z(), a.contacts});
  return csv;
}

}  // namespace

Outcome insertion(const Work& work) {
  const std::vector<std::string> names = resolvers();
  const std::vector<double> ratios = work.options.quick ? std::vector<double>{0.94} : std::vector<double>{0.94, 0.99};
  std::vector<std::vector<Run>> runs(ratios.size(), std::vector<Run>(names.size()));
  std::vector<SceneFile> files;
  for (const double ratio : ratios) files.push_back(apps::make_peg_scene(ratio));
  const int n = static_cast<int>(names.size());
  work.each("insertion", n * static_cast<int>(ratios.size()), [&](int i) {
    const std::size_t k = static_cast<std::size_t>(i / n), r = static_cast<std::size_t>(i % n);
    runs[k][r] = measure(files[k], names[r]);
  });
  Outcome out;
  out.title = "Insertion: one script, every resolver";
  out.intro =
      "The path of the peg's center of mass while a scripted hand carries it into its hole (20 mm), as in the paper's "
      "figure 10. The paper found its linear program smooth and the impulse method vibrating and slow. Vibration is "
      "what "
      "is above 30 Hz, root mean square, from the tip's reaching the surface on; stalled is the time at less than 1 "
      "mm/s "
      "with the pen at least 0.5 mm ahead; the insertion speed is that from the tip's to the center's reaching the "
      "surface.";
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    const Run& first = runs[k][0];
    const std::string at = " at " + apps::ratio_text(ratios[k]);
    out.claims.push_back(at_least(names[0] + ": depth at the end" + at, 1e3 * first.depth, 39.9, "mm"));
    out.claims.push_back(
        at_most(names[0] + ": intersecting poses" + at, static_cast<double>(first.intersecting), 0, ""));
    out.sections.push_back(section(ratios[k], names, runs[k]));
    for (std::size_t r = 0; r < names.size(); ++r) {
      out.csv.push_back(csv_of(ratios[k], names[r], runs[k][r]));
      if (names[r] != "impulse") continue;
      out.claims.push_back(
          at_most(names[0] + ": stalled against impulse" + at, first.stalled - runs[k][r].stalled, 0, "s"));
    }
  }
  return out;
}

}  // namespace tegotae::experiments
