// The tree of splits of a PatchFront: pairs come apart, go together again, enter the lanes and leave them.
#include <algorithm>
#include <cmath>

#include "narrowphase/patch_front.hpp"

namespace tegotae {
namespace {

/// A leaf is taken apart for a patch on the other side of less than this part of its second extent: without it, a
/// coarse mesh against a fine one is refined on the fine side only, down to its faces; with 1, leaves come apart too
/// often.
constexpr float kLeafWorth = 0.5f;

}  // namespace

std::uint32_t PatchFront::allocate(std::uint32_t children) {
  const bool two = children <= 2;
  std::uint32_t& head = two ? free_twos_ : free_fans_;
  if (head != kNoPair) {
    const std::uint32_t id = head;
    head = pool_[id].child;
    // The next one taken was free for long, and is in no cache.
    if (head != kNoPair)
      for (const std::uint32_t next : {head, head + 1}) __builtin_prefetch(&pool_[next], 1);
    return id;
  }
  const std::uint32_t size = two ? 2 : kFan;
  if (pool_used_ + size > pool_.size()) return kNoPair;
  pool_used_ += size;
  return pool_used_ - size;
}

bool PatchFront::split(std::uint32_t id) {
  const PairNode p = pool_[id];
  PatchNode scratch_a, scratch_b;
  const PatchNode &a = box_a(p, scratch_a), &b = box_b(p, scratch_b);
  // The side with the larger second extent: a long strip is as good as a short one while it is narrow.
  const bool ends = a.leaf() && b.leaf();
  auto worth = [](const PatchNode& n) { return n.leaf() ? kLeafWorth : 1.0f; };
  bool split_a = !p.face_a && (p.face_b || worth(a) * a.half[1] > worth(b) * b.half[1]);
  if (!ends && !p.face_a && !p.face_b && !a.leaf() && !b.leaf())
    if (const auto thicker = curved_.thicker(p.a, p.b)) split_a = *thicker;
  const std::uint32_t of_a = p.face_a ? 1 : a.leaf() ? a.count : 2, of_b = p.face_b ? 1 : b.leaf() ? b.count : 2;
  const std::uint32_t children = ends ? of_a * of_b : split_a ? of_a : of_b;
  if (static_cast<std::uint32_t>(pairs()) + children > capacity_.pairs || splits_.size() == splits_.capacity() ||
      stack_.size() + children > stack_.capacity()) {
    return false;
  }
  const std::uint32_t child = allocate(children);
  if (child == kNoPair) return false;
  const Plane known = plane(id);
  leave(id);
  PairNode& parent = pool_[id];
  parent.child = child;
  parent.children = children & 0xf;
  parent.curved = 0;
  parent.waits = false;
  parent.wait = 0;
  put_off(id);
  for (int k = 0; k < 3; ++k) parent.normal[k] = static_cast<float>(known.n[k]);
  const std::array<float, 3> normal = parent.normal;
  for (std::uint32_t k = 0; k < children; ++k) {
    PairNode& c = pool_[child + k];
    c = {p.a, p.b, id, kNoPair, 0, 0, 0, p.face_a, p.face_b, p.with_a, false, normal, 0, 0};
    if ((ends || split_a) && !p.face_a) {
      const std::uint32_t place = a.first + (ends ? k / of_b : k);
      c.face_a = a.leaf();
      c.a = a.leaf() ? a_->order()[place] : place;
    }
    if ((ends || !split_a) && !p.face_b) {
      const std::uint32_t place = b.first + (ends ? k % of_b : k);
      c.face_b = b.leaf();
      c.b = b.leaf() ? b_->order()[place] : place;
    }
    take_place(child + k);
  }
  splits_.push_back(id);
  return true;
}

void PatchFront::collapse(std::uint32_t id) {
  const PairNode& p = pool_[id];
  const std::uint32_t child = p.child, children = p.children;
  for (std::uint32_t k = 0; k < children; ++k) leave(child + k);
  std::uint32_t& head = children <= 2 ? free_twos_ : free_fans_;
  pool_[child].child = head;
  head = child;
  pool_[id].children = 0;
  pool_[id].child = kNoPair;
  enter(id);
}

/// Keeps the pair apart about a common axis, whether it is in the front or split into pairs that all are.
bool PatchFront::bend(std::uint32_t id, double spare) {
  const PairNode& p = pool_[id];
  if (p.face_a || p.face_b) return false;
  const auto found = curved_.separate(p.a, p.b, spare);
  if (!found) return false;
  if (p.children == 0 && p.curved == found->axis + 1) {
    curved_.renew(*found, p.slot, p.a, p.b);
    return true;
  }
  if (curved_.full(found->axis)) return false;
  if (p.children > 0) collapse(id);
  flatten(id);
  const Plane known = plane(id);
  leave(id);
  PairNode& bent = pool_[id];
  for (int k = 0; k < 3; ++k) bent.normal[k] = static_cast<float>(known.n[k]);
  bent.curved = (found->axis + 1) & 0xf;
  bent.waits = false;
  bent.slot = curved_.enter(*found, bent.a, bent.b, id);
  return true;
}

/// Back to a plane; to be followed by set_plane.
void PatchFront::flatten(std::uint32_t id) {
  if (pool_[id].curved == 0) return;
  leave(id);
  pool_[id].curved = 0;
  enter(id);
}

std::uint32_t PatchFront::in_front(std::uint32_t i) const {
  for (const Group& g : groups_) {
    if (i < g.count) return g.owner[i];
    i -= g.count;
  }
  return curved_.owner(i);
}

bool PatchFront::all_in_front(std::uint32_t id) const {
  const PairNode& p = pool_[id];
  for (std::uint32_t k = 0; k < p.children; ++k) {
    if (pool_[p.child + k].children > 0) return false;
  }
  return true;
}

void PatchFront::enter(std::uint32_t id) {
  take_place(id);
  admit(id);
}

void PatchFront::take_place(std::uint32_t id) {
  PairNode& p = pool_[id];
  Group& g = group(p);
  p.slot = g.count++;
  p.waits = true;
  g.owner[p.slot] = id;
}

void PatchFront::write_piece(const PairNode& p) {
  if (faces(p))
    write_triangle(p);
  else
    write_box(p);
}

/// The triangle that moves past the plane.
void PatchFront::write_triangle(const PairNode& p) {
  LaneBlocks& lanes = group(p).lanes;
  const auto moving = p.with_a ? face_b(p.b) : face_a(p.a);
  double reach2 = 0;
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) lanes.at(p.slot, kTriCorners + 3 * k + i) = static_cast<float>(moving[k][i]);
    reach2 = std::max(reach2, moving[k].squaredNorm());
  }
  lanes.at(p.slot, kTriReach) = round_up<float>(std::sqrt(reach2));
}

