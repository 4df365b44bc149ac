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
    const Vec3 normal = c.force * c.n;
    FrameForce& out = frame.forces[i];
    std::copy(c.point.data(), c.point.data() + 3, out.point);
    std::copy(normal.data(), normal.data() + 3, out.normal);
    std::copy(c.friction.data(), c.friction.data() + 3, out.friction);
    out.mu = c.mu;
    out.slides = c.slides ? 1 : 0;
  }
}

}  // namespace tegotae::view
