// The paper's tasks again, with friction: how long they take, how tight it can go, and why what stays out does.
#include <algorithm>
#include <cmath>

#include "experiments/experiment_list.hpp"
#include "experiments/friction_peg.hpp"
#include "experiments/peg_task.hpp"
#include "experiments/statistics.hpp"
#include "peg_in_hole/peg_scene.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kHole = 0.02;  // m
constexpr double kGiveUp = 15;  // s after the tip's reaching the surface
const std::vector<double> kMus = {0, 0.1, 0.3};

/// One operator's try on a rung.
struct Try {
  double mu = 0, ratio = 0;
  std::size_t person = 0;
  int start = 0;
  Attempt attempt{};
  double depth = 0;     ///< of the tip at the end, m
  double force = 0;     ///< the most that the hand felt, N
  bool wedged = false;  ///< what stayed out: the hand's push is one that jams by Whitney's condition
};

/// Whether the pen's push at the end is one under which a peg in two-point contact jams, in the plane of its moment.
bool is_wedged(const PegTask& peg, const Sample& s, double mu) {
  const Vec3 push = -s.wrench.force, tip = s.X * peg.tip();
  const double depth = -tip.z(), radius = 0.5 * kHole;
  if (!(mu > 0) || depth <= 0 || !(push.z() < 0)) return false;
  const Vec3 moment = -s.wrench.torque + (s.center - tip).cross(push);
  const Vec3 about = Vec3(moment.x(), moment.y(), 0);
  if (!(about.norm() > 0)) return false;
  // As jam_map() has its axes: side along x, moment about -y.
  const Vec3 across = -about.normalized(), side = across.cross(Vec3::UnitZ());
  const double into = -push.z();
  return !whitney_slides(depth / (2 * radius * mu), mu, push.dot(side) / into, -moment.dot(across) / (radius * into));
}

std::vector<Try> try_all(const Work& work, const std::vector<double>& ratios, int starts) {
  std::vector<Try> all;
  for (const double mu : kMus)
    for (std::size_t k = ratios.size(); k-- > 0;)
      for (std::size_t person = 0; person < operator_profiles().size(); ++person)
        for (int s = starts; s-- > 0;) all.push_back({mu, ratios[k], person, s});
  std::vector<PegTask> pegs;
  for (const double ratio : ratios) pegs.emplace_back(ratio, "qp");
  work.each("ladder with friction", static_cast<int>(all.size()), [&](int i) {
    Try& t = all[static_cast<std::size_t>(i)];
    PegTask peg = pegs[static_cast<std::size_t>(std::find(ratios.begin(), ratios.end(), t.ratio) - ratios.begin())];
    peg.set_friction(t.mu);
    t.attempt = attempt(peg, operator_profiles()[t.person], peg.tilted_task(t.person, t.start, starts),
                        static_cast<std::uint64_t>(t.start), kGiveUp, false);
    for (const Sample& s : t.attempt.samples) t.force = std::max(t.force, s.wrench.force.norm());
    if (!t.attempt.samples.empty()) {
      const Sample& last = t.attempt.samples.back();
      t.depth = -(last.X * peg.tip()).z();
      // What the hand does while it is stuck: it wiggles, so any of its pushes in the last half second counts.
      const std::size_t n = t.attempt.samples.size();
      for (std::size_t k = n > 500 ? n - 500 : 0; k < n && !t.attempt.completed; ++k)
        t.wedged = t.wedged || is_wedged(peg, t.attempt.samples[k], t.mu);
    }
    t.attempt.samples = {};
  });
  return all;
}

struct Rung {
  int tries = 0, completed = 0, out = 0, wedged = 0;
  double penetration = 0, force = 0;
  std::int64_t intersecting = 0;
  std::vector<double> time{}, vibration{};
};

Rung rung_of(const std::vector<Try>& all, double mu, double ratio) {
  Rung g;
  for (const Try& t : all) {
    if (t.mu != mu || t.ratio != ratio) continue;
    ++g.tries;
    g.completed += t.attempt.completed ? 1 : 0;
    g.out += t.attempt.completed ? 0 : 1;
    g.wedged += t.wedged ? 1 : 0;
    g.penetration = std::max(g.penetration, t.attempt.penetration);
    g.force = std::max(g.force, t.force);
    g.intersecting += t.attempt.intersecting;
    if (t.attempt.completed) g.time.push_back(t.attempt.time_to_bottom);
    g.vibration.push_back(t.attempt.vibration);
  }
  return g;
}

std::string mu_text(double mu) {
  return "mu " + nlohmann::json(mu).dump();
}