/// The box that moves past the plane.
void PatchFront::write_box(const PairNode& p) {
  LaneBlocks& lanes = group(p).lanes;
  PatchNode scratch;
  const PatchNode& moving = p.with_a ? box_b(p, scratch) : box_a(p, scratch);
  const Vec3 c = p.with_a ? moving.center_vec() : node_center(moving);
  for (int i = 0; i < 3; ++i) {
    lanes.at(p.slot, kBoxCenter + i) = static_cast<float>(c[i]);
    for (int k = 0; k < 3; ++k) lanes.at(p.slot, kBoxEdges + 3 * i + k) = moving.half[i] * moving.axis[i][k];
  }
  lanes.at(p.slot, kBoxReach) = round_up<float>(reach_from(c, moving));
}

void PatchFront::leave(std::uint32_t id) {
  if (const std::uint32_t curved = pool_[id].curved; curved > 0) {
    const std::uint32_t moved = curved_.leave(curved - 1, pool_[id].slot);
    if (moved != CurvedPairs::kNobody) pool_[moved].slot = pool_[id].slot;
    return;
  }
  Group& g = group(pool_[id]);
  const std::uint32_t slot = pool_[id].slot, last = --g.count;
  if (slot == last) return;
  g.lanes.move(last, slot);
  g.owner[slot] = g.owner[last];
  pool_[g.owner[slot]].slot = slot;
}

