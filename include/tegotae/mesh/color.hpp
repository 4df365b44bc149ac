#pragma once

#include <array>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Red, green, blue (sRGB) and opacity, each 0 to 1.
using Color = std::array<double, 4>;

}  // namespace tegotae
