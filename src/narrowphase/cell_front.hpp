#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "narrowphase/cell_anchor.hpp"
#include "narrowphase/cell_memory.hpp"
#include "narrowphase/cell_search.hpp"
#include "narrowphase/certify.hpp"
#include "narrowphase/face_pair.hpp"
#include "narrowphase/patch_tree.hpp"
#include "narrowphase/piece_counts.hpp"

namespace tegotae {

/// The path certificate of the held part A past all fixed parts, in the order of one free cell for a piece of A's
/// surface (mutable scratch; the trees are shared). A cut through A's hierarchy for each near part; every node of it
/// has a cell in which it may be, and the travel of A up to which nobody has to look at the cell again: what is known
/// free at a pose stays known, and a motion costs the pieces whose margin it uses up. No call but the constructor
/// allocates.
class CellFront {
 public:
  struct FixedPart {
    std::shared_ptr<const PatchTree> tree;
    Pose pose;
  };

  /// `center` (m, file frame) is A's center of mass. At most `capacity` cells, `blocking` triangle pairs a call.
  CellFront(std::shared_ptr<const PatchTree> a, const Vec3& center, std::vector<FixedPart> fixed,
            std::uint32_t capacity, std::uint32_t blocking);

  /// Forgets all: what follows is as with a new CellFront. set_near() comes next.
  void clear() noexcept;
  /// Puts the pieces of all parts together again, whatever that costs later: what was known near the fixed parts is
  /// kept for when A comes back. set_near() comes next.
  void forget_cut() noexcept;
  /// Fixed parts that certify() is about until the next call.
  void set_near(const std::vector<std::uint32_t>& near) noexcept;
  /// Separations below `clearance` (m) count as blocked from now on; 0 leaves just the rounding.
  void set_clearance(double clearance) noexcept { clearance_ = clearance; }

  /// Cells that the next calls have to look for are to hold for the motion `d` from where A is then as well, if they
  /// can: what goes on in this way needs no other. What is found in the way of it shortens it; see met().
  void foresee(const Displacement& d) noexcept;

  /// Is the motion s -> displaced(X, center, s·d), s in [0, 1], of A free of intersecting triangles, and likewise the
  /// one between the same two poses whose file-frame origin moves linearly? `X` is A's file frame in the world, `d` in
  /// the world. Never says certified wrongly, and CertifyReport::share is certified whatever the status; a motion of
  /// length zero asks whether the start is free.
  CertifyReport certify(const Pose& X, const Displacement& d, const WorkLimit& limit = {}) noexcept;

  /// The same for a motion that is not to be made now: what is proved of it need not be proved later.
  CertifyReport prove_ahead(const Pose& X, const Displacement& d, const WorkLimit& limit) noexcept;
  /// Of the motion that was foreseen, or proved ahead, in the last call: how much of it is left until something is in
  /// its way, at most; 1 when nothing was found.
  double met() const { return met_; }

  /// What stopped the last motion, when its status was `blocked`.
  const std::vector<FacePair>& blocking() const { return blocking_; }
  /// Calls f(part, a, a_is_face, b, b_is_face) for every cell: nodes of the trees, or faces.
  template <typename F>
  void for_each_cell(F f) const {
    for (const Slot& slot : slots_) {
      const Node& n = nodes_[slot.node];
      f(n.part, n.a, n.face_a, n.b, n.face_b);
    }
  }

  /// How far the surfaces of the held part and `part` face each other from one side: the length of the mean of the
  /// planes' normals, 1 on a flat seat, 0 in a hole. 0 where there are no cells.
  double one_sidedness(std::uint32_t part) const noexcept;
  /// Whether a displacement `dp` (world) leads away from what the planes of a sample of the cells stand for, most of
  /// it.
  bool leads_away(const Vec3& dp) const noexcept;
  /// So many cells that none should be spent on what may never come.
  bool crowded() const;
  int cells() const { return static_cast<int>(count()); }
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNobody = 0xffffffffu;
  /// Cells in a sample of all.
  static constexpr std::uint32_t kSample = 64;

  /// A pair of a piece of A and a subtree of a fixed part; those without children have a cell.
  struct Node {
    std::uint32_t a, b;  ///< nodes of the trees, or faces
    std::uint32_t part;
    std::uint32_t parent, child;  ///< of two at most, in a row
    std::uint32_t slot;           ///< of its cell, while it has no children
    std::uint8_t children;
    bool face_a, face_b;
    double retry;         ///< margin (m) below which its parts' cells are not put together again
    std::uint64_t split;  ///< the call that took it apart
    std::uint64_t due;    ///< the call whose motion uses up what its cell is known to last for
  };
  struct Slot {
    std::uint32_t node, part;
    FreeCell cell;
    CellCorridor corridor;  ///< of the cell's `clear`
  };
  struct Due {
    std::uint32_t node;
    double share;  ///< of the motion that its cell allows without a look at it
  };
  struct CellState {
    bool free;      ///< the cell holds for the whole motion
    bool far;       ///< its planes do
    double share;   ///< of the motion for which it holds
    double margin;  ///< of its planes at the start, m
  };
  enum class Outcome : std::uint8_t { free, blocked, out_of_work };

