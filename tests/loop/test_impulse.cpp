// The impulse method against closed forms.
#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "loop/ladder_pen.hpp"
#include "models/shapes.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/mesh/mass.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kEnvelope = 2e-6;  // m, as docs/scene-file.md says

/// A body over a floor whose top is z = 0; the coupling is nearly nothing, so that a pen far away pulls steadily.
Scene over_floor(TriangleMesh body, const Pose& X) {
  Scene scene;
  scene.contact.resolver = ResolverKind::impulse;
  scene.contact.tick_budget = INFINITY;
  scene.contact.impulse.substep = 5e-5;
  scene.coupling = {1e-3, 0, 1e-9, 0};
  scene.parts.push_back({"floor", shared(shapes::box({0.3, 0.3, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"body", shared(std::move(body)), X, true});
  return scene;
}

double mass_of(const Scene& scene) {
  return mass_properties(*scene.parts.back().mesh, true, scene.contact.density).mass;
}

}  // namespace

TEST_CASE("a dropped ball bounces to the height of its restitution", "[impulse]") {
  const double e = GENERATE(0.0, 0.5, 0.8, 1.0), radius = 0.01, drop = 0.01;
  CAPTURE(e);
  Scene scene = over_floor(shapes::sphere(2 * radius, 32, 16), {Quat::Identity(), {0, 0, radius + kEnvelope + drop}});
  scene.contact.impulse.restitution = e;
  HapticLoop loop(scene);
  // So far away that the spring pulls like gravity.
  const double k = scene.coupling.stiffness, below = mass_of(scene) * 9.81 / k;
  const Pose Y{Quat::Identity(), {0, 0, -below}};
  double low = INFINITY, top = 0;
  bool up = false;
  for (int tick = 0; tick < 200; ++tick) {
    const double height = loop.step(Y, 1e-3).proxy.X.p.z() - radius - kEnvelope;
    REQUIRE(height > -kEnvelope);
    const double v = loop.report().proxy.velocity.v.z();
    if (up && v < 0) break;  // the top of the first bounce
    up = up || v > 0;
    low = std::min(low, height);
    top = up ? std::max(top, height) : 0;
  }
  // Energy: (z - z_Y)² loses nothing on the way; the impact keeps e² of the speed's square.
  const auto square = [&](double z) { return (z + below) * (z + below); };
  const double at_floor = radius + kEnvelope;
  const double expected =
      std::sqrt(square(at_floor) + e * e * (square(at_floor + drop) - square(at_floor))) - below - at_floor;
  CHECK(top == Approx(expected).epsilon(0.01).margin(2e-6));
}

TEST_CASE("an impulse acts at the corner that hits: linear and angular momentum, and the speed of the corner",
          "[impulse]") {
  const double e = GENERATE(0.3, 1.0);
  CAPTURE(e);
  const Vec3 size(0.02, 0.03, 0.012);
  const Quat q = rotation({0.4, -0.3, 0.2});
  Scene scene = over_floor(shapes::box(size), {q, {0, 0, 0.03}});
  scene.contact.impulse.restitution = e;
  const MassProperties mass = mass_properties(*scene.parts.back().mesh, true, scene.contact.density);
  HapticLoop loop(scene);
  for (int tick = 0; tick < 100; ++tick) loop.step({q, {0, 0, -1000}}, 1e-4);  // a push, then nothing pulls any more
  Twist before = loop.report().proxy.velocity;
  REQUIRE(before.v.z() < -0.1);
  int tick = 0;
  Pose X = loop.report().proxy.X;
  for (; tick < 20000; ++tick) {
    X = loop.report().proxy.X;
    if (loop.step(X, 1e-5).iterations > 0) break;
    before = loop.report().proxy.velocity;
  }
  REQUIRE(loop.report().iterations == 1);
  const Twist after = loop.report().proxy.velocity;
  Vec3 corner(0, 0, INFINITY);
  for (const Vec3& v : scene.parts.back().mesh->vertices)
    if ((X.q * v).z() < corner.z()) corner = X.q * v;
  const Vec3 p = mass.mass * (after.v - before.v);
  const Mat3 R = X.q.toRotationMatrix();
  const Vec3 L = R * mass.inertia * R.transpose() * (after.w - before.w);
  CHECK(p.z() > 0);
  CHECK(p.head<2>().norm() < 1e-6 * p.z());                             // frictionless: along the normal only
  CHECK((L - corner.cross(p)).norm() < 0.01 * corner.cross(p).norm());  // about the corner nothing changes
  const auto speed = [&](const Twist& V) { return (V.v + V.w.cross(corner)).z(); };
  CHECK(speed(after) == Approx(-e * speed(before)).epsilon(0.01));
  const auto energy = [&](const Twist& V) {
    return 0.5 * mass.mass * V.v.squaredNorm() + 0.5 * V.w.dot(R * mass.inertia * R.transpose() * V.w);
  };
  if (e == 1.0)
    CHECK(energy(after) == Approx(energy(before)).epsilon(0.01));
  else
    CHECK(energy(after) < energy(before));
}

TEST_CASE("a box pressed on a floor rests", "[impulse]") {
  Scene scene = over_floor(shapes::box({0.02, 0.02, 0.02}), {Quat::Identity(), {0, 0, 0.012}});
  scene.coupling = CouplingSettings();
  scene.contact.impulse = ImpulseSettings();
  HapticLoop loop(scene);
  const Pose Y{Quat::Identity(), {0, 0, 0.008}};  // 2 mm into the floor
  for (int tick = 0; tick < 500; ++tick) loop.step(Y, 1e-3);
  const Pose rest = loop.report().proxy.X;
  CHECK(rest.p.z() - 0.01 == Approx(kEnvelope).margin(1e-6));
  double moved = 0, turned = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const Displacement d = displacement(rest, loop.step(Y, 1e-3).proxy.X, loop.center());
    moved = std::max(moved, d.dp.norm());
    turned = std::max(turned, d.dr.norm());
    REQUIRE(loop.report().proxy.touching);
  }
  CHECK(moved < 1e-6);
  CHECK(turned < 1e-4);
}

TEST_CASE("two walls alike push alike", "[impulse]") {
  // A ball pressed into a groove of two walls at 45 degrees, whose bottom is the y axis: nothing pushes it sideways.
  const double radius = 0.01;
  Scene scene = over_floor(shapes::sphere(2 * radius, 64, 32), {Quat::Identity(), {0, 0, 0.05}});
  scene.parts.front().pose.p.z() = -0.2;
  for (const double side : {-1.0, 1.0}) {
    const Quat q = rotation({0, -side * M_PI / 4, 0});
    const Vec3 n = q * Vec3::UnitZ();
    scene.parts.push_back({side < 0 ? "left" : "right",
                           shared(shapes::box({0.2, 0.2, 0.01})),
                           {q, -0.005 * n + q * Vec3(side * 0.1001, 0, 0)},
                           false});
  }
  scene.coupling = CouplingSettings();
  HapticLoop loop(scene);
  const double rest = std::sqrt(2.0) * radius;
  for (int tick = 0; tick < 1000; ++tick)
    loop.step({Quat::Identity(), {0, 0, std::max(0.05 - 2e-4 * tick, rest - 0.002)}}, 1e-3);
  const Pose X = loop.report().proxy.X;
  CHECK(loop.report().proxy.touching);
  // The facets of the ball and the walls' 0.1 mm apart at the bottom move the height a little, never the side.
  CHECK(std::abs(X.p.x()) < 5e-6);
  CHECK(std::abs(X.p.y()) < 5e-6);
  CHECK(X.p.z() == Approx(rest).margin(2e-4));
}

TEST_CASE("impulses never let the peg into the wall, and repeat bit for bit", "[impulse]") {
  Scene scene;
  scene.contact.resolver = ResolverKind::impulse;
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"hole", shared(shapes::block_with_hole({})), Pose{}, false});
  const StylusScript script = ladder_script({0.06, 1e-3, 7}, 0.025, 0.04);
  scene.parts.push_back({"peg", shared(shapes::peg({})), script.pose(0), true});
  HapticLoop loop(scene), again(scene);
  const FclOracle oracle(scene);
  int touching = 0;
  for (int tick = 0; tick < 7500; ++tick) {
    const Pose Y = script.pose(1e-3 * tick);
    const TickReport& r = loop.step(Y, 1e-3);
    REQUIRE(again.step(Y, 1e-3).proxy.X.p == r.proxy.X.p);
    touching += r.proxy.touching;
    if (tick % 5 == 0)
      for (const Pose& X : r.substeps) REQUIRE(oracle.intersecting(X).empty());
  }
  CHECK(touching > 2000);
  CHECK(loop.report().proxy.X.p.z() < 0.025 - 0.0399);  // the tip on the bottom, 40 mm down
}
