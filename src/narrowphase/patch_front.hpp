#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "narrowphase/certify.hpp"
#include "narrowphase/curved_pairs.hpp"
#include "narrowphase/lane_motion.hpp"
#include "narrowphase/patch_lanes.hpp"
#include "narrowphase/patch_separate.hpp"
#include "narrowphase/patch_tree.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Capacities of a PatchFront. Exceeding one never makes a wrong answer: the motion is then not certified.
struct FrontCapacity {
  std::uint32_t pairs = 1u << 15;  ///< pairs of patches or triangles in the front
  std::uint32_t blocking = 32;     ///< blocking triangle pairs that one call reports
  std::uint32_t curved = 0;        ///< pairs about each of kMaxAxisPairs common axes
};

/// Two triangles that stop a motion.
struct BlockingPair {
  std::uint32_t face_a, face_b;
};

/// The path certificate of one pair of parts (mutable scratch; the trees are shared): keeps a front of node pairs that
/// covers all pairs of triangles, each pair with the plane that separated it last. A motion is free when every pair of
/// the front has a plane, moving linearly over the motion, that keeps its two sides apart (see moving_plane.hpp).
/// No call but the constructor allocates.
class PatchFront {
 public:
  explicit PatchFront(const FrontCapacity& capacity = {});

  /// Starts over between `a` (with its center of mass `center_A`, m, file frame) and `b`; they must outlive the front's
  /// use, and so must `axes`, about which pairs that no plane keeps apart may be kept apart instead. The next call of
  /// certify builds the front (a few hundred µs in a tight fit).
  void attach(const PatchTree& a, const Vec3& center_A, const PatchTree& b,
              const std::vector<AxisPair>* axes = nullptr) noexcept;

  /// Separations below `clearance` (m) count as blocked from now on; 0 leaves just the rounding.
  void set_clearance(double clearance) noexcept { clearance_ = clearance; }

  /// Is the motion s -> displaced(X_BA, center_A, s·d), s in [0, 1], of A past the resting B free of intersecting
  /// triangles, and likewise the one between the same two poses whose file-frame origin moves linearly? `X_BA` is A's
  /// file frame in B's, `d` is expressed in B's axes. The start need not be certified before. Never says certified
  /// wrongly; a motion of length zero asks whether the start is free.
  CertifyReport certify(const Pose& X_BA, const Displacement& d, const WorkLimit& limit = {}) noexcept;

  /// What stopped the last motion, when its status was `blocked`; at most FrontCapacity::blocking.
  const std::vector<BlockingPair>& blocking() const { return blocking_; }

  /// Length of the mean normal of all planes: 1 when they face one way, 0 when they face each other.
  double one_sidedness() const noexcept;

  int pairs() const {
    std::uint32_t flat = 0;
    for (const Group& g : groups_) flat += g.count;
    return static_cast<int>(flat + curved_.count());
  }
  /// Of them those that are kept apart about a common axis.
  int curved_pairs() const { return static_cast<int>(curved_.count()); }
  /// Whether pairs are kept apart about the axis of a thread.
  bool in_thread() const noexcept { return curved_.in_thread(); }

  /// Calls f(a, a_is_face, b, b_is_face) for every pair of the front: nodes of the trees, or faces.
  template <typename F>
  void for_each_pair(F f) const {
    for (const Group& g : groups_) {
      for (std::uint32_t i = 0; i < g.count; ++i) {
        const PairNode& p = pool_[g.owner[i]];
        f(p.a, p.face_a, p.b, p.face_b);
      }
    }
    curved_.for_each([&](std::uint32_t id) { f(pool_[id].a, false, pool_[id].b, false); });
  }

 private:
  /// A pair of the tree of splits; those without children are the front. Each on a cache line of its own: they are met
  /// in no order.
  struct alignas(64) PairNode {
    std::uint32_t a, b;         ///< nodes, or faces
    std::uint32_t parent;       ///< kNoPair for the root
    std::uint32_t child;        ///< first of `children` in a row
    std::uint32_t slot;         ///< in its group, while in the front
    std::uint8_t children : 4;  ///< 0: in the front
    std::uint8_t curved : 4;    ///< kept apart about the axis pair of this number less one; 0: by a plane
    bool face_a, face_b;        ///< which of a and b are faces
    bool with_a;                ///< its plane is fixed to A, and not to B
    bool waits;                 ///< in the front without lanes: most pairs of a split are split on or get another plane
    std::array<float, 3> normal;  ///< last plane (see Plane), kept here while split, curved or waiting
    float wait;                   ///< travel between two tries to raise it, m
    double retry;                 ///< travel_ from which on it may be raised
  };
  /// A plane between two nodes that is fixed to one of them: its normal, from B to A, in the axes of A or of B.
  struct Plane {
    Vec3 n;
    bool with_a;
  };
  /// The pairs of the front of one kind, dense. Of pairs whose plane is fixed to A the lanes hold the mirror image: the
  /// piece of B that moves past a plane over the piece of A.
  struct Group {
    Group(std::uint32_t capacity, std::size_t fields) : lanes(capacity, fields), owner(capacity) {}
    LaneBlocks lanes;
    std::vector<std::uint32_t> owner;
    std::uint32_t count = 0;
  };

  /// By what the pairs are of, and the part that their planes are fixed to.
  enum GroupKind : std::size_t { kBoxesOnB, kFacesOnB, kBoxesOnA, kFacesOnA, kGroups };

