#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "narrowphase/beside_faces.hpp"
#include "narrowphase/patch_separate.hpp"
#include "narrowphase/receding.hpp"
#include "narrowphase/sweep_model.hpp"
#include "narrowphase/sweep_task.hpp"

namespace tegotae {

/// What one thread needs to do pieces of a SweepTask: a few nodes of A's hierarchy each, and what is under them, or
/// blocks of the sample. Mutable scratch; nothing allocates.
class SweepWorker {
 public:
  using Look = SweepTask::Look;
  using Layer = SweepTask::Layer;

  explicit SweepWorker(std::shared_ptr<const SweepModel> model) : model_(std::move(model)) {}

  /// How many pieces the question has.
  static std::uint32_t pieces(const SweepModel& model, const SweepTask::Question& question);
  /// How many a question may have.
  static std::size_t most_pieces(const SweepModel& model);

  /// Before work(), of its owner: whether there may be anything to do.
  bool begin(SweepTask& task);
  /// Does pieces of the task until there are none, or until `deadline_ns` of monotonic_ns(), about, and goes on with
  /// the one that it was at. Whether it has nothing to do any more.
  bool work(SweepTask& task, std::int64_t deadline_ns);

 private:
  struct Node {
    std::uint32_t level, index;
    bool open = false;  ///< it is known not to be apart as a whole for all of the motion
  };
  /// Nodes of B beside one of A on the same level: what is under that is beside what is under these.
  struct Tops {
    std::array<std::uint32_t, BlockWalk::kMostTops> nodes;
    std::uint32_t count = 0;  ///< none: too many, or not looked for
  };
  static constexpr std::uint32_t kTopLevels = 2;
  /// A face of A, from its center of mass, and one of B, from its origin.
  struct Faces {
    std::array<Vec3, 3> a, b;
    double reach = 0;  ///< of A's, m
  };
  using Surface = SweepModel::Surface;
  static constexpr std::uint32_t kBeside = BesideFaces::kMost;

  void set_share(double share);
  Sweep sweep_by(double share, double clearance) const;
  void refresh_share();
  bool next_in_piece();
  void start_piece();
  void next_block();
  void next_node();
  double node_apart_for(const Node& node);
  double apart_from(const MovedSlab& slab, const SlabEnds& ends, const Vec3& middle, const AxisBox& box,
                    const Node& other) const;
  std::uint32_t apart_by_heights(const Node& node, const SlabEnds& ends, const Vec3& middle, const Node& eight,
                                 QuadricLanes::Field& share) const;
  bool is_enough(double apart) const;
  double few_blocks() const;
  bool may_search() const;
  void push_blocks(const Node& node);
  bool apart_from_faces(std::uint32_t block, const SlabEnds& ends, const Vec3& origin, std::uint32_t count);
  MovedSlab moved(const Slab& slab) const;
  void push_below(const Node& node);
  AxisBox walk_beside(const Node& node, std::uint32_t level);
  void find_tops(const Node& node, const AxisBox& box);
  void walk(const AxisBox& box, std::uint32_t level);
  bool recedes(const Node& node) const;
  bool none_recedes(std::uint32_t block) const;
  bool all_recede(std::uint32_t block);
  void place(std::uint32_t block);
  bool next_beside();
  AxisBox swept(const AxisBox& box) const;
  void look_less_far();
  void look_at_face(std::uint32_t k);
  bool look_at_pairs(std::uint32_t k, std::uint32_t block, std::uint32_t open);
  Faces faces_of(std::uint32_t face, std::uint32_t face_b) const;
  bool keeps_apart(const Faces& faces);
  void meet(const Faces& faces, std::uint32_t face, std::uint32_t face_b);
  double free_until(const Faces& faces, double clearance) const;

  const SweepTask::Question& question() const { return task_->question(); }
  const SweepModel::Part& part() const { return model_->parts[question().part]; }
  const Surface& surface_b() const { return *part().surface; }
  const SweepModel::Cones& cones() const { return question().drawn ? model_->backing_cones : model_->facing_cones; }
  NormalCone seen(const NormalCone& cone) const {
    return question().drawn == Backing::Side::plus ? cone.turned() : cone;
  }
  /// Nodes are asked as a whole, and faces where those are not kept apart.
  bool by_nodes() const {
    return question().look == Look::blocks ||
           (question().look == Look::faces && (question().layer != Layer::faces || nodes_tell()));
  }
  bool nodes_tell() const;
  bool may_recede() const {
    return question().layer == Layer::faces && (question().drawn || (model_->facing && question().outside));
  }

  std::shared_ptr<const SweepModel> model_;
  SweepTask* task_ = nullptr;
  std::uint64_t id_ = 0;  ///< of the task's question
  std::optional<std::uint32_t> piece_;
  double share_ = 1;                   ///< of the motion, which is looked at
  const PatchTree* tree_a_ = nullptr;  ///< of the layer
  const Surface* surface_a_ = nullptr;
  Vec3 shift_a_ = Vec3::Zero();   ///< by which its faces are moved, m
  Vec3 offset_a_ = Vec3::Zero();  ///< of the tree's origin, moved, from the center of mass
  std::array<Node, FaceBlocks::kMostLevels * FaceBlocks::kFan> stack_;  ///< of A's hierarchy
  std::uint32_t stacked_ = 0;
  Sweep sweep_;                       ///< of the share of the motion, past the part
  std::array<Mat3, 2> turned_sizes_;  ///< of boxes, at its ends: the absolute values of the rotations
  PassingPoints passing_;
  double floor_ = 0;  ///< of straight ways: the clearance and what arcs may leave of them, m

  std::uint32_t block_ = 0, face_ = 0, faces_ = 0;  ///< of A, which is looked at
  std::uint32_t passed_ = 0, asked_ = 0;            ///< blocks of B beside it, and exact answers, until now
  double sizes_passed_ = 0;                         ///< its way as times of its size
  std::uint32_t skipped_ = 0;                       ///< a bit for each face of it that recedes
  MovedLanes moved_;
  Vec3 middle_ = Vec3::Zero();
  BlockWalk walk_;
  std::uint32_t blocks_asked_ = 0, blocks_told_ = 0;  ///< as a whole, lately, and what was enough
  std::array<Tops, kTopLevels> tops_;  ///< of the levels from the first on, of the nodes that were looked at last
  std::array<std::uint32_t, kBeside> found_;
  BesideFaces beside_;                                  ///< of found_, beside A's block
  std::array<float, 3> across_{};                       ///< a direction that kept two faces apart, in B's axes
  MovingPlane last_plane_{Vec3::Zero(), Vec3::Zero()};  ///< that kept two faces apart
};

}  // namespace tegotae
