#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "study/run_case.hpp"

namespace tegotae::study {

/// The share of successes that `successes` of `n` (at least 1) speak for with 95 %: Wilson's interval.
std::pair<double, double> wilson_interval(std::size_t successes, std::size_t n);

/// The value below which a share of a list lies, between its neighbors in proportion; of an ascending list that is not
/// empty.
double quantile(const std::vector<double>& ascending, double share);

struct Count {
  std::size_t cases = 0, reached = 0;
};

std::size_t reached(const std::vector<Result>& results);
/// Seconds that successful cases took, ascending.
std::vector<double> times(const std::vector<Result>& results);
/// How many unsuccessful cases each part blocked; an empty name: none did.
std::map<std::string, std::size_t> blockers(const std::vector<Result>& results);
/// How many cases failed for each reason, in words: the same, without the places.
std::map<std::string, std::size_t> failures(const std::vector<Result>& results);

/// The successful case that took the shortest time; without one the case that came farthest. Null when there is none.
const Result* best_case(const std::vector<Result>& results);

/// Whether it could begin: a drawn size may leave no clearance at the start. One that could not has no recording.
bool began(const Result& result);

/// The numbers of at most `n` cases that began, to be looked at first: the best, the one with the largest force, of
/// each part that blocked some the first, then others that failed.
std::vector<int> worth_seeing(const std::vector<Result>& results, std::size_t n);

/// How many reached the goal, what that speaks for, and in what time; `word`: "tries" or "cases".
std::string headline(const std::vector<Result>& results, const char* word);
/// The same with who was in the way, in a few lines for a person.
std::string summary_text(const std::vector<Result>& results, const char* word);

}  // namespace tegotae::study
