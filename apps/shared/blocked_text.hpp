#pragma once

#include <string>

#include "shared/blocker.hpp"

namespace tegotae::apps {

std::string place_text(const Vec3& place_W);  ///< "(1.20, 0.00, -3.40) mm"

/// What was in the way at the end, in the words of all reports.
std::string blocked_text(const Blocker& blocker);

}  // namespace tegotae::apps
