#pragma once

#include <string>
#include <vector>

#include "tries/one_try.hpp"

namespace tegotae::tries {

/// The successful try that took the shortest time; without one the try that came farthest. Null when there is none.
const Result* best_try(const std::vector<Result>& results);

/// What came out, in a few lines for a person.
std::string summary_text(const std::vector<Result>& results);

/// Writes summary.json and report.html into `folder`. Throws Error.
void write_report(const Task& task, const std::vector<Result>& results, const std::string& folder);

}  // namespace tegotae::tries