void add_ladder(const Work& work, Outcome& out) {
  const std::vector<double> ratios = work.options.quick
                                         ? std::vector<double>{0.99}
                                         : std::vector<double>{0.91, 0.94, 0.987, 0.99, 0.995, 0.999, 0.9995};
  const std::vector<Try> all = try_all(work, ratios, work.seeds(8, 1));
  Csv csv{"ladder",
          {"mu", "ratio", "operator", "start", "completed", "time_s", "depth_mm", "force_max_n", "wedged",
           "penetration_um", "intersecting"},
          {}};
  for (const Try& t : all)
    csv.rows.push_back({t.mu, t.ratio, operator_profiles()[t.person].name, t.start, t.attempt.completed ? 1 : 0,
                        t.attempt.time_to_bottom, 1e3 * t.depth, t.force, t.wedged ? 1 : 0, 1e6 * t.attempt.penetration,
                        t.attempt.intersecting});
  Table table{"",
              {"ratio", "mu", "completed", "out and wedged (Whitney)", "time to the bottom (s)", "jitter (µm)",
               "largest force (N)", "deepest penetration (µm)", "intersecting poses"}};
  Plot completed{"completed", {"diametral clearance (µm)", true}, {"completed (%)", false, false, true}, {}};
  Plot times{"time to the bottom, of those completed", {"diametral clearance (µm)", true}, {"time (s)"}, {}};
  double worst = 100, penetration = 0;
  std::int64_t intersecting = 0;
  int out_at_tenth = 0, wedged_at_tenth = 0;
  for (const double mu : kMus) {
    Series in{mu_text(mu), {}, {}}, time{mu_text(mu), {}, {}};
    for (const double ratio : ratios) {
      const Rung g = rung_of(all, mu, ratio);
      const double share = 100.0 * g.completed / g.tries;
      in.x.push_back(1e6 * kHole * (1 - ratio));
      in.y.push_back(share);
      time.x.push_back(in.x.back());
      time.y.push_back(spread(g.time).mean);
      if (mu == 0.1) {
        worst = std::min(worst, share);
        out_at_tenth += g.out;
        wedged_at_tenth += g.wedged;
      }
      penetration = std::max(penetration, g.penetration);
      intersecting += g.intersecting;
      table.rows.push_back({apps::ratio_text(ratio), mu, std::to_string(g.completed) + " of " + std::to_string(g.tries),
                            std::to_string(g.wedged) + " of " + std::to_string(g.out), time.y.back(),
                            1e6 * spread(g.vibration).mean, g.force, 1e6 * g.penetration, g.intersecting});
    }
    completed.series.push_back(in);
    times.series.push_back(time);
  }
  out.claims.push_back(at_least("ladder, mu 0.1: completed on the worst rung", worst, 95, "%"));
  out.claims.push_back(
      at_most("ladder, mu 0.1: out and not wedged by Whitney's condition", out_at_tenth - wedged_at_tenth, 0, "tries"));
  out.claims.push_back(at_most("ladder: deepest penetration", 1e6 * penetration, 0, "µm"));
  out.claims.push_back(at_most("ladder: intersecting poses", static_cast<double>(intersecting), 0, ""));
  out.sections.push_back(
      {"How tight it can go",
       "The ladder's starts (tilted by up to 5°, off by up to 1 mm), three modeled operators, 15 s. A try that "
       "stayed out is wedged when a push of its last half second is one under which Whitney's peg jams.",
       {completed, times},
       {table}});
  out.csv.push_back(csv);
}

void add_task_time(const Work& work, Outcome& out) {
  const std::vector<double> ratios =
      work.options.quick ? std::vector<double>{0.94} : std::vector<double>{0.91, 0.92, 0.93, 0.94};
  const int seeds = work.seeds(12, 1);
  const std::size_t people = operator_profiles().size();
  struct Run {
    double mu, ratio;
    std::size_t person;
    int seed;
    double time = 0, vibration = 0;
  };
  std::vector<Run> runs;
  for (const double mu : kMus)
    for (const double ratio : ratios)
      for (std::size_t p = 0; p < people; ++p)
        for (int s = 0; s < seeds; ++s) runs.push_back({mu, ratio, p, s});
  std::vector<PegTask> pegs;
  for (const double ratio : ratios) pegs.emplace_back(ratio, "qp");
  work.each("task time with friction", static_cast<int>(runs.size()), [&](int i) {
    Run& r = runs[static_cast<std::size_t>(i)];
    PegTask peg = pegs[static_cast<std::size_t>(std::find(ratios.begin(), ratios.end(), r.ratio) - ratios.begin())];
    peg.set_friction(r.mu);
    const Attempt a = attempt(peg, operator_profiles()[r.person], peg.task(),
                              1000 * r.person + static_cast<std::uint64_t>(r.seed), kGiveUp, true);
    r.time = a.reached ? a.time : kGiveUp;
    r.vibration = a.vibration;
  });
  Csv csv{"task_time", {"mu", "ratio", "operator", "seed", "time_s", "vibration_um"}, {}};
  Table table{"", {"mu", "ratio", "task time (s)", "jitter (µm)"}};
  Plot plot{"task time", {"diameter of the peg by that of the hole"}, {"task time (s)"}, {}};
  for (const double mu : kMus) {
    Series s{mu_text(mu), {}, {}, {}, {}, true};
    for (const double ratio : ratios) {
      std::vector<double> time, vibration;
      for (const Run& r : runs) {
        if (r.mu != mu || r.ratio != ratio) continue;
        time.push_back(r.time);
        vibration.push_back(r.vibration);
        csv.rows.push_back({mu, ratio, operator_profiles()[r.person].name, r.seed, r.time, 1e6 * r.vibration});
      }
      const Spread one = spread(time);
      s.x.push_back(ratio + 0.002 * (mu - 0.15));
      s.y.push_back(one.mean);
      s.low.push_back(one.low);
      s.high.push_back(one.high);
      table.rows.push_back({mu, ratio, one.mean, 1e6 * spread(vibration).mean});
    }
    plot.series.push_back(s);
  }
  out.sections.push_back({"Task time",
                          "The paper's figure 11 with friction: from the tip's to the center's reaching the surface.",
                          {plot},
                          {table}});
  out.csv.push_back(csv);
}

}  // namespace

Outcome friction_tasks(const Work& work) {
  Outcome out;
  out.title = "The paper's tasks with friction";
  out.intro =
      "The default resolver, the modeled operators of the other experiments, and coefficients of 0, 0.1 and 0.3.";
  add_ladder(work, out);
  add_task_time(work, out);
  return out;
}

}  // namespace tegotae::experiments
