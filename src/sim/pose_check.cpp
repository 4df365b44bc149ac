#include "sim/pose_check.hpp"

#include "broadphase/bounding_spheres.hpp"
#include "narrowphase/fcl_narrow_phase.hpp"

namespace tegotae {

void PoseCheck::add(const Pose& X) noexcept {
  if (seen_ > 0 && X.p == last_.p && X.q.coeffs() == last_.q.coeffs()) return;
  last_ = X;
  if (seen_++ % stride_ != 0) return;
  if (poses_.size() == kMost) {
    for (std::size_t i = 0; 2 * i < kMost; ++i) poses_[i] = poses_[2 * i];
    poses_.resize(kMost / 2);
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  poses_.push_back(X);
}

std::int64_t PoseCheck::count_intersecting(const Scene& scene) const {
  const Part* held = nullptr;
  std::vector<const Part*> fixed;
  std::vector<const TriangleMesh*> meshes;
  BoundingSpheres spheres;
  for (const Part& part : scene.parts) {
    if (part.held) {
      held = &part;
      continue;
    }
    fixed.push_back(&part);
    meshes.push_back(part.mesh.get());
    spheres.add(bounding_sphere(*part.mesh), part.pose);
  }
  FclNarrowPhase narrow(*held->mesh, meshes);
  const Sphere ball = bounding_sphere(*held->mesh);
  std::vector<std::uint32_t> near;
  std::int64_t count = 0;
  for (const Pose& X : poses_) {
    spheres.query(X * ball.center, ball.radius, 0.0, near);
    for (const std::uint32_t i : near) {
      if (!narrow.intersects(i, fixed[i]->pose.inverse() * X)) continue;
      ++count;
      break;
    }
  }
  return count;
}

}  // namespace tegotae
