#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "narrowphase/face_pair.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// What stands between the held part A and a wanted motion.
enum class MotionAnswer : std::uint8_t {
  free,     ///< nothing: the motion may be made
  blocked,  ///< the triangle pairs listed
  unknown   ///< work or time ran out before anything was found
};

/// What is known of the fixed parts that a list of near ones does not name.
enum class OtherParts : std::uint8_t {
  far,     ///< they are out of reach, but for those that the check was told may be left out
  ignored  ///< they do not matter, wherever they are
};

/// What a tick knows of where A goes.
struct Heading {
  Displacement pen;            ///< the pen's way in a tick, about
  bool touches = false;        ///< something is no farther from A than the next
  double contact_gap = 20e-6;  ///< m
  /// What is in A's way and no farther explains that it does not follow the pen, m.
  double near_gap = 20e-6;
  /// What is asked about is to be made whole or not at all. What was begun of other motions goes.
  bool whole = false;
};

/// Narrow phase of the contact loop: whether a motion of A keeps clear of the fixed parts. A motion runs from `X` (A's
/// file frame in the world) by `d` of its center of mass; both in the world.
class MotionCheck {
 public:
  virtual ~MotionCheck() = default;

  /// Fixed parts that matter until the next call; `deadline_ns` of monotonic_ns() bounds the work of the checks.
  virtual void begin(const std::vector<std::uint32_t>& near, std::int64_t deadline_ns, OtherParts others) noexcept = 0;
  /// Until the next begin(), checks of motions start where A meets no near part that may not be left out: at the start
  /// of the scene, or where motions that were checked have brought it since, without a gap since the last jumped().
  virtual void trust_start() noexcept {}
  /// A is where no motion that was checked has brought it.
  virtual void jumped() noexcept {}
  /// Until the next begin().
  virtual void heads(const Heading& heading) noexcept { static_cast<void>(heading); }
  /// Whether A can make the motion and come no nearer than `clearance` (m). Fills `blocking` (never past its capacity).
  virtual MotionAnswer check(const Pose& X, const Displacement& d, double clearance,
                             std::vector<FacePair>& blocking) noexcept = 0;
  /// Gets ready for what comes next, in time that a tick has left, until `deadline_ns`: whatever is proved ahead for
  /// the parts of the last begin() need not be proved by the next checks. A is at `X`, and `next` is about how it will
  /// move in the next tick.
  virtual void prepare(const Pose& X, const Displacement& next, std::int64_t deadline_ns) noexcept {
    static_cast<void>(X), static_cast<void>(next), static_cast<void>(deadline_ns);
  }
  /// The motion that the last check() answered for instead of the one that it was asked for: an earlier one from the
  /// same pose, which took it more than a tick. What stops it is to be looked for at its end.
  virtual std::optional<Displacement> instead() const { return std::nullopt; }
  /// The next check() takes as long however far the motion goes.
  virtual bool prefers_long() const { return false; }
  /// The last check() begins to answer, and one of the next, from the same pose, has the answer.
  virtual bool goes_on() const { return false; }
  /// How much of that answer is there, as a share, about.
  virtual double progress() const { return 0; }
  /// Part of the motion that the last check() answered for, from its start, that may be made whatever the answer; in
  /// [0, 1].
  virtual double free_share() const = 0;
  /// Whether A at `X` comes no nearer than `clearance` (m) to fixed part `part`, whether that matters or not; unknown
  /// after `deadline_ns`. To be called before begin(), which the next check() needs anew.
  virtual MotionAnswer stands(const Pose& X, std::uint32_t part, double clearance,
                              std::int64_t deadline_ns) noexcept = 0;
  /// A pose close to where the blocking pairs of the last check meet, at which their nearest features are looked for.
  virtual Pose near_contact(const Pose& X, const Displacement& d, const std::vector<FacePair>& blocking) noexcept = 0;
  /// Longest motion of any point of A that one check should cover, m.
  virtual double longest_motion() const = 0;
  /// Fixed parts that were near in the last begin() but could not be taken in: motions are unknown as long.
  virtual bool overflow() const = 0;
};

}  // namespace tegotae
