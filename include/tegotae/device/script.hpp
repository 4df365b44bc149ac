#pragma once

#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Where the operator's hand wants the held part's file frame to be, over time.
class StylusScript {
 public:
  /// A pose at a time.
  struct Key {
    double t;   ///< s
    Pose pose;  ///< X_WF of the held part's file frame, in the world
  };

  /// Throws Error when `keys` is empty, a value is not finite, a quaternion is zero, the times do not increase, or the
  /// path from one key to the next is faster than 1e12 m/s (the message counts keys from 1). Normalizes the
  /// quaternions.
  explicit StylusScript(std::vector<Key> keys);

  /// Returns the pose at `t` (s). Between two keys the position of the file frame moves linearly, and the rotation at a
  /// constant rate along the shorter arc (slerp). Before the first and after the last key the file frame rests there.
  Pose pose(double t) const noexcept;
  /// Returns the velocity of the file frame at `t` (`v` is that of its origin). At a key it is the velocity of the
  /// interval that begins there. Outside the keys it is zero.
  Twist velocity(double t) const noexcept;

  double begin() const noexcept { return keys_.front().t; }  ///< s
  double end() const noexcept { return keys_.back().t; }     ///< s

 private:
  std::vector<Key> keys_;
  std::vector<Twist> rates_;  // of the interval that begins at each key
  std::size_t interval(double t) const noexcept;
};

/// Reads a CSV file with the header row `t,px,py,pz,qw,qx,qy,qz` (s, m; columns in any order), one key a row. Empty
/// lines and lines that begin with # are skipped. Throws Error naming the file, the line and the reason.
StylusScript read_script(const std::string& path);

/// Reads the poses of a path (X_WF of the held part's file frame): a CSV file as read_script() reads, in which other
/// columns may stand beside those of a script, as in what `tegotae plan` and `tegotae review --csv` write. Throws Error
/// naming the file, the line and the reason.
std::vector<Pose> read_path(const std::string& path);

}  // namespace tegotae
