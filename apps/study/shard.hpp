#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "study/case_table.hpp"

namespace tegotae::study {

/// A part of a study's cases: those whose number leaves the rest `index` by `count`.
struct Shard {
  int index = 0, count = 1;
};

/// "2/8": the second of eight. Throws Error for anything else.
Shard parse_shard(const std::string& text);

/// "2-of-8.csv"
std::string shard_file(const Shard& shard);

/// The numbers of its cases.
std::vector<int> numbers_of(const Shard& shard, int cases);

/// Of the tables of a study.
TableLayout layout_of(const Study& study, const Tasks& tasks);

/// Runs those of `numbers` that the table does not have, `jobs` at the same time (0: all processors); ends early when
/// interrupted. What is finished is in the table's file then. Throws Error.
void run_missing(const Study& study, Tasks& tasks, const std::vector<int>& numbers, int jobs, CaseTable& table,
                 const std::atomic<bool>& interrupted);

}  // namespace tegotae::study
