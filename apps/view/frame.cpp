#include "view/frame.hpp"

#include <algorithm>

namespace tegotae::view {

void store(const Pose& pose, double (&out)[7]) {
  const double values[7] = {pose.p.x(), pose.p.y(), pose.p.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()};
  std::copy(values, values + 7, out);
}

void store(const Wrench& wrench, double (&out)[6]) {
  std::copy(wrench.force.data(), wrench.force.data() + 3, out);
  std::copy(wrench.torque.data(), wrench.torque.data() + 3, out + 3);
}

}  // namespace tegotae::view
