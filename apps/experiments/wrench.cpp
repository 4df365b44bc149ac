// Force and torque against closed forms.
#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/local_model.hpp"
#include "experiments/experiment_list.hpp"
#include "experiments/statistics.hpp"
#include "experiments/trial.hpp"
#include "experiments/wrench_cages.hpp"
#include "experiments/wrench_scenes.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::experiments {
namespace {

constexpr int kMoveTicks = 300, kRestTicks = 400, kWatchedTicks = 300;
// By these lengths (m) a torque that should not be there is compared with the force, and the other way round.
constexpr double kLever = 0.01;
struct Reading {
  double expected = 0, measured = 0;  // magnitude of the force, or of the torque where no force is expected: N or N·m
  double magnitude = 0;               // relative error of force and torque, the larger one
  double direction = 0;               // angle between, rad, the larger one
  double stray = 0;                   // what should be zero, by what is there
  double balance = 0;                 // what is felt less the sum of the contact forces, by what is felt
  double noise = 0;                   // standard deviation of the force and torque by their size, still pen
};

/// The larger one; NaN when either is.
double larger(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::quiet_NaN() : std::max(a, b);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void compare(const Vec3& expected, const Vec3& measured, Reading& r) {
  r.magnitude = std::max(r.magnitude, std::abs(measured.norm() / expected.norm() - 1));
  r.direction = std::max(r.direction, angle_between(expected, measured));
}

Reading read(const WrenchScene& w, const Probe& probe, const std::string& resolver) {
  Scene scene = w.scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  HapticLoop loop(scene);
  const Pose from = held_part(scene).pose;
  const Displacement way = displacement(from, probe.Y, Vec3::Zero());
  LocalModel servo;
  std::vector<double> force, torque;
  Wrench mean;
  for (int tick = 1; tick <= kMoveTicks + kRestTicks + kWatchedTicks; ++tick) {
    const Pose Y =
        tick < kMoveTicks ? displaced(from, Vec3::Zero(), static_cast<double>(tick) / kMoveTicks * way) : probe.Y;
    const TickReport& report = loop.step(Y, 1e-3);
    if (tick <= kMoveTicks + kRestTicks) continue;
    // As the servo has it.
    ProxyState x = report.proxy;
    servo.update(report.planes, coupling_radius(scene.coupling), loop.center(), Y, {}, x);
    const Wrench now = coupling_wrench(scene.coupling, x, Y, {}, loop.center());
    mean.force += now.force / kWatchedTicks;
    mean.torque += now.torque / kWatchedTicks;
    force.push_back(now.force.norm());
    torque.push_back(now.torque.norm());
  }
  Reading r;
  const Wrench& e = probe.expected;
  const double size = e.force.norm() + e.torque.norm() / kLever;
  const bool pushes = e.force.norm() > 0, turns = e.torque.norm() > 0;
  r.expected = pushes ? e.force.norm() : e.torque.norm();
  r.measured = pushes ? mean.force.norm() : mean.torque.norm();
  if (pushes) compare(e.force, mean.force, r);
  if (turns) compare(e.torque, mean.torque, r);
  if (!pushes) r.stray = mean.force.norm() / size;
  if (!turns) r.stray = std::max(r.stray, mean.torque.norm() / kLever / size);
  const ContactForces& exerted = loop.report().forces;
  const Wrench sum = exerted.sum(loop.report().proxy.X * loop.center());
  r.balance = exerted.count == 0
                  ? std::numeric_limits<double>::quiet_NaN()
                  : ((sum.force - mean.force).norm() + (sum.torque - mean.torque).norm() / kLever) / size;
  r.noise = (spread(force).deviation + spread(torque).deviation / kLever) / size;
  return r;
}

template <typename F>
double worst(const std::vector<Reading>& readings, F value) {
  double most = 0;
  for (const Reading& r : readings) most = std::isfinite(value(r)) ? std::max(most, value(r)) : value(r);
  return most;
}

struct Worst {
  double magnitude, direction, stray, balance, noise;
};

Worst worst_of(const std::vector<Reading>& r) {
  return {100 * worst(r, [](const Reading& x) { return x.magnitude; }),
          180 / M_PI * worst(r, [](const Reading& x) { return x.direction; }),
          100 * worst(r, [](const Reading& x) { return x.stray; }),
          100 * worst(r, [](const Reading& x) { return x.balance; }),
          100 * worst(r, [](const Reading& x) { return x.noise; })};
}

/// By resolver, scene and probe.
std::vector<std::vector<std::vector<Reading>>> read_all(const Work& work, const std::vector<std::string>& names,
                                                        const std::vector<WrenchScene>& scenes) {
  std::vector<std::vector<std::vector<Reading>>> all(names.size());
  struct Job {
    std::size_t resolver, scene, probe;
  };
  std::vector<Job> jobs;
  for (std::size_t r = 0; r < names.size(); ++r) {
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      all[r].emplace_back(scenes[s].probes.size());
      for (std::size_t p = 0; p < scenes[s].probes.size(); ++p) jobs.push_back({r, s, p});
    }
  }
  work.each("wrench", static_cast<int>(jobs.size()), [&](int i) {
    const Job& j = jobs[static_cast<std::size_t>(i)];
    all[j.resolver][j.scene][j.probe] = read(scenes[j.scene], scenes[j.scene].probes[j.probe], names[j.resolver]);
  });
  return all;
}

}  // namespace

