#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <cstddef>
#include <gp_XYZ.hxx>
#include <vector>

#include "import/round_faces.hpp"

namespace tegotae {

/// A point of OpenCASCADE, which hands out millimeters whatever the file's unit.
Vec3 meters(const gp_XYZ& p);

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape);
/// The surface that a face lies on, and on which side of it the part is.
CadFace describe(const TopoDS_Face& face);

/// Triangulates the faces of `shape` with at most `chord` (m) between facets and surface; faces that have finer
/// triangles, and their edges, keep them.
void tessellate(const TopoDS_Shape& shape, double chord);
/// The triangles of tessellated faces as one mesh, with common nodes where the faces share edges. `missing` becomes the
/// indices of the faces without triangles.
TessellatedShape joined(const std::vector<TopoDS_Face>& faces, std::vector<std::size_t>& missing);

}  // namespace tegotae
