#include "study/shard.hpp"

#include <cstdio>
#include <mutex>

#include "core/parallel_for.hpp"
#include "shared/format.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::study {
namespace {
constexpr int kMaxShards = 1000000;
}

Shard parse_shard(const std::string& text) {
  int index = 0, count = 0;
  char end = 0;
  if (std::sscanf(text.c_str(), "%7d/%7d%c", &index, &count, &end) != 2 || index < 1 || index > count ||
      count > kMaxShards)
    throw Error("--shard: \"" + text + "\" is not I/N: the I-th of N parts, from 1/N to N/N");
  return {index - 1, count};
}

std::string shard_file(const Shard& shard) {
  return apps::format("%d-of-%d.csv", shard.index + 1, shard.count);
}

std::vector<int> numbers_of(const Shard& shard, int cases) {
  std::vector<int> out;
  for (int i = shard.index; i < cases; i += shard.count) out.push_back(i);
  return out;
}

TableLayout layout_of(const Study& study, const Tasks& tasks) {
  return {tasks.fingerprint(), study.path.empty() ? "try" : "case", study.path.empty() ? "tries" : "cases",
          parameter_columns(study)};
}

void run_missing(const Study& study, Tasks& tasks, const std::vector<int>& numbers, int jobs, CaseTable& table,
                 const std::atomic<bool>& interrupted) {
  std::vector<int> missing;
  for (const int i : numbers)
    if (!table.has(i)) missing.push_back(i);
  apps::StatusLine status;
  std::mutex mutex;
  std::size_t done = numbers.size() - missing.size(), reached = 0;
  for (const int i : numbers) reached += table.has(i) && table.rows().at(i).reached ? 1 : 0;
  const auto tell = [&] {
    status.say(apps::format("%s: %zu of %zu, %zu reached the goal", study.path.empty() ? "tries" : "cases", done,
                            numbers.size(), reached));
  };
  tell();
  const auto run = [&](int i) {
    if (interrupted) return;
    const Case c = make_case(study, missing[static_cast<std::size_t>(i)]);
    const std::optional<Result> result = run_case(study, tasks, c, interrupted);
    if (!result) return;
    const std::lock_guard<std::mutex> lock(mutex);
    table.add(*result);
    ++done;
    reached += result->reached ? 1 : 0;
    tell();
  };
  try {
    parallel_for(static_cast<int>(missing.size()), jobs, run, {});
  } catch (...) {
    table.flush();
    throw;
  }
  table.flush();
}

}  // namespace tegotae::study
