#include "narrowphase/fcl_motion_check.hpp"

#include <algorithm>

namespace tegotae {
namespace {

// A motion carries no point farther than this share of the part's radius, so that the poses checked lie close together.
constexpr double kLongestFclShare = 0.02;
// Doublings of the back-off length.
constexpr int kMaxBackOffs = 4;

}  // namespace

FclMotionCheck::FclMotionCheck(const TriangleMesh& held, const Vec3& center, double radius,
                               const std::vector<const TriangleMesh*>& fixed, std::vector<Pose> poses, double back_off)
    : held_(held),
      center_(center),
      radius_(radius),
      poses_(std::move(poses)),
      back_off_(back_off),
      narrow_(held, fixed) {}

void FclMotionCheck::begin(const std::vector<std::uint32_t>& near, std::int64_t, OtherParts) noexcept {
  near_ = &near;
}

double FclMotionCheck::longest_motion() const {
  return kLongestFclShare * radius_;
}

MotionAnswer FclMotionCheck::check(const Pose& X, const Displacement& d, double clearance,
                                   std::vector<FacePair>& blocking) noexcept {
  const Pose end = displaced(X, center_, d);
  for (const std::uint32_t part : *near_)
    narrow_.intersections(part, poses_[part].inverse() * end, static_cast<int>(blocking.capacity() - blocking.size()),
                          blocking);
  free_ = false;
  if (!blocking.empty()) return MotionAnswer::blocked;
  FacePair nearest{};
  for (const std::uint32_t part : *near_) {
    const bool close = narrow_.distance_below(clearance, part, poses_[part].inverse() * end, nearest) < clearance;
    if (close && blocking.size() < blocking.capacity()) blocking.push_back(nearest);
  }
  free_ = blocking.empty();
  return free_ ? MotionAnswer::free : MotionAnswer::blocked;
}

MotionAnswer FclMotionCheck::stands(const Pose& X, std::uint32_t part, double clearance, std::int64_t) noexcept {
  const Pose X_BA = poses_[part].inverse() * X;
  FacePair nearest{};
  const bool free =
      !narrow_.intersects(part, X_BA) && narrow_.distance_below(clearance, part, X_BA, nearest) >= clearance;
  return free ? MotionAnswer::free : MotionAnswer::blocked;
}

Pose FclMotionCheck::near_contact(const Pose& X, const Displacement& d,
                                  const std::vector<FacePair>& blocking) noexcept {
  // The paper moves A back by l_0 against the velocity of the vertices of its intersecting faces; here along its own
  // path, as far as takes the fastest of those vertices back by l_0, and by twice as much while it still intersects,
  // never further than to the last free pose.
  const Vec3 c = X * center_;
  double fastest = 0;
  for (const FacePair& t : blocking)
    for (const std::uint32_t v : held_.triangles[t.a])
      fastest = std::max(fastest, (d.dp + d.dr.cross(X * held_.vertices[v] - c)).norm());
  double back = back_off_;
  for (int i = 0; i < kMaxBackOffs && back < fastest; ++i, back *= 2) {
    const Pose P = displaced(X, center_, (1 - back / fastest) * d);
    const bool hit = std::any_of(near_->begin(), near_->end(), [&](std::uint32_t part) {
      return narrow_.intersects(part, poses_[part].inverse() * P);
    });
    if (!hit) return P;
  }
  return X;
}

}  // namespace tegotae
