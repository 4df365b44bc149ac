// How tight can it go? Fits from 1.8 mm down to 10 µm of diametral clearance.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/experiment_list.hpp"
#include "experiments/peg_task.hpp"
#include "experiments/statistics.hpp"
#include "peg_scene.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kHole = 0.02, kChamfer = 0.001;      // m
constexpr double kMostTilt = 5 * 0.0174532925199433;  // rad
constexpr double kGiveUp = 15;                        // s after the tip's reaching the surface

struct Rung {
  int tries = 0, completed = 0;
  std::int64_t intersecting = 0;
  double penetration = 0;               // deepest, m
  std::vector<double> time, vibration;  // s of those completed, m
};

struct Job {
  std::size_t rung, resolver, person;
  int seed;
};

/// Start number `i` of `n`: the last one is tilted and off center as far as it may be, directions go around.
InsertionTask start(const PegTask& peg, std::size_t person, int i, int n) {
  InsertionTask task = peg.task();
  const double share = static_cast<double>(i + 1) / n;
  const double a = 2.4 * i + 1.3 * static_cast<double>(person), b = 1.1 * i + 2.1 * static_cast<double>(person);
  task.own_errors = false;
  task.tilt = share * kMostTilt * Vec3(std::cos(a), std::sin(a), 0);
  task.offset = share * kChamfer * Vec3(std::cos(b), std::sin(b), 0);
  return task;
}

double clearance_um(double ratio) {
  return 1e6 * kHole * (1 - ratio);
}

template <typename F>
Plot plot(const std::string& title, const std::string& label, bool log, const std::vector<std::string>& names,
          const std::vector<double>& ratios, const std::vector<std::vector<Rung>>& rungs, F value) {
  Plot p{title, {"diametral clearance (µm)", true}, {label, log}, {}};
  for (std::size_t r = 0; r < names.size(); ++r) {
    Series s{names[r], {}, {}};
    for (std::size_t k = ratios.size(); k-- > 0;) {
      s.x.push_back(clearance_um(ratios[k]));
      s.y.push_back(value(rungs[r][k]));
    }
    p.series.push_back(s);
  }
  return p;
}

double mean(const std::vector<double>& values) {
  return spread(values).mean;
}

}  // namespace

Outcome ladder(const Work& work) {
  const std::vector<std::string> names = resolvers();
  const std::vector<OperatorProfile>& people = operator_profiles();
  const std::vector<double> ratios = work.options.quick
                                         ? std::vector<double>{0.94, 0.9995}
                                         : std::vector<double>{0.91, 0.94, 0.987, 0.99, 0.995, 0.999, 0.9995};
  const int seeds = work.seeds(2, 1);
  std::vector<PegTask> pegs;
  for (const std::string& name : names)
    for (const double ratio : ratios) pegs.emplace_back(ratio, name);
  std::vector<Job> jobs;
  for (std::size_t k = ratios.size(); k-- > 0;)  // the longest first
    for (std::size_t r = names.size(); r-- > 0;)
      for (std::size_t p = 0; p < people.size(); ++p)
        for (int s = 0; s < seeds; ++s) jobs.push_back({k, r, p, s});
  std::vector<Attempt> attempts(jobs.size());
  work.each("ladder", static_cast<int>(jobs.size()), [&](int i) {
    const Job& j = jobs[static_cast<std::size_t>(i)];
    const PegTask& peg = pegs[j.resolver * ratios.size() + j.rung];
    Attempt& a = attempts[static_cast<std::size_t>(i)];
    a = attempt(peg, people[j.person], start(peg, j.person, j.seed, seeds), static_cast<std::uint64_t>(j.seed), kGiveUp,
                false);
    a.samples = {};
  });

  std::vector<std::vector<Rung>> rungs(names.size(), std::vector<Rung>(ratios.size()));
  Csv csv{"ladder",
          {"resolver", "ratio", "clearance_um", "operator", "seed", "completed", "time_s", "vibration_um",
           "penetration_um", "intersecting"}};
  for (std::size_t i = jobs.size(); i-- > 0;) {
    const Job& j = jobs[i];
    const Attempt& a = attempts[i];
    Rung& rung = rungs[j.resolver][j.rung];
    ++rung.tries;
    rung.completed += a.completed ? 1 : 0;
    rung.intersecting += a.intersecting;
    rung.penetration = std::max(rung.penetration, a.penetration);
    if (a.completed) rung.time.push_back(a.time_to_bottom);
    rung.vibration.push_back(a.vibration);
    csv.rows.push_back({names[j.resolver], ratios[j.rung], clearance_um(ratios[j.rung]), people[j.person].name, j.seed,
                        a.completed ? 1 : 0, a.time_to_bottom, 1e6 * a.vibration, 1e6 * a.penetration, a.intersecting});
  }

  Outcome out;
  out.title = "Ladder: ever tighter fits";
  out.intro =
      "A hole of 20 mm and pegs down to 10 µm of diametral clearance, an H7/g6 fit. Three modeled operators begin "
      "tilted "
      "by up to 5° and off center by up to the chamfer's millimeter, and push to the bottom; who is not there 15 s "
      "after "
      "the tip has reached the surface has failed. The deepest penetration is measured in closed form on every tenth "
      "pose, and FCL is asked about sixty poses a run.";
  Table table{"",
              {"ratio", "clearance (µm)", "resolver", "completed", "time to the bottom (s)", "jitter (µm)",
               "deepest penetration (µm)", "intersecting poses"}};
  double penetration = 0, worst = 100;
  std::int64_t intersecting = 0;
  for (std::size_t k = 0; k < ratios.size(); ++k) {
    for (std::size_t r = 0; r < names.size(); ++r) {
      const Rung& g = rungs[r][k];
      const std::string completed = std::to_string(g.completed) + " of " + std::to_string(g.tries);
      table.rows.push_back({apps::ratio_text(ratios[k]), rounded(clearance_um(ratios[k]), 4), names[r], completed,
                            mean(g.time), 1e6 * mean(g.vibration), 1e6 * g.penetration, g.intersecting});
    }
    const Rung& g = rungs[0][k];
    worst = std::min(worst, 100.0 * g.completed / g.tries);
    penetration = std::max(penetration, g.penetration);
    intersecting += g.intersecting;
  }
  out.claims = {at_least(names[0] + ": completed on every rung", worst, 100, "%"),
                at_most(names[0] + ": deepest penetration", 1e6 * penetration, 0, "µm"),
                at_most(names[0] + ": intersecting poses", static_cast<double>(intersecting), 0, "")};
  Section s{"All rungs", "", {}, {table}};
  s.plots = {plot("completed", "completed (%)", false, names, ratios, rungs,
                  [](const Rung& g) { return 100.0 * g.completed / g.tries; }),
             plot("time to the bottom, of those completed", "time (s)", false, names, ratios, rungs,
                  [](const Rung& g) { return mean(g.time); }),
             plot("jitter: motion of the center above 30 Hz", "RMS (µm)", true, names, ratios, rungs,
                  [](const Rung& g) { return 1e6 * mean(g.vibration); }),
             plot("deepest penetration", "depth (µm)", false, names, ratios, rungs,
                  [](const Rung& g) { return 1e6 * g.penetration; })};
  out.sections = {s};
  out.csv = {csv};
  return out;
}

}  // namespace tegotae::experiments
