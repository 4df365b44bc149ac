#include "narrowphase/leaving.hpp"

#include <array>
#include <cmath>

#include "narrowphase/receding.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Pairs between two looks at the clock.
constexpr int kClockStride = 64;
/// Half extents are in single precision, and axes are of unit length up to it.
constexpr double kBoxSlack = 1 + 1e-6;

double radius_of(const PatchNode& n) {
  return kBoxSlack *
         std::sqrt(double{n.half[0]} * n.half[0] + double{n.half[1]} * n.half[1] + double{n.half[2]} * n.half[2]);
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
  const PassingPoints from_a = PassingPoints::seen_from_a(sweep), from_b = PassingPoints::seen_from_b(sweep);
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
