#pragma once

#include <string>

#include "tegotae/core/pose.hpp"

namespace tegotae::apps {

std::string place_text(const Vec3& place_W);  ///< "(1.20, 0.00, -3.40) mm"

/// What was in the way at the end, in the words of all reports; `part`: its name, empty when nothing was.
std::string blocked_text(const std::string& part, const Vec3& place_W);

}  // namespace tegotae::apps