  void start_motion(const Pose& X, const Displacement& d);
  Sweep sweep_by(std::uint32_t part, const Displacement& d) const;
  const Sweep& sweep_of(std::uint32_t part);
  double allowed(std::uint32_t slot);
  void prefetch_allowed(std::uint32_t slot) const;
  void collect_due();
  void anchor(std::uint32_t id, const CellGaps& gaps);
  void settle_due();
  void tell_nearest();
  std::optional<double> typical_distance();
  void begin_anew_where_far();
  CellState state_of(std::uint32_t id);
  Outcome settle(std::uint32_t top);
  CellSearch::Outcome search(std::uint32_t id, bool cells_only);
  CellSearch::Outcome search(const Node& node, const Sweep& sweep, bool cells_only);
  void keep(std::uint32_t id);
  void need_parts_above(std::uint32_t id, double margin);
  void remember(const Node& node);
  bool recall(std::uint32_t id);
  bool split(std::uint32_t id);
  void enter(std::uint32_t id, std::uint32_t like);
  void enter(std::uint32_t id);
  void enter_root(std::uint32_t part);
  void leave(std::uint32_t slot);
  std::uint32_t count() const { return static_cast<std::uint32_t>(slots_.size()); }
  std::uint32_t allocate();
  void release(std::uint32_t child);
  void raise();
  bool may_raise(std::uint32_t id) const;
  bool try_raise(std::uint32_t id);
  bool grow(std::uint32_t id, double margin);
  bool renew(std::uint32_t id, double margin);
  void needs_parts(std::uint32_t id, double margin);
  bool merge(std::uint32_t id, double lasts);
  bool out_of_work(bool read_clock);
  MovingHull hull(const Node& node, const Sweep& sweep) const;
  double radius(const Node& node) const;
  double wanted(const MovingHull& a, const Sweep& sweep) const;
  CellCorridor corridor(const Node& node, const MovingHull& a, const Sweep& sweep) const;
  double moved(std::uint32_t slot, const Sweep& sweep) const;
  bool holds(const Node& node, const FreeCell& cell, const CellCorridor& corridor, const Sweep& sweep) const;
  bool foresees() const;
  void shorten_foresight(const Node& node);
  double free_until(std::uint32_t part, std::uint32_t face_a, std::uint32_t face_b, const Displacement& d) const;
  const Sweep& foreseen(std::uint32_t part);
  Vec3 middle(const Node& node) const;

  std::shared_ptr<const PatchTree> a_;
  Vec3 center_, offset_a_;
  double reach_;        ///< of A about its center of mass, m
  PieceCounts pieces_;  ///< of `a_`
  std::vector<FixedPart> fixed_;
  std::vector<std::shared_ptr<const PatchBatches>> batches_;  ///< of each part
  std::uint32_t capacity_;
  double clearance_ = 0;

  std::vector<Node> nodes_;
  std::uint32_t free_nodes_ = kNobody;
  std::vector<Slot> slots_;
  std::vector<CellItems> items_;      ///< of each slot
  std::vector<CellCorridor> listed_;  ///< of each slot: that of items_
  std::vector<CellAnchor> anchors_;   ///< of each slot
  std::vector<double> expiry_;        ///< of each slot: travel up to which its cell needs no look
  std::vector<double> clear_until_;   ///< of each slot: the same of what no plane stands for alone
  std::vector<std::uint32_t> root_;   ///< of each part, kNobody while it has none
  std::vector<std::uint64_t> asked_;  ///< of each part: the set_near() that last named it
  CellMemory memory_;
  std::uint64_t now_ = 1;

  Pose X_;
  bool started_ = false;
  Displacement d_;
  double travel_ = 0;           ///< bound on how far any point of A has come since the front began, m
  double turned_ = 0;           ///< the same of its turns, rad
  double need_ = 0;             ///< bound on how far the motion carries any point, and the clearance, m
  double motion_ = 0;           ///< longest motion of late, m
  Displacement foresight_;      ///< the motion that cells are looked for, if it is longer than that of the call
  double foreseen_length_ = 0;  ///< how far it carries any point, m
  double carried_ = 0;          ///< how far the motion of the call carries any point at most, m
  double nearest_ = std::numeric_limits<double>::infinity();  ///< typical_distance(), the least since the cut began, m
  std::uint64_t begun_ = 0;                                   ///< the call in which it began
  double met_ = 1, kept_ = 1;                                 ///< see met(); what shortening has left of the foresight
  std::vector<Sweep> sweeps_;                                 ///< of each part, valid when stamped with the call
  std::vector<std::uint64_t> stamped_;
  std::vector<Sweep> foreseen_;  ///< of each part: foresight_, valid when stamped
  std::vector<std::uint64_t> foreseen_stamped_;
  std::uint64_t foresights_ = 0;  ///< counts what they are stamped with
  std::uint64_t call_ = 0;

  CellSearch search_;
  FreeCell found_;
  CellCorridor found_corridor_;
  std::array<Vec3, 3> face_;  ///< scratch: corners of the face that hull() made
  std::vector<Due> unsorted_, due_;
  std::vector<std::uint32_t> stack_, freed_;
  std::vector<FacePair> blocking_;
  std::uint32_t cursor_ = 0;
  std::int64_t visits_at_start_ = 0;
  WorkLimit limit_;
  CertifyReport report_;
  bool ahead_ = false;   ///< the call is about a clearance at rest
  bool settled_ = true;  ///< nothing yet kept the call from looking at all that the motion needs
};

}  // namespace tegotae
