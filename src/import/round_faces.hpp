#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/import/assembly.hpp"

namespace tegotae {

enum class FaceKind : std::uint8_t { plane, cylinder, cone, sphere, torus, other };

/// What is known of a face of a CAD part, m, frame of its shape.
struct CadFace {
  FaceKind kind = FaceKind::other;
  bool hole = false;          ///< of a surface of revolution: the part lies outside of it, it looks at its axis
  Vec3 point = Vec3::Zero();  ///< on the plane or the axis; the center of a sphere or torus
  Vec3 axis = Vec3::UnitZ();  ///< unit; normal of a plane
  double radius = 0;          ///< of a cylinder or sphere, the larger one of a torus; of a cone at `point`
  Eigen::AlignedBox3d box;    ///< around the face, or larger
};

/// A face of a part near a face of another that looks at it: a shaft in a hole, a ball in a socket.
struct FacePairing {
  std::size_t part_a, face_a, part_b, face_b;
};

/// The curved faces of the `parts` that mate: of the same kind, in two parts, one looking inwards and one outwards,
/// coaxial (or concentric) with radii that differ by a clearance at most; faces of kind `other` when their boxes meet.
/// `faces` by shape.
std::vector<FacePairing> mating_faces(const std::vector<std::vector<CadFace>>& faces,
                                      const std::vector<AssemblyPart>& parts);

/// A tessellated shape, vertices shared between its faces.
struct TessellatedShape {
  TriangleMesh mesh;
  std::vector<std::uint32_t> face_of;  ///< of each triangle
};

/// What keep_clearance could not do.
struct ClearanceReport {
  double into_clearance = 0;  ///< m: how far a facet of a cylinder still reaches past the true surface
  double bent = 0;         ///< m: how far a corner of a plane was moved off it (where a hole runs into it tangentially)
  std::size_t turned = 0;  ///< triangles of planes that a moved corner turned over
};

/// Moves the corners of round holes outwards along the radius until their facets touch the cylinder from outside, and
/// those of round shafts inwards where they lie past it; corners on a plane too stay in the plane. Connections do not
/// change, so what was closed is closed. Every facet then keeps `margin` (m) from the true cylinder, which rounding to
/// a file's precision may use up.
ClearanceReport keep_clearance(TessellatedShape& shape, const std::vector<CadFace>& faces, double margin);

}  // namespace tegotae
