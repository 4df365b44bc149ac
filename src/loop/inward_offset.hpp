#pragma once

#include "mesh/surface.hpp"

namespace tegotae {

/// The surface with every face moved inwards by `by` (m) or a little more: each vertex goes by the least displacement
/// that takes it that far behind all of its faces. Faces and edges keep their numbers. Where no displacement does, or
/// only one of more than ten times `by` (sheets, needles), the vertex goes less far, so whoever needs the room looks
/// whether it is there.
TriangleMesh inward_offset(const Surface& surface, double by);

}  // namespace tegotae
