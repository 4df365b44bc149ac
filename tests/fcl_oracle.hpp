// FCL asked directly, with all poses in the world: whether the held part of a scene intersects a fixed one, and how far
// it is from them.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tegotae/sim/scene.hpp"

namespace tegotae::test {

class FclOracle {
 public:
  explicit FclOracle(const Scene& scene);
  ~FclOracle();
  /// Names of the fixed parts that the held part intersects at the pose `X_WF`.
  std::vector<std::string> intersecting(const Pose& X_WF) const;
  /// Distance (m) of the held part at `X_WF` from the nearest fixed one, 0 when they intersect. Parts farther off than
  /// `reach` (m) are left out; `reach` is returned when all are.
  double distance(const Pose& X_WF, double reach = std::numeric_limits<double>::infinity()) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae::test
