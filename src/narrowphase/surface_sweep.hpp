#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "narrowphase/backing.hpp"
#include "narrowphase/block_slabs.hpp"
#include "narrowphase/cell_front.hpp"
#include "narrowphase/face_blocks.hpp"
#include "narrowphase/face_lanes.hpp"
#include "narrowphase/face_pair.hpp"
#include "narrowphase/patch_separate.hpp"
#include "narrowphase/patch_tree.hpp"
#include "narrowphase/receding.hpp"

namespace tegotae {

/// What is wanted of a look at a motion.
struct SweepAim {
  double clearance;  ///< separations below do not count, m
  /// Whole blocks of faces, a tenth of the work, may end the motion a seventh before faces would, and where they tell
  /// little more, wherever so much of it (m) or more is free.
  double worth = std::numeric_limits<double>::infinity();
  /// What a few faces tell to be in the way ends the motion so far (m) before it is touched: nearer, the planes of
  /// faces that lie on each other keep few of their neighbors apart.
  double kept = 12e-6;
  /// A side to which A may be drawn out at the start with no point of a part's pieces inside (see Backing). It is not,
  /// where something meets what was drawn.
  std::optional<Backing::Side> drawn = std::nullopt;
};

/// The path certificate of one motion of A by a look at all of its faces, with nothing kept for the next one: where
/// surfaces lie on each other and A moves far, a tenth of what new cells for all faces take, however far it goes. It
/// takes many ticks for a large part and goes on where it was. Mutable scratch; no call but the constructor allocates.
class SurfaceSweep {
 public:
  /// Larger surfaces are not looked at as a whole: blocks take about 1 µs a triangle at every start.
  static constexpr std::size_t kMostFaces = 1U << 20;

  /// `center` (m, file frame) is A's center of mass; `facing` of A, if it bounds a solid, and `backing` if it has one.
  /// At most `blocking` triangle pairs are told.
  SurfaceSweep(std::shared_ptr<const PatchTree> a, const Vec3& center, const std::vector<CellFront::FixedPart>& fixed,
               std::shared_ptr<const Facing> facing, std::shared_ptr<const Backing> backing, std::uint32_t blocking);

  /// Begins with the motion s -> displaced(X, center, s·d), s in [0, 1], past the parts in `near`, and likewise the one
  /// between the same two poses whose file-frame origin moves linearly (see Sweep). `outside` tells of which of them
  /// nothing is inside A: then A's faces that recede are not looked at, and the answer is about an A that is apart from
  /// them at `X`. So it is where A may be drawn out.
  void begin(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& near,
             const std::vector<bool>& outside, const SweepAim& aim) noexcept;
  /// Goes on until `deadline_ns` of monotonic_ns(), about; whether it is done.
  bool go_on(std::int64_t deadline_ns) noexcept;
  /// Whether begin() may name the part.
  bool knows(std::uint32_t part) const { return parts_[part].surface != nullptr; }
  /// Begun and not done.
  bool under_way() const { return under_way_; }

  const Pose& start() const { return X_; }
  const Displacement& motion() const { return d_; }
  const std::vector<std::uint32_t>& near() const { return near_; }
  /// When done: the part of the motion, from its start, that is free. What is met ends it, a little before it is
  /// touched where that can be.
  double share() const { return share_; }
  /// When done: what was met, the nearest last; at most as many as the constructor was told. Nothing where the motion
  /// was ended early.
  const std::vector<FacePair>& blocking() const { return blocking_; }
  /// When done: whole blocks ended the motion, or looking farther would have taken too long, and more of it may be
  /// free.
  bool ended_early() const { return ended_early_; }

 private:
  /// The faces of a tree.
  struct Surface {
    explicit Surface(const PatchTree& tree);

    FaceBlocks blocks;
    BlockSlabs slabs;
    std::vector<FaceLanes> lanes;  ///< of each block
  };
  struct Part {
    std::shared_ptr<const PatchTree> tree;
    std::shared_ptr<const Surface> surface;  ///< null: too large
    Pose pose;
  };
  struct Node {
    std::uint32_t level, index;
  };
  /// A face of A, from its center of mass, and one of B, from its origin.
  struct Faces {
    std::array<Vec3, 3> a, b;
    double reach = 0;  ///< of A's, m
  };
  /// What is done, one after the other: a few of A's faces tell about how far the motion goes, then whole blocks and
  /// the faces of those that are not enough, or all faces.
  enum class Look : std::uint8_t { sample, blocks, faces };
  /// Of A drawn out what is looked at, one after the other: nothing may meet it, and it never recedes. Then A's faces.
  enum class Layer : std::uint8_t { walls, moved_faces, faces };
  static constexpr std::uint32_t kBeside = BesideFaces::kMost;

