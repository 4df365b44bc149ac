#pragma once

#include <string>

#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/record/recording.hpp"

namespace tegotae::view {

/// Leads a contact loop along recorded poses, and a little on towards where the pen was, so that what is in the way
/// shows: contacts are not in a recording.
class Follower {
 public:
  /// Begins where `scene` holds the part, or at `first`, the recording's first pose, when that is elsewhere. `path` of
  /// the recording is for the message. Throws Error when the part would stand in another one there.
  Follower(Scene scene, const std::string& path, const Pose& first);

  const HapticLoop& loop() const { return loop_; }
  void step(const RecordFrame& row);
  /// Something that was not there held the part back from the last row's pose.
  bool astray() const { return astray_; }
  std::size_t strayed() const { return strayed_; }  ///< how many rows

 private:
  HapticLoop loop_;
  double radius_;  // of the held part about its center of mass, m
  bool astray_ = false;
  std::size_t strayed_ = 0;
};

}  // namespace tegotae::view
