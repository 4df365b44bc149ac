#pragma once

#include <cstdint>
#include <vector>

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// A box around all vertices of a mesh, along the axes of its file frame (m).
struct Box {
  Vec3 center = Vec3::Zero();
  Vec3 half = Vec3::Zero();
};

Box bounding_box(const TriangleMesh& mesh);

/// The boxes of all fixed parts, in the world. They tell apart parts whose spheres overlap though they are far from
/// each other: long parts, and whatever lies beside or inside a large one.
class BoundingBoxes {
 public:
  /// Adds a part; parts are numbered in the order they come.
  void add(const Box& box_F, const Pose& X_WF);
  /// Takes out of `near` those parts whose box is known to be farther than `distance` (m) from `box` at `X`. Only
  /// planes along faces of the two boxes are tried, so some that are far may stay.
  void keep_near(const Box& box, const Pose& X, double distance, std::vector<std::uint32_t>& near) const;

 private:
  struct Placed {
    Vec3 center;
    Mat3 axes;  ///< columns
    Vec3 half;
  };
  std::vector<Placed> boxes_;
};

}  // namespace tegotae
