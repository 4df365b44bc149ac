#pragma once

#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::review {

/// Where the held part is out of all others: beside the box around them, as `tegotae try --goal out` has it (Exit). A
/// scene without another part has it out everywhere.
struct ExitFindings {
  bool at_first = false;  ///< where the recording begins
  bool at_goal = false;   ///< of the goal
  bool at_end = false;    ///< where the verdict is judged
  /// Where it is not out there: the parts that it is not beside and is near to (within the margin of Exit), or the
  /// nearest one of those that it is not beside; index into Scene::parts, in their order.
  std::vector<std::size_t> inside;
};

/// The poses are of the held part, X_WF; `center` of mass of it, m, file frame.
ExitFindings find_exit(const Scene& scene, const Vec3& center, const Pose& first, const Pose& goal, const Pose& end);

}  // namespace tegotae::review
