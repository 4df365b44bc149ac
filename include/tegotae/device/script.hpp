#pragma once

#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Motion of an operator's hand: over time, the pose where it wants the held part's file frame.
class StylusScript {
 public:
  /// A pose at a time.
  struct Key {
    double t;   ///< s
    Pose pose;  ///< X_WF of the held part's file frame, in the world
  };

  /// Normalizes the quaternions. Throws Error (kind setting) when `keys` is empty, a value is not finite, a position
  /// lies beyond 10 km, a quaternion is zero, the times do not increase, or the path from one key to the next is faster
  /// than 1e12 m/s. The message counts keys from 1.
  explicit StylusScript(std::vector<Key> keys);

  /// Returns the pose X_WF at `t` (s). Between two keys the position of the file frame moves linearly, and the rotation
  /// at a constant rate along the shorter arc (slerp). Before the first and after the last key the file frame rests
  /// there.
  Pose pose(double t) const noexcept;
  /// Returns the velocity of the file frame at `t` (s), in the world; `v` is that of its origin. At a key it is the
  /// velocity of the interval that begins there. Outside the keys it is zero.
  Twist velocity(double t) const noexcept;

  double begin() const noexcept { return keys_.front().t; }  ///< time of the first key, s
  double end() const noexcept { return keys_.back().t; }     ///< time of the last key, s

 private:
  std::vector<Key> keys_;
  std::vector<Twist> rates_;  // of the interval that begins at each key
  std::size_t interval(double t) const noexcept;
};

/// Reads a CSV file with the header row `t,px,py,pz,qw,qx,qy,qz` (s, m; columns in any order), one key in each row. It
/// skips empty lines and lines that begin with #. Throws Error (kind file) that names the file, the line and the
/// reason.
StylusScript read_script(const std::string& path);

/// Returns the poses of a path (X_WF of the held part's file frame) from a CSV file. The file is like that of
/// read_script(), but may have more columns, like those that `tegotae plan` and `tegotae review --csv` write. Throws
/// Error (kind file) that names the file, the line and the reason.
std::vector<Pose> read_path(const std::string& path);

}  // namespace tegotae
