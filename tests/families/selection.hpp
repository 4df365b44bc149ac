// Which cases are run: the daily ones, and all.
#pragma once

#include <vector>

#include "families/case_run.hpp"

namespace tegotae::test {

struct SelectedCase {
  FamilyParameters parameters;
  CaseOptions options;
};

/// Every family once, small; some in real time; covers over 36, 64, 144 and 2000 parts.
std::vector<SelectedCase> daily_cases();

/// Every family at `seeds` seeds from 1 on, in virtual or in real time. The seed chooses among 1 k to 500 k triangles,
/// clearances of 0 to 0.5 mm, sizes of 2 mm to 2 m and 1 to 2000 fixed parts.
std::vector<SelectedCase> all_cases(int seeds, bool real_time);

}  // namespace tegotae::test
