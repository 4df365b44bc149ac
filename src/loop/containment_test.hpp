#pragma once

#include <memory>
#include <vector>

#include "feature/signed_distance.hpp"

namespace tegotae {

/// Whether one of two parts whose surfaces do not meet lies inside the other, or a component of it.
class ContainmentTest {
 public:
  ContainmentTest(const std::shared_ptr<const TriangleMesh>& a, const std::shared_ptr<const TriangleMesh>& b);
  /// `X_BA`: A in B's file frame. Never allocates.
  bool inside(const Pose& X_BA) const noexcept;

 private:
  struct Side {
    std::unique_ptr<SignedDistance> distance;  ///< null when the surface is not closed
    std::vector<Vec3> points;                  ///< one of each component, file frame
    explicit Side(const std::shared_ptr<const TriangleMesh>& mesh);
  };
  static bool any_inside(const Side& inner, const Side& outer, const Pose& X) noexcept;
  Side a_, b_;
};

}  // namespace tegotae
