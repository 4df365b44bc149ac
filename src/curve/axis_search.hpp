#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// The axis of a screw motion that leaves a part of a surface as it is: a turn by φ about the line through `origin`
/// along `direction` goes with a rise of `rise` · φ along it. A rise of 0 is a surface of revolution; a positive one a
/// right-hand thread. Both senses of `direction` say the same.
struct ScrewAxis {
  Vec3 origin = Vec3::Zero();      ///< the point of the axis nearest to the middle of the mesh's box, m, file frame
  Vec3 direction = Vec3::UnitZ();  ///< unit vector, file frame
  double rise = 0;                 ///< m/rad
  double area = 0;                 ///< of the surface that was found to follow it, m²
};

/// Most axes that are looked for in one mesh.
inline constexpr std::size_t kMaxAxes = 6;

/// The axes of the threads, bores, pegs, cones and other surfaces of revolution of `mesh`, those of most surface first.
/// Found from the triangles alone: open surfaces, soups, degenerate and repeated faces do no harm. The same set of
/// triangles gives the same answer bit for bit, whatever the order of faces and vertices. Nothing that a certificate
/// proves depends on how well an axis fits; a bad one makes it slower.
/// 10 to 300 ms; meshes of more than 8000 triangles are sampled.
std::vector<ScrewAxis> find_axes(const TriangleMesh& mesh);

}  // namespace tegotae