  static constexpr std::uint32_t kNoPair = 0xffffffffu;
  /// Most children of a pair: all triangle pairs of two leaves.
  static constexpr std::uint32_t kFan = kPatchLeaf * kPatchLeaf;
  static_assert(kFan < 16 && kMaxAxisPairs < 15, "PairNode has four bits for each");

  enum class Outcome : std::uint8_t { free, blocked, out_of_work };
  /// A pair whose plane does not hold, and whether its boxes were asked about already.
  struct Unsettled {
    std::uint32_t id = kNoPair;
    bool asked = false, apart = false;
    MovingPlane plane{Vec3::Zero(), Vec3::Zero()};  ///< once it was asked
  };

  void set_sweep(const Pose& X_BA, const Displacement& d);
  bool collect_failures();
  void collect(GroupKind kind, std::uint32_t first, std::uint32_t end, const LaneSweep& sweep);
  void look_ahead(const Pose& X_BA, const Displacement& d);
  Outcome settle(const Unsettled& top, Unsettled& next);
  bool part_faces(std::uint32_t id);
  bool part_boxes(Unsettled& now, Unsettled& other);
  void ask(Unsettled& now, Unsettled& other);
  bool spend(bool triangles);
  bool split(std::uint32_t id);
  void collapse(std::uint32_t id);
  void roll_back();
  void raise();
  void fetch_ahead(std::uint32_t count) const;
  bool bend(std::uint32_t id, double spare);
  bool curves_pay();
  bool try_to_bend(std::uint32_t id);
  void flatten(std::uint32_t id);
  std::uint32_t in_front(std::uint32_t i) const;  ///< the i-th of pairs()
  bool all_in_front(std::uint32_t id) const;      ///< the children
  bool may_raise(std::uint32_t id) const;
  bool try_raise(std::uint32_t id);
  void put_off(std::uint32_t id);

  std::uint32_t allocate(std::uint32_t children);
  void admit(std::uint32_t id);
  Outcome leave_off(Outcome outcome);
  void enter(std::uint32_t id);
  void take_place(std::uint32_t id);
  void write_piece(const PairNode& p);
  void leave(std::uint32_t id);
  void set_plane(std::uint32_t id, const Plane& plane);
  void write_plane(std::uint32_t id, const Vec3& n);
  void write_triangle(const PairNode& p);
  void write_box(const PairNode& p);
  Plane plane(std::uint32_t id) const;
  MovingPlane moving(const Plane& plane) const;
  Plane last(const MovingPlane& plane) const;
  double worth_of_a() const;
  static bool faces(const PairNode& p) { return p.face_a && p.face_b; }
  static GroupKind kind(const PairNode& p) {
    if (faces(p)) return p.with_a ? kFacesOnA : kFacesOnB;
    return p.with_a ? kBoxesOnA : kBoxesOnB;
  }
  Group& group(const PairNode& p) { return groups_[kind(p)]; }

  /// The boxes of a pair that is not of two faces; a face's is written to `scratch`.
  const PatchNode& box_a(const PairNode& p, PatchNode& scratch) const {
    return p.face_a ? scratch = a_->face_box(p.a) : a_->nodes()[p.a];
  }
  const PatchNode& box_b(const PairNode& p, PatchNode& scratch) const {
    return p.face_b ? scratch = b_->face_box(p.b) : b_->nodes()[p.b];
  }
  Vec3 node_center(const PatchNode& n) const { return n.center_vec() + offset_a_; }
  double node_reach(const PatchNode& n) const { return reach_from(node_center(n), n); }
  static double reach_from(const Vec3& center, const PatchNode& n);
  std::array<Vec3, 3> face_a(std::uint32_t f) const;
  std::array<Vec3, 3> face_b(std::uint32_t f) const;

  FrontCapacity capacity_;
  double clearance_ = 0;
  const PatchTree* a_ = nullptr;
  const PatchTree* b_ = nullptr;
  Vec3 center_ = Vec3::Zero();    ///< A's center of mass, file frame
  Vec3 offset_a_ = Vec3::Zero();  ///< from the center of mass to the origin of A's tree
  PairSizes sizes_{};

  std::vector<PairNode> pool_;
  std::uint32_t pool_used_ = 0;
  std::uint32_t free_twos_ = 0, free_fans_ = 0;  ///< heads of the free lists, linked through `child`
  std::array<Group, kGroups> groups_;
  CurvedPairs curved_;
  std::vector<std::uint32_t>
      failures_;  ///< the first failure_count_ of them; clearing all would cost more than a check
  std::size_t failure_count_ = 0;
  std::vector<Unsettled> stack_;
  std::vector<std::uint32_t> splits_;
  std::vector<BlockingPair> blocking_;
  std::uint32_t cursor_ = 0;                            ///< where raising goes on
  double motion_ = 0;                                   ///< longest motion of late, m
  double travel_ = 0;                                   ///< sum of the lengths of all motions, m
  bool slides_ = false;                                 ///< the parts have a common axis
  bool screws_ = false;                                 ///< and it is a thread's
  std::uint32_t slice_ = 0;                             ///< of the front that was looked at ahead last
  int asked_to_bend_ = 0, bent_ = 0, passed_over_ = 0;  ///< see curves_pay()
  int since_clock_ = 0;                                 ///< searches since the last look at it
  int debt_ = 0;                                        ///< pairs to raise, for those that were split
  int effort_ = 0;  ///< pairs that one call tries to raise, fitted to what comes of it

  Sweep sweep_;
  MovingPlane beside_{Vec3::Zero(), Vec3::Zero()};  ///< of the triangles that were kept apart last in the motion
  WorkLimit limit_;
  CertifyReport report_;
};

}  // namespace tegotae
