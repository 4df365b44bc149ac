#pragma once

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// The library treats neighboring faces whose normals differ by less than this angle (rad) as one plane. A larger value
/// would erase the edges of curved surfaces, over which contacts slide. A smaller value would split planes of
/// single-precision files into creases. For scale: the facets of a cylinder with 512 of them differ by 0.012 rad.
inline constexpr double kFlatAngle = 1e-4;

}  // namespace tegotae
