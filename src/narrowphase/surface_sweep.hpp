#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "narrowphase/sweep_helpers.hpp"
#include "narrowphase/sweep_model.hpp"
#include "narrowphase/sweep_task.hpp"
#include "narrowphase/sweep_worker.hpp"

namespace tegotae {

/// What is wanted of a look at a motion.
struct SweepAim {
  double clearance;  ///< separations below do not count, m
  /// Whole blocks of faces, a tenth of the work, may end the motion a seventh before faces would, and where they tell
  /// little more, wherever so much of it (m) or more is free. Not where so much is more than the whole.
  double worth = std::numeric_limits<double>::infinity();
  /// What a few faces tell to be in the way ends the motion so far (m) before it is touched: nearer, the planes of
  /// faces that lie on each other keep few of their neighbors apart.
  double kept = 12e-6;
  /// So far (m), for what is farther than `far` (m) at the start: there, whole blocks of faces tell as much as all
  /// faces.
  double kept_far = 0, far = std::numeric_limits<double>::infinity();
  /// Where a few faces meet something within so much (m), they are told and nothing else is looked at: no share is free
  /// then.
  double blocked_within = 0;
  /// What a few faces meet within so much (m) is told before all are looked at; see met_near().
  double near_within = 0;
  /// A side to which A may be drawn out at the start with no point of a part's pieces inside (see Backing). It is not,
  /// where something meets what was drawn.
  std::optional<Backing::Side> drawn = std::nullopt;
};

/// The path certificate of one motion of A by a look at all of its faces, with nothing kept for the next one: where
/// surfaces lie on each other and A moves far, a tenth of what new cells for all faces take, however far it goes. It
/// takes many ticks for a large part and goes on where it was. Threads that help do their share in between as well.
/// Mutable scratch; no call but the constructor allocates.
class SurfaceSweep {
 public:
  /// `center` (m, file frame) is A's center of mass; `facing` of A, if it bounds a solid, and `backing` if it has one.
  /// At most `blocking` triangle pairs are told. So many `helpers` are started; throws Error where they cannot be.
  SurfaceSweep(std::shared_ptr<const PatchTree> a, const Vec3& center, const std::vector<CellFront::FixedPart>& fixed,
               std::shared_ptr<const Facing> facing, std::shared_ptr<const Backing> backing, std::uint32_t blocking,
               int helpers = 0);
  ~SurfaceSweep() { drop_task(); }
  SurfaceSweep(const SurfaceSweep&) = delete;
  SurfaceSweep& operator=(const SurfaceSweep&) = delete;

  /// Begins with the motion s -> displaced(X, center, s·d), s in [0, 1], past the parts in `near`, and likewise the one
  /// between the same two poses whose file-frame origin moves linearly (see Sweep). `outside` tells of which of them
  /// nothing is inside A: then A's faces that recede are not looked at, and the answer is about an A that is apart from
  /// them at `X`. So it is where A may be drawn out.
  void begin(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& near,
             const std::vector<bool>& outside, const SweepAim& aim) noexcept;
  /// Goes on until `deadline_ns` of monotonic_ns(), about; whether it is done.
  bool go_on(std::int64_t deadline_ns) noexcept;
  /// Whether begin() may name the part.
  bool knows(std::uint32_t part) const { return model_->parts[part].surface != nullptr; }
  /// Of what comes last about A itself, past the last part, how much is done, as a share; 0 before that.
  double progress() const;
  /// Begun and not done.
  bool under_way() const { return under_way_; }

  const Pose& start() const { return question_.X; }
  const Displacement& motion() const { return question_.d; }
  const std::vector<std::uint32_t>& near() const { return near_; }
  /// When done: the part of the motion, from its start, that is free. What is met ends it, a little before it is
  /// touched where that can be.
  double share() const { return end_.share; }
  /// When done: what was met, the nearest first; at most as many as the constructor was told. Nothing where the motion
  /// was ended early.
  const std::vector<FacePair>& blocking() const { return blocking_; }
  /// When done: a few faces met something at once (see SweepAim::blocked_within).
  bool met_at_once() const { return met_at_once_; }
  /// Before it is done: a few faces met something near (see SweepAim::near_within). It is in blocking().
  bool met_near() const { return met_near_; }
  /// When done: whole blocks ended the motion, or looking farther would have taken too long, and more of it may be
  /// free.
  bool ended_early() const { return end_.early; }

 private:
  using Look = SweepTask::Look;
  using Layer = SweepTask::Layer;

  void start_looks();
  void start_look(Look look);
  void start_layer(Layer layer);
  void start_part();
  void finish_part();
  void next_part();
  void drop_task();
  void collect_met();

  std::shared_ptr<const SweepModel> model_;
  std::vector<FacePair> blocking_;

  bool under_way_ = false, met_at_once_ = false, met_near_ = false;
  SweepTask::Question question_;                 ///< of the step that is done
  double blocked_within_ = 0, near_within_ = 0;  ///< as shares of the motion
  std::vector<std::uint32_t> near_;
  std::vector<bool> outside_;  ///< of each of them: faces that recede from it are not looked at
  std::uint32_t at_ = 0;       ///< of near_
  // Until now, as those of the task.
  SharedLimit::Value end_{1, false}, faces_end_{1, false};
  std::uint32_t searched_ = 0;

  SweepWorker worker_;
  std::vector<std::unique_ptr<SweepTask>> tasks_;  ///< a helper that is late may be inside one that is over
  SweepTask* task_ = nullptr;                      ///< of the part; none: it has not begun
  std::unique_ptr<SweepHelpers> helpers_;          ///< the last, so that they are gone before what they read
};

}  // namespace tegotae
