#include <cmath>
#include <limits>

#include "catch.hpp"
#include "device/rate_control.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;

namespace {

Deflection along(const Vec3& v) {
  return {v, Vec3::Zero()};
}

}  // namespace

TEST_CASE("a deflection moves the pen at a speed, beyond a round dead zone", "[rate]") {
  RateControl control({});
  const Displacement near{};
  control.step(along(Vec3(0.06, -0.06, 0)), 0.01, near);  // 0.085 of 0.1
  CHECK(control.pose().p.norm() == 0);
  control.step(along(Vec3(0, 0, -1)), 0.01, near);
  CHECK((control.pose().p - Vec3(0, 0, -5e-4)).norm() < 1e-15);
  CHECK((control.velocity().v - Vec3(0, 0, -0.05)).norm() < 1e-15);
  control.step(along(Vec3(0.55, 0, 0)), 0.01, near);  // half of what is beyond: a quarter of the speed
  CHECK(control.velocity().v.x() == Approx(0.0125));
  control.step(along(Vec3(3, 4, 0)), 0.01, near);  // never faster than the full speed
  CHECK((control.velocity().v - Vec3(0.03, 0.04, 0)).norm() < 1e-12);
  control.rest();
  CHECK(control.velocity().v.norm() == 0);
}

TEST_CASE("a deflection turns the pen about the world's axes", "[rate]") {
  RateControl control({});
  for (int i = 0; i < 1000; ++i) control.step({Vec3::Zero(), Vec3(0, 0, 1)}, 1e-3, {});
  CHECK((rotation_vector(control.pose().q) - Vec3(0, 0, 0.8)).norm() < 1e-9);
  const Quat before = control.pose().q;
  control.step({Vec3::Zero(), Vec3(1, 0, 0)}, 1e-3, {});
  CHECK((rotation_vector(control.pose().q * before.conjugate()) - Vec3(8e-4, 0, 0)).norm() < 1e-12);
  CHECK(control.pose().p.norm() == 0);
}

TEST_CASE("the pen waits where it is a reach ahead of the part", "[rate]") {
  RateControl control({});
  // A part that stays where it is.
  const auto lead = [&] { return Displacement{control.pose().p, rotation_vector(control.pose().q)}; };
  for (int i = 0; i < 1000; ++i) control.step({Vec3(1, 0, 0), Vec3(0, 1, 0)}, 1e-3, lead());
  CHECK(control.pose().p.norm() == Approx(0.01));
  CHECK(rotation_vector(control.pose().q).norm() == Approx(0.2));
  CHECK(control.velocity().v.norm() < 1e-9);
  // It slides along its bound, and comes back at once.
  control.step(along(Vec3(0, 1, 0)), 1e-3, lead());
  CHECK(control.pose().p.norm() <= 0.01 * (1 + 1e-12));
  CHECK(control.pose().p.y() > 4e-5);
  const double x = control.pose().p.x();
  control.step(along(Vec3(-1, 0, 0)), 1e-3, lead());
  CHECK(control.pose().p.x() == Approx(x - 5e-5));
}

TEST_CASE("garbage moves nothing", "[rate]") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  RateControl control({});
  control.step(along(Vec3(nan, 0, 0)), 1e-3, {});
  control.step(along(Vec3(1, 0, 0)), nan, {});
  control.step(along(Vec3(1, 0, 0)), -1, {});
  control.step(along(Vec3(1, 0, 0)), 1e-3, {Vec3(0, nan, 0), Vec3::Zero()});
  control.step(along(Vec3(1, 0, 0)), 1e-3, {Vec3::Zero(), Vec3(0, inf, 0)});
  control.step(along(Vec3(inf, 0, 0)), 1e-3, {});
  CHECK(control.pose().p == Vec3::Zero());
  CHECK(control.pose().q.coeffs() == Quat::Identity().coeffs());
}

TEST_CASE("rate control settings out of range are refused", "[rate]") {
  RateControlSettings s;
  s.speed = -1;
  CHECK_THROWS_WITH(RateControl(s), Catch::Contains("speed"));
  s = {};
  s.dead_zone = 1;
  CHECK_THROWS_WITH(RateControl(s), Catch::Contains("dead_zone"));
  s = {};
  s.reach = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(RateControl(s), Catch::Contains("reach"));
}
