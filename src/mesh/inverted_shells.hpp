#pragma once

#include <cstddef>

#include "mesh/components.hpp"

namespace tegotae {

/// Of a closed mesh, the shells (components) that look the wrong way: a shell inside an odd number of others is the
/// wall of a cavity and looks inwards, any other looks outwards.
std::size_t count_inverted_shells(const TriangleMesh& mesh, const Components& shells);

}  // namespace tegotae
