// Where a part first touches others on a straight line, asked of FCL's distance: nothing of the loop takes part.
#pragma once

#include <limits>
#include <memory>

#include "tegotae/loop/scene.hpp"

namespace tegotae::test {

class TouchLine {
 public:
  explicit TouchLine(const Scene& scene);
  ~TouchLine();

  /// Distance (m) of the held part at `X` from the nearest fixed one, 0 when they intersect; parts farther off than
  /// `reach` (m) may be left out, and `reach` is returned then.
  double distance(const Pose& X, double reach = std::numeric_limits<double>::infinity()) const;

  /// How far (m) the held part may go from `from` along the unit vector `direction` until it is within `near` (m) of a
  /// fixed part, at most `most`: steps of the distance that is left can miss nothing, so open surfaces stop it too. Its
  /// end is bisected, since where large surfaces mate a distance takes a second and a step closes in by a share only;
  /// what is thin enough to be missed there would let it go too far, never stop it.
  double travel(const Pose& from, const Vec3& direction, double most, double near) const;

  /// The same for solids that are guided closely: by bisection between `from`, which is free, and `most` (m) further
  /// on, where the parts intersect if they do anywhere; to `near` (m).
  double travel_bisected(const Pose& from, const Vec3& direction, double most, double near) const;

  /// Whether the held part at `X` intersects a fixed one.
  bool intersects(const Pose& X) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae::test
