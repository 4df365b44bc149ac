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

void store(const ContactForces& forces, Frame& frame) {
  frame.force_count = static_cast<std::uint64_t>(forces.count);
  for (std::size_t i = 0; i < frame.force_count; ++i) {
    const ContactForce& c = forces.items[i];
    const Vec3 force = c.force * c.n;
    std::copy(c.point.data(), c.point.data() + 3, frame.forces[i].point);
    std::copy(force.data(), force.data() + 3, frame.forces[i].force);
  }
}

}  // namespace tegotae::view
