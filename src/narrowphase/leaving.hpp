#pragma once

#include <cstdint>
#include <vector>

#include "narrowphase/facing.hpp"
#include "narrowphase/patch_separate.hpp"

namespace tegotae {

/// The held part A or a fixed part B for a certificate of leaving motions.
struct LeavingSide {
  const PatchTree* tree;
  const Facing* facing;  ///< null where the surface may not bound a solid
};

/// The path certificate of parts that leave each other, by the normals of their faces and not by their distance: where
/// each pair of faces either stays apart during the whole motion, or one of them recedes from the other part everywhere
/// in its reach (the velocity of the other part relative to it is along its outward normal), nothing of A comes nearer
/// to B than it was, or than the sweep's floor.
///
/// To be asked only where the surfaces do not meet at the start of the motion, and for a side with a Facing only where
/// the other part is outside it. Never says yes wrongly then. No call but the constructor allocates.
class LeavingCheck {
 public:
  LeavingCheck();

  /// Most pairs that a call may look at; about 0.1 µs each.
  static constexpr int kMostVisits = 1 << 12;

  /// `center` (m, file frame) is A's center of mass. No after `most` pairs, and after `deadline_ns` of monotonic_ns().
  bool leaves(const LeavingSide& a, const Vec3& center, const LeavingSide& b, const Sweep& sweep, int most,
              std::int64_t deadline_ns) noexcept;
  /// Pairs that the last call looked at.
  int visits() const { return visits_; }

 private:
  struct Pair {
    std::uint32_t a, b;  ///< nodes of the trees, or faces
    bool face_a, face_b;
  };

  bool stays_apart(const Pair& p, const PatchNode& na, const PatchNode& nb, const Vec3& center,
                   const Sweep& sweep) const;
  bool push_children(const Pair& p, const PatchNode& na, const PatchNode& nb);

  LeavingSide a_{}, b_{};
  std::vector<Pair> stack_;
  int visits_ = 0;
};

}  // namespace tegotae