/// Gives a pair of the front, not a curved one, its plane.
void PatchFront::set_plane(std::uint32_t id, const Plane& plane) {
  PairNode& p = pool_[id];
  if (p.with_a == plane.with_a) {
    if (p.waits) write_piece(p);
    p.waits = false;
    return write_plane(id, plane.n);
  }
  leave(id);
  p.with_a = plane.with_a;
  for (int k = 0; k < 3; ++k) p.normal[k] = static_cast<float>(plane.n[k]);
  enter(id);
}

void PatchFront::write_plane(std::uint32_t id, const Vec3& n) {
  const PairNode& p = pool_[id];
  LaneBlocks& lanes = group(p).lanes;
  // From the piece that rests to the one that moves past it.
  const double sign = p.with_a ? -1 : 1;
  Vec3 rounded;
  for (int k = 0; k < 3; ++k) {
    lanes.at(p.slot, kBoxNormal + k) = static_cast<float>(sign * n[k]);
    rounded[k] = lanes.at(p.slot, kBoxNormal + k);
  }
  double support = -std::numeric_limits<double>::infinity();
  if (faces(p)) {
    for (const Vec3& v : p.with_a ? face_a(p.a) : face_b(p.b)) support = std::max(support, rounded.dot(v));
  } else {
    PatchNode scratch;
    const PatchNode& rests = p.with_a ? box_a(p, scratch) : box_b(p, scratch);
    support = rounded.dot(p.with_a ? node_center(rests) : rests.center_vec());
    for (int i = 0; i < 3; ++i) support += rests.half[i] * std::abs(rounded.dot(rests.axis_vec(i)));
  }
  lanes.at(p.slot, kBoxOffset) = static_cast<float>(support);
}

PatchFront::Plane PatchFront::plane(std::uint32_t id) const {
  const PairNode& p = pool_[id];
  if (p.curved > 0 || p.waits) return {{p.normal[0], p.normal[1], p.normal[2]}, p.with_a};
  const LaneBlocks& lanes = groups_[kind(p)].lanes;
  const Vec3 n(lanes.at(p.slot, kBoxNormal), lanes.at(p.slot, kBoxNormal + 1), lanes.at(p.slot, kBoxNormal + 2));
  return {p.with_a ? Vec3(-n) : n, p.with_a};
}

/// How the plane goes in the motion.
MovingPlane PatchFront::moving(const Plane& plane) const {
  if (!plane.with_a) return {plane.n, plane.n, false};
  return {sweep_.start.R * plane.n, sweep_.end.R * plane.n, true};
}

/// The plane at the end of the motion, fixed to the part that it went with. Only parts that slide about a common axis
/// meet the same faces for so long that a plane which turns with A pays.
PatchFront::Plane PatchFront::last(const MovingPlane& plane) const {
  if (!plane.with_a || !slides_) return {plane.n1, false};
  return {sweep_.end.R.transpose() * plane.n1, true};
}

double PatchFront::one_sidedness() const noexcept {
  Vec3 to_a = Vec3::Zero();
  for (const Group& g : groups_)
    for (std::uint32_t i = 0; i < g.count; ++i) to_a += moving(plane(g.owner[i])).n1;
  return pairs() > 0 ? to_a.norm() / pairs() : 0;
}

double PatchFront::reach_from(const Vec3& center, const PatchNode& n) {
  // Half edges may not be quite orthogonal (single precision), which the sum of their lengths squared does not see.
  constexpr double kSkew = 1 + 1e-6;
  const double half2 = double{n.half[0]} * n.half[0] + double{n.half[1]} * n.half[1] + double{n.half[2]} * n.half[2];
  return center.norm() + kSkew * std::sqrt(half2);
}

std::array<Vec3, 3> PatchFront::face_a(std::uint32_t f) const {
  return {a_->corner(f, 0) - center_, a_->corner(f, 1) - center_, a_->corner(f, 2) - center_};
}

std::array<Vec3, 3> PatchFront::face_b(std::uint32_t f) const {
  const Vec3& o = b_->origin();
  return {b_->corner(f, 0) - o, b_->corner(f, 1) - o, b_->corner(f, 2) - o};
}

}  // namespace tegotae
