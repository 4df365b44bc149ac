// FCL asked directly, with all poses in the world: whether the held part of a scene intersects a fixed one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::test {

class FclOracle {
 public:
  explicit FclOracle(const Scene& scene);
  ~FclOracle();
  /// Names of the fixed parts that the held part intersects at the pose `X_WF`.
  std::vector<std::string> intersecting(const Pose& X_WF) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae::test