  Sweep sweep_by(double share, double clearance) const;
  void set_share(double share);
  void start_looks();
  void start_look(Look look);
  void start_layer(Layer layer);
  void start_part();
  bool next_part();
  bool next_block();
  bool next_node();
  double node_apart_for(const Node& node);
  bool is_enough(double apart) const;
  bool may_search() const;
  bool apart_from_faces(const MovedSlab& slab, std::uint32_t block);
  MovedSlab moved(const Slab& slab) const;
  void push_below(const Node& node);
  void walk_beside(const Node& node, std::uint32_t level);
  void walk(const AxisBox& box, std::uint32_t level);
  bool recedes(const Node& node) const;
  bool none_recedes(std::uint32_t block) const;
  bool all_recede(std::uint32_t block);
  void place(std::uint32_t block);
  AxisBox face_box(std::uint32_t k) const;
  bool next_beside();
  AxisBox swept(const AxisBox& box) const;
  void look_less_far();
  void look_at_face(std::uint32_t k);
  bool look_at_pairs(std::uint32_t k, std::uint32_t block, std::uint32_t open);
  Faces faces_of(std::uint32_t face, std::uint32_t face_b) const;
  bool keeps_apart(const Faces& faces);
  void meet(const Faces& faces);
  double free_until(const Faces& faces, double clearance) const;
  const Part& part() const { return parts_[near_[at_]]; }
  const Surface& surface_b() const { return *part().surface; }

  /// Which way A's faces look, and the nodes of the levels that have slabs.
  struct Cones {
    const std::vector<NormalCone>* faces = nullptr;
    std::vector<std::vector<NormalCone>> nodes;
  };
  Cones cones_of(const std::vector<NormalCone>& faces) const;
  const Cones& cones() const { return drawn_ ? backing_cones_ : facing_cones_; }
  NormalCone seen(const NormalCone& cone) const { return drawn_ == Backing::Side::plus ? cone.turned() : cone; }
  /// Nodes are asked as a whole, and faces where those are not kept apart.
  bool by_nodes() const { return look_ == Look::blocks || (look_ == Look::faces && layer_ != Layer::faces); }
  bool may_recede() const { return layer_ == Layer::faces && (drawn_ || outside_[at_]); }

  std::shared_ptr<const PatchTree> a_;
  std::shared_ptr<const Facing> facing_;
  std::shared_ptr<const Backing> backing_;
  std::shared_ptr<const Surface> surface_of_a_;
  std::array<std::shared_ptr<const Surface>, 2> walls_;  ///< on each side of the backing; null: none
  Cones facing_cones_, backing_cones_;                   ///< if there are those
  Vec3 center_;
  double reach_;  ///< of A about its center of mass, m
  std::vector<Part> parts_;
  std::vector<FacePair> blocking_;

  bool under_way_ = false;
  Pose X_;
  Displacement d_;
  double clearance_ = 0, kept_ = 0, worth_ = 0, share_ = 1;
  double sampled_share_ = 1;           ///< that faces have left
  bool ended_early_ = false;           ///< share_ is no more than that, and nothing was met at it
  bool halved_ = false;                ///< sampled_share_ is what it is because all of it would have taken too long
  std::uint32_t searched_blocks_ = 0;  ///< of A, face by face, while whole ones were looked at
  std::vector<std::uint32_t> near_;
  std::vector<bool> outside_;  ///< of each of them: faces that recede from it are not looked at
  std::optional<Backing::Side> drawn_;
  Look look_ = Look::sample;
  Layer layer_ = Layer::faces;
  const PatchTree* tree_a_ = nullptr;  ///< of the layer
  const Surface* surface_a_ = nullptr;
  Vec3 shift_a_ = Vec3::Zero();   ///< by which its faces are moved, m
  Vec3 offset_a_ = Vec3::Zero();  ///< of the tree's origin, moved, from the center of mass
  std::uint32_t at_ = 0;          ///< of near_
  std::uint32_t sampled_ = 0;     ///< the next block of the sample
  std::array<Node, FaceBlocks::kMostLevels * FaceBlocks::kFan> stack_;  ///< of A's hierarchy
  std::uint32_t stacked_ = 0;
  Sweep sweep_;  ///< of the share of the motion, past the part
  PassingPoints passing_;
  double floor_ = 0;  ///< of straight ways: the clearance and what arcs may leave of them, m

  std::uint32_t block_ = 0, face_ = 0, faces_ = 0;  ///< of A, which is looked at
  std::uint32_t passed_ = 0, asked_ = 0;            ///< blocks of B beside it, and exact answers, until now
  double sizes_passed_ = 0;                         ///< its way as times of its size
  std::uint32_t skipped_ = 0;                       ///< a bit for each face of it that recedes
  MovedLanes moved_;
  Vec3 middle_ = Vec3::Zero();
  BlockWalk walk_;
  std::array<std::uint32_t, BlockWalk::kMostTops>
      tops_;                      ///< nodes of B beside that one of A whose blocks are looked at
  std::uint32_t tops_count_ = 0;  ///< none: from the root
  std::array<std::uint32_t, kBeside> found_;
  BesideFaces beside_;                                  ///< of found_, beside A's block
  std::array<float, 3> across_{};                       ///< a direction that kept two faces apart, in B's axes
  MovingPlane last_plane_{Vec3::Zero(), Vec3::Zero()};  ///< that kept two faces apart
};

}  // namespace tegotae
