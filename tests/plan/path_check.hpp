// Whether a path is free, asked of FCL every 20 µm of what any point of the held part goes.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "fcl_oracle.hpp"
#include "loop/path_oracle.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae::test {

inline constexpr double kOracleStep = 20e-6;  // m

struct PathCheck {
  std::size_t asked = 0, intersecting = 0;
};

/// `center` (file frame, m) goes straight between two poses; no point of the part is farther than `reach` from it.
inline PathCheck check_path(const FclOracle& oracle, const std::vector<Pose>& path, const Vec3& center, double reach) {
  PathCheck out;
  const auto ask = [&](const Pose& X) {
    ++out.asked;
    out.intersecting += oracle.intersecting(X).empty() ? 0 : 1;
  };
  ask(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double way = travel(path[i - 1], path[i], center, reach);
    const int parts = std::max(1, static_cast<int>(std::ceil(way / kOracleStep)));
    for (int k = 1; k <= parts; ++k)
      ask(pose_between(path[i - 1], path[i], center, static_cast<double>(k) / parts, PathKind::center));
  }
  return out;
}

/// What the path turns in sum, rad.
inline double turn_of(const std::vector<Pose>& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += path[i - 1].q.angularDistance(path[i].q);
  return sum;
}

/// What `center` goes, m.
inline double way_of(const std::vector<Pose>& path, const Vec3& center) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] * center - path[i - 1] * center).norm();
  return sum;
}

}  // namespace tegotae::test