Outcome wrench(const Work& work) {
  // The baselines answer no such question: one bounces, the other yields by design.
  const std::vector<std::string> names = {"qp", "lp"};
  std::vector<WrenchScene> scenes = wrench_scenes(work.seeds(8, 2));
  for (WrenchScene& cage : cage_scenes(work.seeds(8, 2))) scenes.push_back(std::move(cage));
  const auto all = read_all(work, names, scenes);

  Outcome out;
  out.title = "Wrench: force and torque against closed forms";
  out.intro =
      "The pen is brought to places where geometry and the coupling's springs alone say what it must feel, and held "
      "there. "
      "Magnitude: relative error of force and torque. Direction: the angle to the true one. Stray: force or torque "
      "that "
      "should be zero, by what is there (a torque counts as the force at 10 mm). Balance: what is felt less the sum of "
      "the contact forces at their places, by what is felt (lp has none to tell). Noise: standard deviation under the "
      "still pen. What is left is the gap that contacts keep (2 µm of the spring's millimeters) and the facets: a ball "
      "of 192 facets touches up to 0.16 mm beside the line through its center, and feels the torque of that.";
  Csv csv{"wrench",
          {"resolver", "scene", "probe", "expected", "measured", "magnitude_error_percent", "direction_error_deg",
           "stray_percent", "balance_percent", "noise_percent"}};
  Worst own{0, 0, 0, 0, 0};
  Section section{"Scenes", "", {}, {}};
  Plot plot{"worst error of the magnitude, by scene", {"scene", false, true}, {"error (%)", true}, {}};
  for (std::size_t r = 0; r < names.size(); ++r) plot.series.push_back({names[r], {}, {}, {}, {}, true});
  std::string legend;
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    Table t{std::to_string(s + 1) + ": " + scenes[s].name + " (" + scenes[s].formula + ")",
            {"resolver", "magnitude (%)", "direction (°)", "stray (%)", "balance (%)", "noise (%)"}};
    for (std::size_t r = 0; r < names.size(); ++r) {
      const Worst w = worst_of(all[r][s]);
      t.rows.push_back({names[r], w.magnitude, w.direction, w.stray, w.balance, w.noise});
      plot.series[r].x.push_back(static_cast<double>(s + 1) + 0.08 * static_cast<double>(r));
      plot.series[r].y.push_back(std::max(w.magnitude, 1e-4));
      if (r == 0)
        own = {std::max(own.magnitude, w.magnitude), std::max(own.direction, w.direction), std::max(own.stray, w.stray),
               larger(own.balance, w.balance), std::max(own.noise, w.noise)};
      for (std::size_t p = 0; p < all[r][s].size(); ++p) {
        const Reading& x = all[r][s][p];
        csv.rows.push_back({names[r], scenes[s].name, p, x.expected, x.measured, 100 * x.magnitude,
                            180 / M_PI * x.direction, 100 * x.stray, 100 * x.balance, 100 * x.noise});
      }
    }
    section.tables.push_back(t);
  }
  section.text = "Worst of " + std::to_string(scenes[0].probes.size()) + " places in each scene.";
  section.plots = {plot};
  out.claims = {at_most(names[0] + ": magnitude", own.magnitude, 1, "%"),
                at_most(names[0] + ": direction", own.direction, 0.5, "°"),
                at_most(names[0] + ": stray force or torque", own.stray, 1, "%"),
                at_most(names[0] + ": felt less the sum of the contact forces", own.balance, 1, "%"),
                at_most(names[0] + ": noise under a still pen", own.noise, 0.1, "%")};
  out.sections = {section};
  out.csv = {csv};
  return out;
}

}  // namespace tegotae::experiments
