#pragma once

#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae {

/// The motion about an axis that a thread or bore of the held part has in common with one of another part.
struct CommonAxis {
  Vec3 origin, direction;  ///< a point of it, m, and its unit vector; file frame of the held part, or world
  double rise = 0;         ///< m/rad; 0: a surface of revolution, which may also go along it
  bool with_held = false;  ///< which of both frames: the axis goes with the held part

  /// Where the part at `X` comes by a turn (rad), with the rise that goes with it.
  Pose turned(const Pose& X, double angle) const;
  /// Where it comes by a way along the axis (m).
  Pose shifted(const Pose& X, double way) const;
  /// How far a point (m, file frame) of the part at `X` is from it, m.
  double distance(const Pose& X, const Vec3& point) const;
};

/// Those of the held part at `X`, whose surfaces lie about one line there; those of most surface first. Looks for the
/// axes of the meshes where they are not known.
std::vector<CommonAxis> common_axes(const Scene& scene, const Pose& X);

}  // namespace tegotae
