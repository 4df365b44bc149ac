#pragma once

#include <string>
#include <vector>

#include "study/run_case.hpp"

namespace tegotae::study {

/// "tries" of one scene, or "cases".
const char* word_for(const Study& study);

/// Where `study case` writes a case, in the study's folder, and the page in that which replays it.
std::string case_folder(int number);
std::string replay_page(int number);

/// Writes summary.json and report.html into `folder`. `results` in the order of their numbers; `replays`: of these the
/// pages are there. Throws Error.
void write_report(const Study& study, Tasks& tasks, const std::vector<Result>& results, const std::vector<int>& replays,
                  const std::string& folder);

}  // namespace tegotae::study
