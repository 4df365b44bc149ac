#include "session/pose_check.hpp"

#include <algorithm>

#include "loop/scene_parts.hpp"

namespace tegotae {

PoseJudge::PoseJudge(const Scene& scene, const InitialContactReport& start)
    : held_(held_part(scene)), ball_(bounding_sphere(*held_.mesh)), freed_(scene.parts.size()) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    if (part.held) continue;
    fixed_.push_back(&part);
    number_.push_back(i);
    spheres_.add(bounding_sphere(*part.mesh), part.pose);
  }
  came_free(start);
}

void PoseJudge::came_free(const InitialContactReport& start) noexcept {
  for (const InitialContact& pair : start.pairs) freed_[pair.part].store(pair.freed, std::memory_order_release);
}

bool PoseJudge::intersects(const Pose& X, std::uint32_t freed) {
  spheres_.query(X * ball_.center, ball_.radius, 0.0, near_);
  return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t i) {
    if (freed_[number_[i]].load(std::memory_order_acquire) > freed) return false;
    return fcl_.intersect(*held_.mesh, *fixed_[i]->mesh, fixed_[i]->pose.inverse() * X);
  });
}

void PoseCheck::add(const Pose& X, std::uint32_t freed) noexcept {
  if (seen_ > 0 && X.p == last_.p && X.q.coeffs() == last_.q.coeffs()) return;
  last_ = X;
  if (seen_++ % stride_ != 0) return;
  if (poses_.size() == kMax) {
    for (std::size_t i = 0; 2 * i < kMax; ++i) poses_[i] = poses_[2 * i];
    poses_.resize(kMax / 2);
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  poses_.push_back({X, freed});
}

std::int64_t PoseCheck::count_intersecting(const Scene& scene, const InitialContactReport& start) const {
  PoseJudge judge(scene, start);
  return std::count_if(poses_.begin(), poses_.end(),
                       [&judge](const Kept& kept) { return judge.intersects(kept.X, kept.freed); });
}

}  // namespace tegotae
