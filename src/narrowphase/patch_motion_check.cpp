#include "narrowphase/patch_motion_check.hpp"

#include <algorithm>
#include <map>

#include "narrowphase/patch_cache.hpp"

namespace tegotae {
namespace {

// Parts that can be near at once.
constexpr std::size_t kMostFronts = 32;
// Pairs of all fronts together (about 200 bytes each), and the least and the most of one.
constexpr std::size_t kAllPairs = 1u << 18;
constexpr std::size_t kLeastPairs = 1u << 13;
constexpr std::size_t kMostPairs = 1u << 15;
// Triangle pairs that stop a motion, of one part: each of them costs a walk or a search for an axis, and what they
// leave out stops the next trial.
constexpr std::uint32_t kMostBlocking = 24;
// Searches for planes in one look at a part that need not be kept out of: what is left goes on in the next.
constexpr int kStandSearches = 1024;
// A motion carries no point farther than this share of the part's radius: limits are straightened at its start.
constexpr double kLongestShare = 0.1;

}  // namespace

PatchMotionCheck::PatchMotionCheck(const std::shared_ptr<const TriangleMesh>& held, const Vec3& center, double radius,
                                   const std::vector<std::shared_ptr<const TriangleMesh>>& fixed,
                                   std::vector<Pose> poses)
    : center_(center), radius_(radius), held_(cached_patch_tree(held)), poses_(std::move(poses)) {
  std::map<const TriangleMesh*, std::shared_ptr<const PatchTree>> trees = {{held.get(), held_}};
  for (const auto& mesh : fixed) {
    auto& tree = trees[mesh.get()];
    if (!tree) tree = cached_patch_tree(mesh);
    fixed_.push_back(tree);
  }
  const std::size_t fronts = std::min(kMostFronts, std::max<std::size_t>(1, fixed.size()));
  FrontCapacity capacity;
  capacity.blocking = kMostBlocking;
  capacity.pairs = static_cast<std::uint32_t>(std::clamp(kAllPairs / fronts, kLeastPairs, kMostPairs));
  fronts_.reserve(fronts);
  for (std::size_t i = 0; i < fronts; ++i) fronts_.emplace_back(capacity);
  part_of_.assign(fronts, kNobody);
  used_.assign(fronts, 0);
  front_of_.assign(fixed.size(), kNobody);
}

double PatchMotionCheck::longest_motion() const {
  return kLongestShare * radius_;
}

std::uint32_t PatchMotionCheck::take_front(std::uint32_t part) noexcept {
  const auto oldest = std::min_element(used_.begin(), used_.end());
  if (*oldest == now_) return kNobody;
  const auto front = static_cast<std::uint32_t>(oldest - used_.begin());
  if (part_of_[front] != kNobody) front_of_[part_of_[front]] = kNobody;
  part_of_[front] = part;
  front_of_[part] = front;
  fronts_[front].attach(*held_, center_, *fixed_[part]);
  return front;
}

void PatchMotionCheck::begin(const std::vector<std::uint32_t>& near, std::int64_t deadline_ns) noexcept {
  near_ = &near;
  limit_.deadline_ns = deadline_ns;
  ++now_;
  overflow_ = false;
  for (const std::uint32_t part : near)
    if (front_of_[part] != kNobody) used_[front_of_[part]] = now_;
  for (const std::uint32_t part : near) {
    if (front_of_[part] != kNobody) continue;
    const std::uint32_t front = take_front(part);
    if (front == kNobody) {
      overflow_ = true;
      return;
    }
    used_[front] = now_;
  }
}

MotionAnswer PatchMotionCheck::check(const Pose& X, const Displacement& d, double clearance,
                                     std::vector<FacePair>& blocking) noexcept {
  if (overflow_) return MotionAnswer::unknown;
  bool all_free = true;
  for (const std::uint32_t part : *near_) {
    PatchFront& front = fronts_[front_of_[part]];
    front.set_clearance(clearance);
    const Quat q_BW = poses_[part].q.conjugate();
    const CertifyReport report = front.certify(poses_[part].inverse() * X, {q_BW * d.dp, q_BW * d.dr}, limit_);
    if (report.status == CertifyStatus::certified) continue;
    all_free = false;
    for (const BlockingPair& pair : front.blocking())
      if (blocking.size() < blocking.capacity()) blocking.push_back({part, pair.face_a, pair.face_b});
    if (report.exhausted && past(limit_.deadline_ns)) break;
  }
  if (all_free) return MotionAnswer::free;
  return blocking.empty() ? MotionAnswer::unknown : MotionAnswer::blocked;
}

MotionAnswer PatchMotionCheck::stands(const Pose& X, std::uint32_t part, double clearance,
                                      std::int64_t deadline_ns) noexcept {
  one_[0] = part;
  begin(one_, deadline_ns);
  PatchFront& front = fronts_[front_of_[part]];
  front.set_clearance(clearance);
  WorkLimit limit = limit_;
  limit.blocking = 1;
  limit.searches = kStandSearches;
  const CertifyReport report = front.certify(poses_[part].inverse() * X, Displacement{}, limit);
  if (report.status == CertifyStatus::cut) return MotionAnswer::unknown;
  return report.status == CertifyStatus::certified ? MotionAnswer::free : MotionAnswer::blocked;
}

}  // namespace tegotae
