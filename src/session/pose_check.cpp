#include "session/pose_check.hpp"

#include <algorithm>

#include "core/parallel_for.hpp"
#include "core/same_pose.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/patch_cache.hpp"

namespace tegotae {
namespace {

constexpr std::size_t kPoseBlock = 256;  // poses in a row that one thread asks about

}  // namespace

JudgedScene::JudgedScene(const Scene& scene, const InitialContactReport& start)
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

void JudgedScene::came_free(const InitialContactReport& start) noexcept {
  for (const InitialContact& pair : start.pairs) freed_[pair.part].store(pair.freed, std::memory_order_release);
}

bool PoseJudge::intersects(const Pose& X, std::uint32_t freed, const std::atomic<bool>* stop) {
  scene_.spheres_.query(X * scene_.ball_.center, scene_.ball_.radius, 0.0, near_);
  return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t i) {
    if (scene_.freed_[scene_.number_[i]].load(std::memory_order_acquire) > freed) return false;
    const Part& fixed = *scene_.fixed_[i];
    if (!pairs_[i]) pairs_[i].emplace(cached_patch_tree(scene_.held_.mesh), cached_patch_tree(fixed.mesh));
    return pairs_[i]->intersect(fixed.pose.inverse() * X, stop);
  });
}

void PoseCheck::add(const Pose& X, std::uint32_t freed) noexcept {
  if (seen_ > 0 && same_pose(X, last_)) return;
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
  const JudgedScene judged(scene, start);
  const std::size_t blocks = (poses_.size() + kPoseBlock - 1) / kPoseBlock;
  std::atomic<std::int64_t> count{0};
  const auto ask = [&](int block) {
    PoseJudge judge(judged);
    const std::size_t begin = static_cast<std::size_t>(block) * kPoseBlock,
                      end = std::min(begin + kPoseBlock, poses_.size());
    for (std::size_t i = begin; i < end; ++i)
      if (judge.intersects(poses_[i].X, poses_[i].freed)) ++count;
  };
  parallel_for(static_cast<int>(blocks), 0, ask, {});
  return count;
}

}  // namespace tegotae
