#include "experiments/experiments.hpp"

#include <cstdio>

#include "core/number_text.hpp"
#include "core/output_file.hpp"
#include "experiments/experiment_list.hpp"
#include "experiments/trial.hpp"
#include "shared/run_options.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae::experiments {
namespace {

struct Experiment {
  const char* name;
  Outcome (*run)(const Work&);
};
constexpr Experiment kExperiments[] = {
    {"wall", wall},     {"insertion", insertion}, {"task-time", task_time},
    {"ladder", ladder}, {"hold", hold},           {"widening", widening},
    {"wrench", wrench}, {"friction", friction},   {"friction-tasks", friction_tasks}};

std::string command(const std::string& name, const Options& options) {
  std::string text = "tegotae experiment " + name;
  if (options.seeds > 0) text += " --seeds " + std::to_string(options.seeds);
  if (options.quick) text += " --quick";
  return text;
}

/// Prints the claims and returns whether all hold.
bool tell(const std::string& name, const Outcome& outcome, double seconds) {
  bool all = true;
  std::printf("%s (%.0f s)\n", name.c_str(), seconds);
  for (const Claim& c : outcome.claims) {
    std::printf("  %-5s %s: %s %s (%s)\n", c.holds ? "holds" : "FAILS", c.name.c_str(), number_text(c.value, 4).c_str(),
                c.unit.c_str(), c.target.c_str());
    all = all && c.holds;
  }
  std::fflush(stdout);
  return all;
}

}  // namespace

const std::vector<std::string>& names() {
  static const std::vector<std::string> list = [] {
    std::vector<std::string> out;
    for (const Experiment& e : kExperiments) out.emplace_back(e.name);
    out.emplace_back("all");
    return out;
  }();
  return list;
}

int run(const Options& options) {
  bool all = true;
  for (const Experiment& e : kExperiments) {
    if (options.name != "all" && options.name != e.name) continue;
    const std::string to = options.out + "/" + e.name;
    make_folder(to);  // before the work whose results it is for
    const std::int64_t start = monotonic_ns();
    Outcome outcome;
    unexplained_lag_ticks() = 0;
    {
      apps::StatusLine status;
      outcome = e.run({options, status});
    }
    const auto unexplained = static_cast<double>(unexplained_lag_ticks());
    outcome.claims.push_back(at_most("held back for long without a contact", unexplained, 0, "ticks"));
    write_outcome(outcome, e.name, command(e.name, options), to);
    all = tell(e.name, outcome, 1e-9 * static_cast<double>(monotonic_ns() - start)) && all;
  }
  std::printf("reports: %s/*/report.html\n", options.out.c_str());
  return all ? apps::kDone : apps::kRunFailed;
}

}  // namespace tegotae::experiments
