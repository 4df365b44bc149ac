#include "sim/pose_check.hpp"

#include <algorithm>

#include "broadphase/bounding_spheres.hpp"
#include "narrowphase/fcl_pairs.hpp"
#include "sim/scene_parts.hpp"

namespace tegotae {

void PoseCheck::add(const Pose& X, std::uint32_t freed) noexcept {
  if (seen_ > 0 && X.p == last_.p && X.q.coeffs() == last_.q.coeffs()) return;
  last_ = X;
  if (seen_++ % stride_ != 0) return;
  if (poses_.size() == kMost) {
    for (std::size_t i = 0; 2 * i < kMost; ++i) poses_[i] = poses_[2 * i];
    poses_.resize(kMost / 2);
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  poses_.push_back({X, freed});
}

std::int64_t PoseCheck::count_intersecting(const Scene& scene, const StartReport& start,
                                           std::atomic<double>* share) const {
  const Part& held = held_part(scene);
  std::vector<const Part*> fixed;
  BoundingSpheres spheres;
  std::vector<std::uint32_t> freed;  // of each fixed part, in which place it came free
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    if (part.held) continue;
    fixed.push_back(&part);
    const auto pair =
        std::find_if(start.pairs.begin(), start.pairs.end(), [i](const StartPair& p) { return p.part == i; });
    freed.push_back(pair == start.pairs.end() ? 0 : pair->freed);
    spheres.add(bounding_sphere(*part.mesh), part.pose);
  }
  FclPairs fcl;  // makes the models of just those meshes that some pose is near to
  const Sphere ball = bounding_sphere(*held.mesh);
  std::vector<std::uint32_t> near;
  std::int64_t count = 0, asked = 0;
  for (const auto& [X, came_free] : poses_) {
    if (share) share->store(static_cast<double>(asked++) / static_cast<double>(poses_.size()));
    spheres.query(X * ball.center, ball.radius, 0.0, near);
    for (const std::uint32_t i : near) {
      if (freed[i] > came_free ||
          fcl.intersections(*held.mesh, *fixed[i]->mesh, fixed[i]->pose.inverse() * X, 1).empty())
        continue;
      ++count;
      break;
    }
  }
  return count;
}

}  // namespace tegotae
