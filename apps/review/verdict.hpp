#pragma once

#include <string>
#include <vector>

#include "review/findings.hpp"
#include "review/headline.hpp"
#include "shared/blocked_text.hpp"

namespace tegotae::review {

/// A sentence of evidence; `good` and `bad` speak for and against, the others are neutral.
struct Evidence {
  enum class Kind { good, bad, plain } kind;
  std::string text;
};

struct Verdict {
  Outcome outcome = Outcome::open;
  std::string headline;
  std::vector<Evidence> evidence;
};

/// `inwards`: whether the goal is farther in than the start.
Verdict judge(const Findings& findings, const Scene& scene, bool inwards, const Scan& scan, const std::string& damage);

using apps::place_text;
std::string length_text(double meters);    ///< "4.2 µm", "1.3 mm", "0.25 m"
std::string seconds_text(double seconds);  ///< "1.25 s"
/// "hole", "hole and plate", "a, b and c"
std::string names_text(const std::vector<std::size_t>& parts, const Scene& scene);

}  // namespace tegotae::review
