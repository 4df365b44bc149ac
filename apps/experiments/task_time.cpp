// The paper's figure 11: task time against the ratio of peg and hole, three operators, all resolvers.
#include <cmath>
#include <cstdio>

#include "experiments/experiment_list.hpp"
#include "experiments/peg_task.hpp"
#include "experiments/statistics.hpp"
#include "peg_in_hole/peg_scene.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kTaskGiveUp = 15;  // s after the tip's reaching the surface
constexpr double kNoTrend = 0.05;

struct Result {
  bool reached;
  double time;  // s; kTaskGiveUp when the operator gave up
  double vibration;
};

/// [resolver][operator][ratio][seed]
using Times = std::vector<std::vector<std::vector<std::vector<Result>>>>;

std::vector<double> times(const std::vector<Result>& results) {
  std::vector<double> out;
  for (const Result& r : results) out.push_back(r.time);
  return out;
}

std::string p_text(double p) {
  char text[32];
  std::snprintf(text, sizeof text, p < 0.001 ? "%.1e" : "%.3f", p);
  return text;
}

/// The means of the four resolvers with the 95 % confidence interval, side by side.
Plot plot(const std::string& title, const std::vector<std::string>& names, const std::vector<double>& ratios,
          const std::vector<std::vector<std::vector<double>>>& values) {
  Plot p{title, {"diameter of the peg by that of the hole"}, {"task time (s)"}, {}};
  for (std::size_t r = 0; r < names.size(); ++r) {
    Series s{names[r], {}, {}, {}, {}, true};
    for (std::size_t k = 0; k < ratios.size(); ++k) {
      const Spread one = spread(values[r][k]);
      s.x.push_back(ratios[k] + 0.0006 * (static_cast<double>(r) - 0.5 * static_cast<double>(names.size() - 1)));
      s.y.push_back(one.mean);
      s.low.push_back(one.low);
      s.high.push_back(one.high);
    }
    p.series.push_back(s);
  }
  return p;
}

/// By resolver, operator, ratio and seed.
Times run_tasks(const Work& work, const std::vector<std::string>& names, const std::vector<double>& ratios,
                std::size_t n_seeds) {
  const std::vector<OperatorProfile>& people = operator_profiles();
  Times all(names.size(),
            std::vector<std::vector<std::vector<Result>>>(
                people.size(), std::vector<std::vector<Result>>(ratios.size(), std::vector<Result>(n_seeds))));
  // One task a ratio and resolver, shared by its runs.
  std::vector<PegTask> pegs;
  for (const std::string& name : names)
    for (const double ratio : ratios) pegs.emplace_back(ratio, name);
  const int n = static_cast<int>(pegs.size() * people.size() * n_seeds);
  work.each("task-time", n, [&](int i) {
    const std::size_t seed = static_cast<std::size_t>(i) % n_seeds, rest = static_cast<std::size_t>(i) / n_seeds;
    const std::size_t person = rest % people.size(), which = rest / people.size();
    const Attempt a = attempt(pegs[which], people[person], pegs[which].task(), 1000 * person + seed, kTaskGiveUp, true);
    all[which / ratios.size()][person][which % ratios.size()][seed] = {a.reached, a.reached ? a.time : kTaskGiveUp,
                                                                       a.vibration};
  });
  return all;
}

/// What a resolver's runs add to the report; returns the times of all operators by ratio.
std::vector<std::vector<double>> report_resolver(const std::string& name,
                                                 const std::vector<std::vector<std::vector<Result>>>& runs,
                                                 const std::vector<double>& ratios, Csv& csv, Table& table,
                                                 std::vector<Claim>& claims) {
  const std::vector<OperatorProfile>& people = operator_profiles();
  std::vector<std::vector<double>> pooled(ratios.size());
  std::vector<std::vector<std::vector<double>>> strata;
  std::vector<double> x, y, vibration;
  int reached = 0;
  for (std::size_t p = 0; p < people.size(); ++p) {
    strata.emplace_back();
    for (std::size_t k = 0; k < ratios.size(); ++k) {
      strata.back().push_back(times(runs[p][k]));
      for (std::size_t s = 0; s < runs[p][k].size(); ++s) {
        const Result& one = runs[p][k][s];
        x.push_back(ratios[k]);
        y.push_back(one.time);
        vibration.push_back(1e6 * one.vibration);
        reached += one.reached ? 1 : 0;
        pooled[k].push_back(one.time);
        csv.rows.push_back({name, people[p].name, ratios[k], s, one.reached ? 1 : 0, one.time, 1e6 * one.vibration});
      }
    }
  }
  const Trend trend = jonckheere(strata);
  const Spread s = spread(y);
  const double share = 100.0 * reached / static_cast<double>(y.size());
  table.rows.push_back({name, s.mean, s.deviation, 0.01 * slope(x, y), trend.z, p_text(trend.p),
                        std::to_string(static_cast<int>(std::lround(share))) + " %", spread(vibration).mean});
  if (name == "qp" || name == "lp") {
    claims.push_back(at_least(name + ": operators that get in", share, 100, "%"));
    claims.push_back(at_least(name + ": no rise of the task time with the ratio (one-sided p)", trend.p, kNoTrend, ""));
  }
  return pooled;
}

/// A plot for each operator.
Section plots_of_operators(const std::vector<std::string>& names, const std::vector<double>& ratios, const Times& all) {
  const std::vector<OperatorProfile>& people = operator_profiles();
  Section persons{"Each operator", "", {}};
  for (std::size_t p = 0; p < people.size(); ++p) {
    std::vector<std::vector<std::vector<double>>> values(names.size());
    for (std::size_t r = 0; r < names.size(); ++r)
      for (const auto& results : all[r][p]) values[r].push_back(times(results));
    persons.plots.push_back(plot(people[p].name, names, ratios, values));
  }
  return persons;
}

}  // namespace

Outcome task_time(const Work& work) {
  const std::vector<std::string> names = resolvers();
  const std::vector<double> ratios =
      work.options.quick ? std::vector<double>{0.91, 0.94} : std::vector<double>{0.91, 0.92, 0.93, 0.94};
  const int seeds = work.seeds(12, 1);
  const Times all = run_tasks(work, names, ratios, static_cast<std::size_t>(seeds));

  Outcome out;
  out.title = "Task time against the ratio of peg and hole";
  out.intro =
      "From the tip's reaching the hole's surface to the center of mass's reaching it, as in the paper's figure 11, "
      "with three modeled operators and " +
      std::to_string(seeds) + (seeds == 1 ? " seed" : " seeds") +
      " each; every resolver gets the same seeds. Who does not get in within 15 s counts with 15 s. Bars are 95 % "
      "confidence intervals of the mean. The trend over the ratios is tested with Jonckheere and Terpstra's test "
      "within each operator, statistics added up (one-sided: do times rise?).";
  Csv csv{"task_time", {"resolver", "operator", "ratio", "seed", "reached", "time_s", "vibration_um"}};
  Table table{"all operators",
              {"resolver", "mean (s)", "deviation (s)", "slope (s per 0.01)", "trend z", "trend p", "got in",
               "vibration (µm)"}};
  std::vector<std::vector<std::vector<double>>> pooled;
  for (std::size_t r = 0; r < names.size(); ++r)
    pooled.push_back(report_resolver(names[r], all[r], ratios, csv, table, out.claims));
  const Section means{"All operators", "", {plot("mean task time", names, ratios, pooled)}, {table}};
  out.sections = {means, plots_of_operators(names, ratios, all)};
  out.csv = {csv};
  return out;
}

}  // namespace tegotae::experiments
