#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Mass properties of a homogeneous part.
struct MassProperties {
  double mass = 0;              ///< kg
  Vec3 center = Vec3::Zero();   ///< center of mass, m, file frame
  Mat3 inertia = Mat3::Zero();  ///< about the center of mass, kg·m², file axes
  bool from_volume = false;     ///< false: the stated fallback was used
};

/// Mass, center and inertia; the inertia is positive definite for any mesh with an extent.
///
/// A closed mesh with a volume: the exact volume integral at `density` (kg/m³), as a sum over tetrahedra (Tonon,
/// "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2004). A mesh turned inside out, of negative
/// volume, counts as if its faces were turned back. Any other mesh: its bounding box, solid, at the same density (a box
/// with no thickness in a direction gets 1 % of its largest side there), centered on the area centroid of the surface
/// clamped to the box.
MassProperties mass_properties(const TriangleMesh& mesh, bool closed, double density = 1000.0);

/// Of the part about its center, m: the root of the mean square over any three axes at right angles.
double radius_of_gyration(const MassProperties& mass) noexcept;

}  // namespace tegotae
