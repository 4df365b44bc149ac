#include "broadphase/bounding_boxes.hpp"

#include <algorithm>

namespace tegotae {
namespace {

// Of the sizes involved: what rounding can make of a gap.
constexpr double kRounding = 1e-12;

}  // namespace

Box bounding_box(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  Vec3 lo = mesh.vertices.front(), hi = lo;
  for (const Vec3& v : mesh.vertices) {
    lo = lo.cwiseMin(v);
    hi = hi.cwiseMax(v);
  }
  return {0.5 * (lo + hi), 0.5 * (hi - lo)};
}

void BoundingBoxes::add(const Box& box_F, const Pose& X_WF) {
  boxes_.push_back({X_WF * box_F.center, X_WF.q.toRotationMatrix(), box_F.half});
}

void BoundingBoxes::keep_near(const Box& box, const Pose& X, double distance, std::vector<std::uint32_t>& near) const {
  const Vec3 center = X * box.center;
  const Mat3 axes = X.q.toRotationMatrix();
  const auto is_far = [&](std::uint32_t part) {
    const Placed& b = boxes_[part];
    const Vec3 d = b.center - center;
    const Mat3 between = axes.transpose() * b.axes;
    const Mat3 share = between.cwiseAbs();
    const Vec3 along_a = (axes.transpose() * d).cwiseAbs() - box.half - share * b.half;
    const Vec3 along_b = (b.axes.transpose() * d).cwiseAbs() - b.half - share.transpose() * box.half;
    const double slack = kRounding * (center.norm() + b.center.norm() + box.half.sum() + b.half.sum());
    return std::max(along_a.maxCoeff(), along_b.maxCoeff()) > distance + slack;
  };
  near.erase(std::remove_if(near.begin(), near.end(), is_far), near.end());
}

}  // namespace tegotae
