#include "narrowphase/curved_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

/// A piece of a thread that is thinner in profile than this part of the pitch is of one flank, however long it is.
constexpr double kOneFlank = 0.1;

/// Least extent of the bounds over the directions, m.
float thickness(const ProfileBox& p) {
  float least = p.hi[0] - p.lo[0];
  for (int k = 1; k < kProfileDirections; ++k) least = std::min(least, p.hi[k] - p.lo[k]);
  return least;
}

/// Whether the axes come so near to each other beside A's surface that a margin can be positive (E ≤ r / 2).
bool axes_meet(const AxisPose& pose, const ProfileTree& a, bool flipped) {
  const double middle = (flipped ? -0.5 : 0.5) * (a.z_min() + a.z_max()), half = 0.5 * (a.z_max() - a.z_min());
  const double x = pose.offset_x + pose.lean_x * middle, y = pose.offset_y + pose.lean_y * middle;
  return std::hypot(x, y) - pose.lean * half < 0.5 * a.r_max();
}

/// A's frame turned by half a turn about its x axis.
Mat3 half_turned(const Mat3& R) {
  Mat3 out = R;
  out.col(1) = -out.col(1);
  out.col(2) = -out.col(2);
  return out;
}

FrameMotion frame_motion(const PatchTree& a, const Vec3& center, const PatchTree& b, const Sweep& sweep,
                         const ScrewFrame& fa, const Mat3& R_a, const ScrewFrame& fb) {
  FrameMotion m;
  const Mat3 to_b = fb.R.transpose();
  // From the origin of B's tree to that of its screw frame.
  const Vec3 shift = b.origin() - fb.origin;
  const auto at = [&](const Placement& p, const Vec3& in_file) {
    return Vec3(to_b * (p.R * (in_file - center) + p.t + shift));
  };
  m.R0 = to_b * sweep.start.R * R_a;
  m.R1 = to_b * sweep.end.R * R_a;
  m.t0 = at(sweep.start, fa.origin);
  m.t1 = at(sweep.end, fa.origin);
  m.turn = to_b * sweep.dr;
  m.center0 = at(sweep.start, center);
  m.center1 = at(sweep.end, center);
  m.origin0 = at(sweep.start, Vec3::Zero());
  m.origin1 = at(sweep.end, Vec3::Zero());
  m.reach_center = a.radius() + (a.origin() - center).norm();
  m.reach_origin = a.radius() + a.origin().norm();
  m.size = sweep.start.t.norm() + sweep.end.t.norm() + m.reach_center + m.reach_origin + 2 * center.norm() +
           2 * fa.origin.norm() + b.radius() + 2 * b.origin().norm() + fb.origin.norm();
  return m;
}

}  // namespace

CurvedPairs::CurvedPairs(std::uint32_t capacity, std::size_t axes) : capacity_(capacity) {
  groups_.reserve(axes);
  for (std::size_t i = 0; i < axes; ++i)
    groups_.push_back({CurvedBlocks(capacity), std::vector<std::uint32_t>(capacity), 0, {}, false});
}

void CurvedPairs::attach(const std::vector<AxisPair>* axes) noexcept {
  axes_ = axes;
  used_ = axes == nullptr ? 0 : static_cast<std::uint32_t>(std::min(axes->size(), groups_.size()));
  count_ = 0;
  for (Group& g : groups_) {
    g.count = 0;
    g.motion = {};
    g.flipped = false;
  }
}

void CurvedPairs::begin(const PatchTree& a, const Vec3& center_A, const PatchTree& b, const Sweep& sweep) noexcept {
  for (std::uint32_t i = 0; i < used_; ++i) {
    Group& g = groups_[i];
    const ScrewFrame &fa = (*axes_)[i].a->frame(), &fb = (*axes_)[i].b->frame();
    const bool flipped = (sweep.start.R * fa.R.col(2)).dot(fb.R.col(2)) < 0;
    if (flipped != g.flipped) {
      // What was written holds for the other sense.
      for (std::uint32_t slot = 0; slot < g.count; ++slot) g.lanes.spoil(slot);
      g.flipped = flipped;
    }
    const FrameMotion m = frame_motion(a, center_A, b, sweep, fa, flipped ? half_turned(fa.R) : fa.R, fb);
    g.motion = axis_motion(m, fb.rise, sweep.start_floor, sweep.floor, g.motion.start.psi);
    g.motion.usable = g.motion.usable && axes_meet(g.motion.start, *(*axes_)[i].a, flipped);
  }
}

