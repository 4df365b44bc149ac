#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "loop/collision_world.hpp"
#include "loop/running_scene.hpp"

namespace tegotae {

/// Counters of a MotionWorld since it was made.
struct MotionCounts {
  std::int64_t checked = 0;   ///< motions that the path certificate was asked about
  std::int64_t complied = 0;  ///< motions that the contact loop was led through
};

/// The held part of a scene among the others, as a planner asks about it: which motions are free (the path
/// certificate), and where the part comes when its pen is led somewhere (the contact loop). Motions have a linear
/// center of mass and a constant rate of turning. One thread at a time.
///
/// Where nothing touches at the start it first has what motions clear of contact need alone: its certificate knows no
/// axes, and there is no contact loop. complete() makes the rest, which takes longer.
class MotionWorld {
 public:
  /// `clearance` (m) is the least that a motion leaves between the parts, at least kGapFloor. Throws Error as
  /// HapticLoop's constructor.
  MotionWorld(Scene scene, double clearance);

  /// Makes what is not made yet.
  void complete();
  bool is_complete() const { return loop_ != nullptr; }

  const Scene& scene() const { return scene_; }
  const Pose& start() const { return at_->X; }  ///< where the held part starts, off what it touches there
  const InitialContactReport& start_report() const { return at_->start.report(); }
  const Vec3& center() const { return mass_.center; }  ///< of mass of the held part, m, file frame
  double radius() const { return at_->radius; }        ///< of the held part about its center, m
  double gyration() const { return gyration_; }        ///< radius of gyration of the held part, m
  double clearance() const { return clearance_; }      ///< m
  const MotionCounts& counts() const { return counts_; }

  /// Bound on how far a displacement carries any point of the held part, m.
  double size(const Displacement& d) const { return d.dp.norm() + at_->radius * d.dr.norm(); }
  double size(const Pose& from, const Pose& to) const { return size(displacement(from, to, center())); }

  /// Part of the motion between two poses, from its start, that is proved to leave `clearance` (m); 1: all of it. A
  /// motion of no length asks about the pose. Where the proof ends it is taken up again so many times: what is free may
  /// need more than one, for the work of one is bounded.
  double free_share(const Pose& from, const Pose& to, double clearance, int again = 0);
  double free_share(const Pose& from, const Pose& to) { return free_share(from, to, clearance_); }
  bool is_free(const Pose& from, const Pose& to) { return free_share(from, to) == 1; }
  /// The part in the way of the last motion that was not free; index into Scene::parts.
  std::optional<std::size_t> blocker() const { return blocker_; }
  /// The pose at `share` of the motion between two poses.
  Pose along(const Pose& from, const Pose& to, double share) const {
    return share == 1 ? to : displaced(from, center(), share * displacement(from, to, center()));
  }

  /// Puts the part at `from`, which is free, and leads its pen to `target` until the part has gone `longest` (m), is
  /// there or no longer moves. Sets `pieces` to the poses that it went through, without `from`; every motion between
  /// two of them leaves clearance(). Completes the world.
  void comply(const Pose& from, const Pose& target, double longest, std::vector<Pose>& pieces);

 private:
  MotionWorld(Scene scene, double clearance, bool prepared);
  /// The same for one step that is not too long for one proof.
  double step_share(const Pose& X, const Displacement& step, double clearance);

  Scene scene_;
  double clearance_;
  ContactSettings settings_;
  MassProperties mass_;  ///< of the held part
  std::unique_ptr<CollisionWorld> at_;
  std::unique_ptr<RunningScene> loop_;  ///< null: not complete
  double gyration_;
  std::vector<std::size_t> fixed_;  ///< of each fixed part, index into Scene::parts
  std::vector<std::uint32_t> near_;
  std::vector<FacePair> blocking_;
  TickReport report_;
  std::optional<std::size_t> blocker_;
  bool blocked_ = false;  ///< the last motion that was not free, by something in its way
  MotionCounts counts_;
};

}  // namespace tegotae
