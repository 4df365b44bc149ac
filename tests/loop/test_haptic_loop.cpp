#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// A 40 mm cube over a floor whose top is at z = 0.
Scene cube_on_floor(const std::string& resolver, double height) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"floor", shared(box({0.4, 0.4, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"cube", shared(box({0.04, 0.04, 0.04})), {Quat::Identity(), {0, 0, 0.02 + height}}, true});
  return scene;
}

}  // namespace

TEST_CASE("in open space X is Y", "[sim]") {
  HapticLoop loop(cube_on_floor("lp", 0.1));
  std::mt19937 rng(1);
  Pose Y{Quat::Identity(), {0, 0, 0.12}};
  for (int i = 0; i < 100; ++i) {
    Y = displaced(Y, Vec3::Zero(), {random_vector(rng, 2e-4), random_vector(rng, 5e-3)});
    const TickReport& r = loop.step(Y, 0.001);
    REQUIRE((r.proxy.X.p - Y.p).norm() < 1e-15);
    REQUIRE_FALSE(r.proxy.touching);
    REQUIRE(r.contacts == 0);
  }
}

TEST_CASE("a cube pushed into the floor stays on it and slides with the pen", "[sim]") {
  const std::string resolver = GENERATE("lp", "qp");
  CAPTURE(resolver);
  const Scene scene = cube_on_floor(resolver, 0.001);
  HapticLoop loop(scene);
  FclOracle oracle(scene);
  const double l_min = *loop.contact().l_min;
  // Down to 5 mm under the floor at 0.1 m/s, then 30 mm sideways at 0.1 m/s.
  for (int tick = 0; tick < 700; ++tick) {
    const double down = 1e-4 * std::min(tick, 60), side = tick > 400 ? 1e-4 * (tick - 400) : 0;
    const Pose Y{Quat::Identity(), {side, 0, 0.021 - down}};
    const TickReport& r = loop.step(Y, 0.001);
    for (const Pose& piece : r.substeps) REQUIRE(oracle.intersecting(piece).empty());
    if (tick > 60) {
      REQUIRE(r.proxy.touching);
      // The lowest face hovers over the floor by no more than the contact gap.
      REQUIRE(r.proxy.X.p.z() - 0.02 >= 0);
      REQUIRE(r.proxy.X.p.z() - 0.02 <= l_min);
      REQUIRE(r.proxy.X.p.x() == Approx(side).margin(1e-6));
      REQUIRE(rotation_vector(r.proxy.X.q).norm() < 1e-4);
    }
  }
}

TEST_CASE("a tilted cube pushed down is laid flat against a pen that stays tilted", "[sim]") {
  const std::string resolver = GENERATE("lp", "qp");
  CAPTURE(resolver);
  const Scene scene = cube_on_floor(resolver, 0.01);
  HapticLoop loop(scene);
  FclOracle oracle(scene);
  // With the pen 10 mm lower than the flat cube and tilted by 0.1 rad, translation errors outweigh the tilt.
  Pose Y{rotation({0, 0.1, 0}), {0, 0, 0.03}};
  for (int tick = 0; tick < 1500; ++tick) {
    if (tick > 100 && tick < 350) Y.p.z() -= 1e-4;
    const TickReport& r = loop.step(Y, 0.001);
    for (const Pose& piece : r.substeps) REQUIRE(oracle.intersecting(piece).empty());
  }
  const ProxyState& x = loop.report().proxy;
  REQUIRE(rotation_vector(x.X.q).norm() < 1e-3);
  // The pen's own tilt is turned back: torque about y against the tilt, force upwards.
  const Wrench f = coupling_wrench(scene.coupling, x, Y, Twist{}, loop.center());
  REQUIRE(f.force.z() == Approx(scene.coupling.stiffness * (x.X.p.z() - Y.p.z())).epsilon(1e-6));
  REQUIRE(f.torque.y() < -0.9 * scene.coupling.torsional_stiffness * 0.1);
}

TEST_CASE("the part leaves a contact when the pen does", "[sim]") {
  HapticLoop loop(cube_on_floor("lp", 0.0005));
  for (int tick = 0; tick < 50; ++tick) loop.step({Quat::Identity(), {0, 0, 0.0205 - 1e-4 * tick}}, 0.001);
  REQUIRE(loop.report().proxy.touching);
  for (int tick = 0; tick < 200; ++tick) loop.step({Quat::Identity(), {0, 0, 0.0155 + 1e-4 * tick}}, 0.001);
  REQUIRE_FALSE(loop.report().proxy.touching);
  REQUIRE(loop.report().proxy.X.p.z() == Approx(0.0155 + 1e-4 * 199).margin(1e-12));
}

TEST_CASE("scenes that cannot be held are refused with the reason", "[sim]") {
  const auto message = [](const Scene& scene) -> std::string {
    try {
      HapticLoop loop(scene);
      FclOracle oracle(scene);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  // Cube sunk by 1 mm: its 8 side triangles and ... cross the floor's top; the count comes from brute force by FCL
  // above.
  const std::string sunk = message(cube_on_floor("lp", -0.001));
  REQUIRE(sunk.find("\"cube\"") != std::string::npos);
  REQUIRE(sunk.find("\"floor\"") != std::string::npos);
  REQUIRE(sunk.find("intersecting triangle pairs") != std::string::npos);

  Scene inside = cube_on_floor("lp", 0);
  inside.parts[1].mesh = shared(box({0.004, 0.004, 0.004}));
  inside.parts[1].pose.p = {0.1, 0.1, -0.01};
  REQUIRE(message(inside).find("inside") != std::string::npos);

  Scene two = cube_on_floor("lp", 0.1);
  two.parts[0].held = true;
  REQUIRE(message(two).find("both held") != std::string::npos);
  Scene none = cube_on_floor("lp", 0.1);
  none.parts[1].held = false;
  REQUIRE(message(none).find("no part is held") != std::string::npos);
  REQUIRE_THROWS_WITH(cube_on_floor("magic", 0.1), Catch::Contains("magic") && Catch::Contains("qp, lp"));
  Scene bad = cube_on_floor("lp", 0.1);
  bad.contact.l_min = -1;
  REQUIRE(message(bad).find("l_min") != std::string::npos);
}

TEST_CASE("long parts far from the held one are not near, though their spheres reach over it", "[sim]") {
  Scene scene = cube_on_floor("qp", 0.1);
  scene.parts.front().pose.p.z() -= 1;
  // Rods of 400 mm around the cube, 100 mm away: each sphere holds the whole cube.
  const auto rod = shared(box({0.004, 0.004, 0.4}));
  for (int i = 0; i < 60; ++i) {
    const double a = 2 * M_PI * i / 60;
    scene.parts.push_back({"rod", rod, {rotation({0, 0, a}), {0.1 * std::cos(a), 0.1 * std::sin(a), 0.1}}, false});
  }
  HapticLoop loop(scene);
  CHECK(loop.step({Quat::Identity(), {0.03, 0, 0.12}}, 0.001).candidate_parts == 0);
  // Close to one of them, that one and its neighbors are.
  int near = 0;
  for (int i = 0; i < 100; ++i) near = loop.step({Quat::Identity(), {0.077, 0, 0.12}}, 0.001).candidate_parts;
  CHECK(near > 0);
  CHECK(near < 10);
}
