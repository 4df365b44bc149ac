#pragma once

#include <cstddef>
#include <vector>

#include "mesh/components.hpp"

namespace tegotae {

/// The closed shells (components) that look the wrong way: a shell inside an odd number of others is the wall of a
/// cavity and looks inwards, any other looks outwards. `open` tells which are not closed; what lies within such a one
/// may be in it or beside it, and is not counted.
std::size_t count_inverted_shells(const TriangleMesh& mesh, const Components& shells, const std::vector<bool>& open);

}  // namespace tegotae
