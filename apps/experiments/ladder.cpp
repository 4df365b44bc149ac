// How tight can it go? Fits from 1.8 mm down to 10 µm of diametral clearance.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiments/experiment_list.hpp"
#include "experiments/peg_task.hpp"
#include "experiments/statistics.hpp"
#include "peg_in_hole/peg_scene.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kLadderHole = 0.02;  // m
constexpr double kLadderGiveUp = 15;  // s after the tip's reaching the surface

// Every so many of the starts are tried with a baseline too: a wedged impulse run takes forty times as long as one of
// `qp`.
constexpr int kBaselineEvery = 4;

struct Rung {
  int tries = 0, completed = 0;
  std::int64_t intersecting = 0;
  double penetration = 0;               // deepest, m
  std::vector<double> time, vibration;  // s of those completed, m
};

/// [resolver][rung]
using Rungs = std::vector<std::vector<Rung>>;

struct Job {
  std::size_t rung, resolver, person;
  int start;
};

struct Plan {
  std::vector<std::string> names;  // of the resolvers
  std::vector<double> ratios;
  int starts = 0;  // of each operator on each rung
  std::vector<Job> jobs{};
};

bool is_baseline(const std::string& resolver) {
  return resolver == "impulse" || resolver == "penalty";
}

Plan plan(const Work& work) {
  // The short form is for the default resolver, of which the claims are.
  Plan p{resolvers(), {0.91, 0.94, 0.987, 0.99, 0.995, 0.999, 0.9995}, work.seeds(8, 1)};
  if (work.options.quick) {
    p.names.resize(1);
    p.ratios = {0.99, 0.9995};
  }
  for (std::size_t k = p.ratios.size(); k-- > 0;)  // the longest first
    for (std::size_t r = p.names.size(); r-- > 0;)
      for (std::size_t person = 0; person < operator_profiles().size(); ++person)
        for (int s = p.starts; s-- > 0;)
          if (!is_baseline(p.names[r]) || (p.starts - 1 - s) % kBaselineEvery == 0) p.jobs.push_back({k, r, person, s});
  return p;
}

double clearance_um(double ratio) {
  return 1e6 * kLadderHole * (1 - ratio);
}

template <typename F>
Plot plot(const std::string& title, const Axis& y, const std::vector<std::string>& names,
          const std::vector<double>& ratios, const Rungs& rungs, F value) {
  Plot p{title, {"diametral clearance (µm)", true}, y, {}};
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

std::vector<Attempt> try_all(const Work& work, const Plan& p) {
  std::vector<PegTask> pegs;
  for (const std::string& name : p.names)
    for (const double ratio : p.ratios) pegs.emplace_back(ratio, name);
  std::vector<Attempt> attempts(p.jobs.size());
  work.each("ladder", static_cast<int>(p.jobs.size()), [&](int i) {
    const Job& j = p.jobs[static_cast<std::size_t>(i)];
    const PegTask& peg = pegs[j.resolver * p.ratios.size() + j.rung];
    Attempt& a = attempts[static_cast<std::size_t>(i)];
    a = attempt(peg, operator_profiles()[j.person], peg.tilted_task(j.person, j.start, p.starts),
                static_cast<std::uint64_t>(j.start), kLadderGiveUp, false);
    a.samples = {};
  });
  return attempts;
}

Rungs rungs_of(const Plan& p, const std::vector<Attempt>& attempts) {
  Rungs rungs(p.names.size(), std::vector<Rung>(p.ratios.size()));
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const Attempt& a = attempts[i];
    Rung& rung = rungs[p.jobs[i].resolver][p.jobs[i].rung];
    ++rung.tries;
    rung.completed += a.completed ? 1 : 0;
    rung.intersecting += a.intersecting;
    rung.penetration = std::max(rung.penetration, a.penetration);
    if (a.completed) rung.time.push_back(a.time_to_bottom);
    rung.vibration.push_back(a.vibration);
  }
  return rungs;
}

