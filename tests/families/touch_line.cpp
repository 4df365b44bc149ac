#include "families/touch_line.hpp"

#include <algorithm>

#include "tegotae/core/error.hpp"

namespace tegotae::test {
namespace {

// Each step is the distance left, so a line that grazes a wall takes many.
constexpr int kMostSteps = 10000;

}  // namespace

double travel(const FclOracle& oracle, const Pose& from, const Vec3& direction, double most, double near) {
  double s = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    const double left = oracle.distance({from.q, from.p + s * direction});
    if (left <= near) return s;
    s += left;
    if (s >= most) return most;
  }
  throw Error("a line along a wall: FCL's distance takes too many steps on it");
}

double travel_bisected(const FclOracle& oracle, const Pose& from, const Vec3& direction, double most, double near) {
  const auto hits = [&](double s) { return !oracle.intersecting({from.q, from.p + s * direction}).empty(); };
  if (!hits(most)) return most;
  double free = 0, blocked = most;
  while (blocked - free > near) {
    const double middle = (free + blocked) / 2;
    (hits(middle) ? blocked : free) = middle;
  }
  return free;
}

}  // namespace tegotae::test
