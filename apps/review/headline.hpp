#pragma once

#include <string>

#include "review/findings.hpp"

namespace tegotae::review {

enum class Outcome { goes, does_not_go, open };

struct Headline {
  Outcome outcome = Outcome::open;
  std::string text;
};

/// What the recording says, in a sentence. `inwards`: whether the goal is farther in than the start.
Headline headline(const Findings& findings, const Scene& scene, bool inwards);

}  // namespace tegotae::review
