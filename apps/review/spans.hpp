#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace tegotae::review {

/// Runs of rows [first, last] in which `holds`, where breaks shorter than `join` (s) do not count and runs shorter than
/// `least` (s) are left out. `time(i)` ascends.
inline std::vector<std::pair<std::size_t, std::size_t>> spans(std::size_t count,
                                                              const std::function<double(std::size_t)>& time,
                                                              const std::function<bool(std::size_t)>& holds,
                                                              double join, double least) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t i = 0; i < count; ++i) {
    if (!holds(i)) continue;
    if (!out.empty() && (out.back().second + 1 == i || time(i) - time(out.back().second) < join))
      out.back().second = i;
    else
      out.emplace_back(i, i);
  }
  std::vector<std::pair<std::size_t, std::size_t>> kept;
  for (const auto& s : out)
    if (time(s.second) - time(s.first) >= least) kept.push_back(s);
  return kept;
}

}  // namespace tegotae::review
