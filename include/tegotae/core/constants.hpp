#pragma once

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Faces whose normals differ by less are one plane (rad). Larger: curved surfaces lose the edges that contacts slide
/// over. Smaller: planes of float-precision files fall apart into creases. 512 facets a turn differ by 0.012 rad.
inline constexpr double kFlatAngle = 1e-4;

}  // namespace tegotae