Csv csv_of(const Plan& p, const std::vector<Attempt>& attempts) {
  Csv csv{"ladder",
          {"resolver", "ratio", "clearance_um", "operator", "start", "completed", "time_s", "vibration_um",
           "penetration_um", "intersecting", "held_back_ticks"}};
  for (std::size_t i = attempts.size(); i-- > 0;) {
    const Job& j = p.jobs[i];
    const Attempt& a = attempts[i];
    csv.rows.push_back({p.names[j.resolver], p.ratios[j.rung], clearance_um(p.ratios[j.rung]),
                        operator_profiles()[j.person].name, j.start, a.completed ? 1 : 0, a.time_to_bottom,
                        1e6 * a.vibration, 1e6 * a.penetration, a.intersecting, a.held_back});
  }
  return csv;
}

Table table_of(const Plan& p, const Rungs& rungs) {
  Table table{"",
              {"ratio", "clearance (µm)", "resolver", "completed", "time to the bottom (s)", "jitter (µm)",
               "deepest penetration (µm)", "intersecting poses"}};
  for (std::size_t k = 0; k < p.ratios.size(); ++k) {
    for (std::size_t r = 0; r < p.names.size(); ++r) {
      const Rung& g = rungs[r][k];
      const std::string completed = std::to_string(g.completed) + " of " + std::to_string(g.tries);
      table.rows.push_back({apps::ratio_text(p.ratios[k]), rounded(clearance_um(p.ratios[k]), 4), p.names[r], completed,
                            mean(g.time), 1e6 * mean(g.vibration), 1e6 * g.penetration, g.intersecting});
    }
  }
  return table;
}

/// The default resolver gets in everywhere, and nothing but the penalty method penetrates.
std::vector<Claim> claims_of(const Plan& p, const Rungs& rungs) {
  double worst = 100, penetration = 0;
  std::int64_t intersecting = 0;
  for (const Rung& g : rungs[0]) worst = std::min(worst, 100.0 * g.completed / g.tries);
  std::string who;
  for (std::size_t r = 0; r < p.names.size(); ++r) {
    if (p.names[r] == "penalty") continue;
    who += (who.empty() ? "" : ", ") + p.names[r];
    for (const Rung& g : rungs[r]) {
      penetration = std::max(penetration, g.penetration);
      intersecting += g.intersecting;
    }
  }
  return {at_least(p.names[0] + ": completed on the worst rung", worst, 100, "%"),
          at_most(who + ": deepest penetration", 1e6 * penetration, 0, "µm"),
          at_most(who + ": intersecting poses", static_cast<double>(intersecting), 0, "")};
}

}  // namespace

Outcome ladder(const Work& work) {
  const Plan p = plan(work);
  const std::vector<Attempt> attempts = try_all(work, p);
  const Rungs rungs = rungs_of(p, attempts);
  Outcome out;
  out.title = "Ladder: ever tighter fits";
  out.intro =
      "A hole of 20 mm and pegs down to 10 µm of diametral clearance, an H7/g6 fit. Three modeled operators begin "
      "tilted by up to 5° and off center by up to the chamfer's millimeter, " +
      std::to_string(p.starts) + (p.starts == 1 ? " start" : " starts") +
      " each, and push to the bottom. The baselines impulse and penalty get every fourth of the same starts, the most "
      "tilted one among them. Who is not there 15 s after the tip has reached the surface did not finish. The deepest "
      "penetration is measured in closed form on every tenth pose, and FCL is asked about sixty poses a run. Jitter is "
      "that of "
      "all runs; a part that is stuck has none.";
  out.claims = claims_of(p, rungs);
  const auto over_rungs = [&](const std::string& title, const Axis& y, auto value) {
    return plot(title, y, p.names, p.ratios, rungs, value);
  };
  out.sections = {
      {"All rungs",
       "",
       {over_rungs("completed", {"completed (%)", false, false, true},
                   [](const Rung& g) { return 100.0 * g.completed / g.tries; }),
        over_rungs("time to the bottom, of those completed", {"time (s)"}, [](const Rung& g) { return mean(g.time); }),
        over_rungs("jitter: motion of the center above 30 Hz", {"RMS (µm)", true},
                   [](const Rung& g) { return 1e6 * mean(g.vibration); }),
        over_rungs("deepest penetration", {"depth (µm)"}, [](const Rung& g) { return 1e6 * g.penetration; })},
       {table_of(p, rungs)}}};
  out.csv = {csv_of(p, attempts)};
  return out;
}

}  // namespace tegotae::experiments
