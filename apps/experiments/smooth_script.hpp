#pragma once

#include <vector>

#include "tegotae/device/script.hpp"

namespace tegotae::experiments {

/// A script that rests at every key and goes between two on the polynomial of least jerk, in steps of 10 ms.
StylusScript smooth_script(const std::vector<StylusScript::Key>& keys);

}  // namespace tegotae::experiments
