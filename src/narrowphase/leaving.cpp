#include "narrowphase/leaving.hpp"

#include <array>
#include <cmath>

#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Pairs between two looks at the clock.
constexpr int kClockStride = 64;
/// Of velocities, for the rounding of all that they are computed from.
constexpr double kVelocitySlack = 1e-6;
/// Half extents are in single precision, and axes are of unit length up to it.
constexpr double kBoxSlack = 1 + 1e-6;

double radius_of(const PatchNode& n) {
  return kBoxSlack *
         std::sqrt(double{n.half[0]} * n.half[0] + double{n.half[1]} * n.half[1] + double{n.half[2]} * n.half[2]);
}

/// What a face sees of the motion: the velocity of the other part's points, in the face's own frame.
struct Field {
  Vec3 dp, dr;
  double sign;      ///< of the velocity as the face sees it
  double center;    ///< how far the velocity of the center of mass is off `dp` at most, m
  double distance;  ///< from which the other part's points count as near, m

  /// Whether all faces under the cone recede from all points within `radius` of `at` (from the center of mass, at the
  /// start).
  bool recedes(const NormalCone& cone, const Vec3& at, double radius) const {
    const Vec3 v = sign * (dp + dr.cross(at));
    const double slack = kVelocitySlack * (dp.norm() + dr.norm() * (at.norm() + radius));
    return cone.least(v) > dr.norm() * (radius + distance) + center + slack;
  }
};

/// The velocity of the center of mass along the other reading of the path (see Sweep) is off by this at most: it is
/// the difference of ω × R(s)c and its mean over the motion.
double other_reading(const Sweep& w) {
  return 0.5 * w.theta2 * w.center_distance;
}

/// Seen from B: A's point at x has the velocity dp + dr × (x − c), c = c0 + s dp up to what the other reading leaves.
Field field_of_b(const Sweep& w) {
  const double center = other_reading(w) + w.theta * (w.dp.norm() + 0.125 * w.theta2 * w.center_distance);
  return {w.dp, w.dr, 1, center, w.floor};
}

/// Seen from A, whose axes turn by s θ: B's point at p has the velocity −(R(s)ᵀ dp + dr × p), where dr keeps its
/// direction and R(s)ᵀ dp leaves R(0)ᵀ dp by at most θ |dp|.
Field field_of_a(const Sweep& w) {
  const double center = other_reading(w) + w.theta * w.dp.norm();
  return {w.start.R.transpose() * w.dp, w.start.R.transpose() * w.dr, -1, center, w.floor};
}

}  // namespace

LeavingCheck::LeavingCheck() {
  stack_.reserve(2 * std::size_t{kMostVisits});
}

bool LeavingCheck::leaves(const LeavingSide& a, const Vec3& center, const LeavingSide& b, const Sweep& sweep, int most,
                          std::int64_t deadline_ns) noexcept {
  a_ = a;
  b_ = b;
  visits_ = 0;
  if (a.facing == nullptr && b.facing == nullptr) return false;
  const Field from_a = field_of_a(sweep), from_b = field_of_b(sweep);
  const Vec3 offset = a.tree->origin() - center;
  stack_.clear();
  stack_.push_back({0, 0, false, false});
  while (!stack_.empty()) {
    const Pair p = stack_.back();
    stack_.pop_back();
    if (++visits_ > most || (visits_ % kClockStride == 0 && past(deadline_ns))) return false;
    const PatchNode nb = p.face_b ? b.tree->face_box(p.b) : b.tree->nodes()[p.b];
    if (b.facing != nullptr && from_b.recedes(p.face_b ? b.facing->face(p.b) : b.facing->node(p.b),
                                              nb.center_vec() - sweep.start.t, radius_of(nb)))
      continue;
    const PatchNode na = p.face_a ? a.tree->face_box(p.a) : a.tree->nodes()[p.a];
    if (a.facing != nullptr &&
        from_a.recedes(p.face_a ? a.facing->face(p.a) : a.facing->node(p.a), na.center_vec() + offset, radius_of(na)))
      continue;
    if (!stays_apart(p, na, nb, center, sweep) && !push_children(p, na, nb)) return false;
  }
  return true;
}

bool LeavingCheck::stays_apart(const Pair& p, const PatchNode& na, const PatchNode& nb, const Vec3& center,
                               const Sweep& sweep) const {
  const Vec3 from_center = na.center_vec() + a_.tree->origin() - center;
  const double reach = from_center.norm() + radius_of(na);
  MovingPlane plane{Vec3::Zero(), Vec3::Zero()};
  BoxPair boxes{na, nb, from_center, reach, plane};
  separate_boxes(boxes, boxes, sweep, 0, 1);
  if (boxes.apart) return true;
  if (!p.face_a || !p.face_b) return false;
  std::array<Vec3, 3> a, b;
  for (int k = 0; k < 3; ++k) {
    a[static_cast<std::size_t>(k)] = a_.tree->corner(p.a, k) - center;
    b[static_cast<std::size_t>(k)] = b_.tree->corner(p.b, k) - b_.tree->origin();
  }
  return separate_triangles(a, b, sweep, reach, nullptr, plane);
}

/// False for two faces, which have none.
bool LeavingCheck::push_children(const Pair& p, const PatchNode& na, const PatchNode& nb) {
  if (p.face_a && p.face_b) return false;
  const bool of_a = p.face_b || (!p.face_a && radius_of(na) > radius_of(nb));
  const PatchNode& whole = of_a ? na : nb;
  const PatchTree& tree = of_a ? *a_.tree : *b_.tree;
  const std::uint32_t children = whole.leaf() ? whole.count : 2;
  if (stack_.size() + children > stack_.capacity()) return false;
  for (std::uint32_t k = 0; k < children; ++k) {
    Pair child = p;
    (of_a ? child.a : child.b) = whole.leaf() ? tree.order()[whole.first + k] : whole.first + k;
    (of_a ? child.face_a : child.face_b) = whole.leaf();
    stack_.push_back(child);
  }
  return true;
}

}  // namespace tegotae