std::optional<CurvedPairs::Found> CurvedPairs::separate(std::uint32_t node_a, std::uint32_t node_b,
                                                        double spare) const noexcept {
  for (std::uint32_t i = 0; i < used_; ++i) {
    const Group& g = groups_[i];
    if (!g.motion.usable) continue;
    const ProfileBox *a = (*axes_)[i].a->box(node_a), *b = (*axes_)[i].b->box(node_b);
    if (a == nullptr || b == nullptr) continue;
    if (const auto choice = separate_curved(g.flipped ? flipped(*a) : *a, *b, g.motion, spare))
      return Found{i, *choice};
  }
  return std::nullopt;
}

std::optional<bool> CurvedPairs::thicker(std::uint32_t node_a, std::uint32_t node_b) const noexcept {
  for (std::uint32_t i = 0; i < used_; ++i) {
    const AxisPair& axes = (*axes_)[i];
    const double rise = axes.b->frame().rise;
    if (!groups_[i].motion.usable || rise == 0) continue;
    const ProfileBox *a = axes.a->box(node_a), *b = axes.b->box(node_b);
    if (a == nullptr || b == nullptr) continue;
    const float of_a = thickness(*a), of_b = thickness(*b);
    if (std::max(of_a, of_b) < kOneFlank * 2 * kPi * std::abs(rise)) return std::nullopt;
    return of_a > of_b;
  }
  return std::nullopt;
}

void CurvedPairs::write(Group& g, std::uint32_t axis, std::uint32_t slot, const CurvedChoice& choice,
                        std::uint32_t node_a, std::uint32_t node_b) noexcept {
  const ProfileBox& a = *(*axes_)[axis].a->box(node_a);
  g.lanes.set(slot, g.flipped ? flipped(a) : a, *(*axes_)[axis].b->box(node_b), g.motion.rise, choice);
}

std::uint32_t CurvedPairs::enter(const Found& found, std::uint32_t node_a, std::uint32_t node_b,
                                 std::uint32_t owner) noexcept {
  Group& g = groups_[found.axis];
  const std::uint32_t slot = g.count++;
  ++count_;
  g.owner[slot] = owner;
  write(g, found.axis, slot, found.choice, node_a, node_b);
  return slot;
}

void CurvedPairs::renew(const Found& found, std::uint32_t slot, std::uint32_t node_a, std::uint32_t node_b) noexcept {
  write(groups_[found.axis], found.axis, slot, found.choice, node_a, node_b);
}

std::uint32_t CurvedPairs::leave(std::uint32_t axis, std::uint32_t slot) noexcept {
  Group& g = groups_[axis];
  const std::uint32_t last = --g.count;
  --count_;
  if (slot == last) return kNobody;
  g.lanes.move(last, slot);
  g.owner[slot] = g.owner[last];
  return g.owner[slot];
}

std::size_t CurvedPairs::collect_failures(std::uint32_t* failed) noexcept {
  std::size_t n = 0;
  for (std::uint32_t i = 0; i < used_; ++i) {
    const Group& g = groups_[i];
    std::uint32_t* out = failed + n;
    std::size_t more = g.count;
    if (g.motion.usable)
      more = curved_failures(g.lanes, g.count, g.motion, out);
    else
      for (std::uint32_t slot = 0; slot < g.count; ++slot) out[slot] = slot;
    for (std::size_t k = 0; k < more; ++k) out[k] = g.owner[out[k]];
    n += more;
  }
  return n;
}

bool CurvedPairs::in_thread() const noexcept {
  for (std::uint32_t i = 0; i < used_; ++i)
    if (groups_[i].count > 0 && (*axes_)[i].b->frame().rise != 0) return true;
  return false;
}

std::uint32_t CurvedPairs::owner(std::uint32_t i) const {
  for (const Group& g : groups_) {
    if (i < g.count) return g.owner[i];
    i -= g.count;
  }
  return kNobody;
}

}  // namespace tegotae
