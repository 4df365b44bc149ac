#pragma once

#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// Beyond, surfaces do not rub but hook.
inline constexpr double kMaxMu = 10;

/// The coefficient of friction of the held part against each part, by PartId. Throws Error for one that cannot be,
/// and where there is friction but the scene's resolver is one of the library's that know none.
std::vector<double> friction_of_parts(const Scene& scene);

}  // namespace tegotae
