#include "study/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "shared/format.hpp"

namespace tegotae::study {

using apps::format;

std::pair<double, double> wilson_interval(std::size_t successes, std::size_t n) {
  constexpr double z = 1.959963984540054;  // of the normal distribution at 97.5 %
  const double nn = static_cast<double>(n), p = static_cast<double>(successes) / nn;
  const double middle = (p + z * z / (2 * nn)) / (1 + z * z / nn);
  const double half = z / (1 + z * z / nn) * std::sqrt(p * (1 - p) / nn + z * z / (4 * nn * nn));
  // Exactly 0 and 1 at the ends, whatever is rounded.
  return {successes == 0 ? 0 : middle - half, successes == n ? 1 : middle + half};
}

double quantile(const std::vector<double>& ascending, double share) {
  const double at = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(at), above = std::min(below + 1, ascending.size() - 1);
  return ascending[below] + (at - static_cast<double>(below)) * (ascending[above] - ascending[below]);
}

std::size_t reached(const std::vector<Result>& results) {
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [](const Result& r) { return r.reached; }));
}

std::vector<double> times(const std::vector<Result>& results) {
  std::vector<double> out;
  for (const Result& r : results)
    if (r.reached) out.push_back(r.time);
  std::sort(out.begin(), out.end());
  return out;
}

std::map<std::string, std::size_t> blockers(const std::vector<Result>& results) {
  std::map<std::string, std::size_t> out;
  for (const Result& r : results)
    if (!r.reached) ++out[r.blocked_by];
  return out;
}

std::map<std::string, std::size_t> failures(const std::vector<Result>& results) {
  std::map<std::string, std::size_t> out;
  for (const Result& r : results)
    if (!r.reached) ++out[r.blocked_by.empty() ? r.why : "blocked by " + r.blocked_by];
  return out;
}

const Result* best_case(const std::vector<Result>& results) {
  const auto better = [](const Result& a, const Result& b) {
    if (a.reached != b.reached) return a.reached;
    return a.reached ? a.time < b.time : a.depth > b.depth;
  };
  const auto best = std::min_element(results.begin(), results.end(), better);
  return best == results.end() ? nullptr : &*best;
}

bool began(const Result& r) {
  // What did not begin has the clearance of a result that nobody filled in.
  return r.reached || r.intersecting > 0 || r.clearance > 0;
}

std::vector<int> worth_seeing(const std::vector<Result>& results, std::size_t n) {
  std::vector<const Result*> first = {best_case(results)}, later;
  const auto weaker = [](const Result& a, const Result& b) { return a.force < b.force; };
  const auto most = std::max_element(results.begin(), results.end(), weaker);
  if (most != results.end()) first.push_back(&*most);
  std::set<std::string> blocked;
  for (const Result& r : results)
    if (!r.reached) (blocked.insert(r.blocked_by).second ? first : later).push_back(&r);
  first.insert(first.end(), later.begin(), later.end());
  std::vector<int> out;
  for (const Result* r : first) {
    if (out.size() == n) break;
    if (r != nullptr && began(*r) && std::find(out.begin(), out.end(), r->number) == out.end())
      out.push_back(r->number);
  }
  return out;
}

std::string headline(const std::vector<Result>& results, const char* word) {
  const std::size_t n = reached(results);
  std::string text = format("%zu of %zu %s reached the goal", n, results.size(), word);
  if (!results.empty()) {
    const auto [low, high] = wilson_interval(n, results.size());
    text += format(" (95 %%: %.0f to %.0f %%)", 100 * low, 100 * high);
  }
  const std::vector<double> t = times(results);
  if (!t.empty()) text += format(", in %.2f to %.2f s, median %.2f s", t.front(), t.back(), quantile(t, 0.5));
  return text + ".";
}

std::string summary_text(const std::vector<Result>& results, const char* word) {
  std::string text = headline(results, word) + "\n";
  for (const auto& [why, n] : failures(results)) text += format("  %zu failed: ", n) + why + "\n";
  return text;
}

}  // namespace tegotae::study
