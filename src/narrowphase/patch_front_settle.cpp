// What a PatchFront does about a pair whose plane does not hold: another plane, a common axis, or taking it apart.
#include <algorithm>
#include <cmath>

#include "narrowphase/patch_front.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Searches of boxes between two looks at the clock, and how many of them one of triangles counts.
constexpr int kPatchClockStride = 16, kTriangleWorth = 4;
/// One pair of the front stops after so many blocking triangle pairs: the rest of the same patches says little more.
constexpr std::size_t kBlocksPerPair = 2;
/// See curves_pay(): hardly any is less than one in so many of the last ones.
constexpr int kHardlyAny = 32, kBendsCounted = 256, kAskedSeldom = 8;
/// Where planes may go on with A: of two that are about as good the one that rests is as good later, and cheaper.
constexpr double kWorthOfA = 0.5;

}  // namespace

PatchFront::Outcome PatchFront::settle(const Unsettled& top, Unsettled& next) {
  const std::size_t before = blocking_.size();
  stack_.clear();
  stack_.push_back(top);
  while (!stack_.empty()) {
    Unsettled& now = stack_.back();
    const std::uint32_t id = now.id;
    const PairNode& p = pool_[id];
    if (!spend(faces(p))) return leave_off(Outcome::out_of_work);
    if (faces(p)) {
      if (!part_faces(id)) {
        blocking_.push_back({p.a, p.b});
        if (blocking_.size() >= std::min(capacity_.blocking, limit_.blocking) ||
            blocking_.size() - before == kBlocksPerPair)
          return leave_off(Outcome::blocked);
        admit(id);
      }
      stack_.pop_back();
    } else if (part_boxes(now, stack_.size() > 1 ? stack_[stack_.size() - 2] : next)) {
      stack_.pop_back();
    } else if (split(id)) {
      stack_.pop_back();
      for (std::uint32_t k = 0; k < p.children; ++k) stack_.emplace_back().id = p.child + k;
    } else {
      report_.overflow = true;
      return leave_off(Outcome::out_of_work);
    }
  }
  return blocking_.size() > before ? Outcome::blocked : Outcome::free;
}

bool PatchFront::spend(bool triangles) {
  if (++report_.searches > limit_.searches) return false;
  // A triangle pair may halve its time and cost as much as all boxes of a stride; hardly any does.
  since_clock_ += triangles ? kTriangleWorth : 1;
  if (since_clock_ < kPatchClockStride) return true;
  since_clock_ = 0;
  return !past(limit_.deadline_ns);
}

/// Ends with `outcome` before all is settled: what is left on the stack stays with planes that may fail.
PatchFront::Outcome PatchFront::leave_off(Outcome outcome) {
  for (const Unsettled& other : stack_) admit(other.id);
  return outcome;
}

/// Gives a pair that waits for a plane the one of the pair that it comes of.
void PatchFront::admit(std::uint32_t id) {
  PairNode& p = pool_[id];
  if (!p.waits) return;
  p.waits = false;
  write_piece(p);
  write_plane(id, Vec3(p.normal[0], p.normal[1], p.normal[2]));
}

bool PatchFront::part_faces(std::uint32_t id) {
  const PairNode& p = pool_[id];
  const auto a = face_a(p.a), b = face_b(p.b);
  const double reach = std::sqrt(std::max({a[0].squaredNorm(), a[1].squaredNorm(), a[2].squaredNorm()}));
  MovingPlane known = moving(plane(id));
  if (!separate_triangles(a, b, sweep_, reach, &beside_, known)) return false;
  beside_ = known;
  set_plane(id, last(known));
  return true;
}

/// `other` comes after it, and is asked about with it.
bool PatchFront::part_boxes(Unsettled& now, Unsettled& other) {
  const PairNode& p = pool_[now.id];
  // What was curved is asked so first, what was flat last.
  if (p.curved > 0 && bend(now.id, 0)) return true;
  if (!now.asked) ask(now, other);
  if (!now.apart) return p.curved == 0 && curves_pay() && try_to_bend(now.id);
  flatten(now.id);
  set_plane(now.id, last(now.plane));
  return true;
}

void PatchFront::ask(Unsettled& now, Unsettled& other) {
  const bool both = other.id != kNoPair && !other.asked && !faces(pool_[other.id]) && pool_[other.id].curved == 0;
  Unsettled& second = both ? other : now;
  const PairNode &p = pool_[now.id], &q = pool_[second.id];
  std::array<PatchNode, 4> scratch;
  const PatchNode &a = box_a(p, scratch[0]), &b = box_b(p, scratch[1]);
  const PatchNode &c = box_a(q, scratch[2]), &d = box_b(q, scratch[3]);
  const Vec3 center_a = node_center(a), center_c = node_center(c);
  BoxPair one{a, b, center_a, reach_from(center_a, a), moving(plane(now.id))};
  BoxPair two{c, d, center_c, reach_from(center_c, c), moving(plane(second.id))};
  separate_boxes(one, two, sweep_, 0, worth_of_a());
  now.asked = second.asked = true;
  now.apart = one.apart;
  now.plane = one.plane;
  second.apart = two.apart;
  second.plane = two.plane;
}

double PatchFront::worth_of_a() const {
  return slides_ ? kWorthOfA : 1;
}

/// Where hardly any pair that no plane keeps apart is apart about an axis, few are asked.
bool PatchFront::curves_pay() {
  return asked_to_bend_ < kBendsCounted / 2 || kHardlyAny * bent_ >= asked_to_bend_ ||
         ++passed_over_ % kAskedSeldom == 0;
}

bool PatchFront::try_to_bend(std::uint32_t id) {
  if (++asked_to_bend_ > kBendsCounted) {
    asked_to_bend_ /= 2;
    bent_ /= 2;
  }
  if (!bend(id, 0)) return false;
  ++bent_;
  return true;
}

}  // namespace tegotae
