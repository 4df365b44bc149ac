#pragma once

#include <vector>

#include "curve/screw_fit.hpp"

namespace tegotae {

/// The rise that one facet asks for by itself, what its width and its roughness may make of it, and its weight; in
/// lengths of the mesh's size.
struct OwnRise {
  double rise, spread, weight;
};

/// `plain` is a turn about the axis without a rise, `rough` (rad) what normals are off anyway.
OwnRise own_rise(const Facet& f, const ScrewMotion& plain, double rough);

/// Where most of the weight is, within `spread` (mean shift). Sorts `own`, which must not be empty.
double most_frequent(std::vector<OwnRise>& own, double spread);

}  // namespace tegotae
