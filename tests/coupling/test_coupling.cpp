#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/coupling/coupling.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("a pen past a wall feels a force out of it", "[coupling]") {
  // The part's center is held at the wall's surface x = 0, the pen is 2 mm inside and moves deeper at 0.1 m/s.
  ProxyState x;
  x.touching = true;
  const Pose Y{Quat::Identity(), Vec3(-0.002, 0, 0)};
  const Wrench w = coupling_wrench({800, 5, 0.3, 0.004}, x, Y, {Vec3(-0.1, 0, 0), Vec3::Zero()}, Vec3::Zero());
  CHECK(w.force.x() == Approx(800 * 0.002 + 5 * 0.1));
  CHECK(w.force.y() == 0);
  CHECK(w.force.z() == 0);
  CHECK(w.torque.norm() == 0);
}

TEST_CASE("nothing touches, nothing is felt", "[coupling]") {
  ProxyState x;
  x.X.p = Vec3(1, 2, 3);
  x.velocity.v = Vec3(1, 1, 1);
  const Wrench w = coupling_wrench({}, x, Pose(), {Vec3(5, 5, 5), Vec3(1, 1, 1)}, Vec3(0.1, 0, 0));
  CHECK(w.force.norm() == 0);
  CHECK(w.torque.norm() == 0);
}

TEST_CASE("the wrench is that of springs and dampers at the center of mass", "[coupling]") {
  std::mt19937 rng(1);
  const CouplingSettings s{700, 4, 0.25, 0.003};
  for (int i = 0; i < 200; ++i) {
    ProxyState x;
    x.touching = true;
    const Vec3 axis = random_vector(rng, 1).normalized();
    const double angle = std::uniform_real_distribution<double>(0, 3)(rng);
    Pose Y;
    Y.q = Quat(Eigen::AngleAxisd(random_vector(rng, 1).x(), random_vector(rng, 1).normalized()));
    Y.p = random_vector(rng, 1);
    x.X.q = Quat(Eigen::AngleAxisd(angle, axis)) * Y.q;
    x.X.p = random_vector(rng, 1);
    x.velocity = {random_vector(rng, 1), random_vector(rng, 1)};
    const Twist Y_velocity{random_vector(rng, 1), random_vector(rng, 1)};
    const Vec3 center = random_vector(rng, 0.2);

    const Vec3 center_x = x.X.q.toRotationMatrix() * center + x.X.p;
    const Vec3 center_y = Y.q.toRotationMatrix() * center + Y.p;
    const Vec3 force = 700 * (center_x - center_y) + 4 * (x.velocity.v - Y_velocity.v);
    const Vec3 torque = 0.25 * angle * axis + 0.003 * (x.velocity.w - Y_velocity.w);
    const Wrench w = coupling_wrench(s, x, Y, Y_velocity, center);
    REQUIRE((w.force - force).norm() < 1e-11);
    REQUIRE((w.torque - torque).norm() < 1e-13);
    // Turned about its own center by the coupling's torque, the pen comes closer to the part.
    x.velocity = {};
    const Wrench still = coupling_wrench(s, x, Y, {}, center);
    const Quat nearer = Quat(Eigen::AngleAxisd(1e-3, still.torque.normalized())) * Y.q;
    if (angle > 2e-3) REQUIRE(nearer.angularDistance(x.X.q) < Y.q.angularDistance(x.X.q));
  }
}
