#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Mass properties of a homogeneous part.
struct MassProperties {
  double mass = 0;              ///< kg
  Vec3 center = Vec3::Zero();   ///< center of mass, m, file frame
  Mat3 inertia = Mat3::Zero();  ///< about the center of mass, kg·m², file axes
  bool from_volume = false;     ///< true: by the volume integrals; false: mass_properties() used the bounding box
};

/// Returns mass, center and inertia of a homogeneous part. `closed` is MeshReport::closed. The inertia is positive
/// definite for any mesh with an extent.
///
/// For a closed mesh with a volume, they are the exact volume integrals at `density` (kg/m³), as sums over tetrahedra
/// (Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2004). A mesh of negative volume is inside
/// out and counts as if its faces were flipped. For any other mesh, they are those of its solid bounding box at the
/// same density, with the center at the area centroid of the surface. A box with no thickness in a direction gets 1 %
/// of its largest side there.
MassProperties mass_properties(const TriangleMesh& mesh, bool closed, double density = 1000.0);

/// Returns the part's radius of gyration about its center of mass, m: the root of the mean square over any three
/// perpendicular axes.
double radius_of_gyration(const MassProperties& mass) noexcept;

}  // namespace tegotae
