// One law for pose and force: the wrench on the pen is the sum of the contact forces, whatever the part's size and
// shape, and however many contacts hold it.
#include <cmath>
#include <iostream>

#include "catch.hpp"
#include "coupling/local_model.hpp"
#include "loop/pocket.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

double radius(const TriangleMesh& mesh, const Vec3& center) {
  double r = 0;
  for (const Vec3& v : mesh.vertices) r = std::max(r, (v - center).norm());
  return r;
}

/// A body of `size` (m) over two to four others.
Scene wedge(unsigned seed, double size) {
  return pocket(seed, size, 2 + static_cast<int>(seed % 3));
}

struct Sums {
  double force = 0, torque = 0;  ///< of what is rendered, less the sum of contact forces, by what is rendered
  double lag = 0;                ///< force, by what is rendered
  double rest = 0;               ///< of k (X - Y), less contact forces and lag
  double arm = 0;                ///< |T| / |F| by the distance of the part's farthest point, on one contact
};

/// Compares at rest; false when nothing is touched.
bool compare(const Scene& scene, HapticLoop& loop, const Pose& Y, Sums& worst) {
  const TickReport& r = loop.report();
  // What the servo renders: its local model, then springs and dampers.
  LocalModel model;
  ProxyState x = r.proxy;
  model.update(r.planes, coupling_radius(loop.coupling()), loop.center(), Y, {}, x);
  const Wrench felt = coupling_wrench(loop.coupling(), x, Y, {}, loop.center());
  if (!r.proxy.touching || felt.force.norm() < 1e-3) return false;
  const Wrench springs = coupling_wrench(loop.coupling(), {r.proxy.X, {}, true}, Y, {}, loop.center());
  const Wrench sum = r.forces.sum(r.proxy.X * loop.center());
  const double size = radius(*scene.parts.back().mesh, loop.center());
  REQUIRE(r.forces.count > 0);
  for (int i = 0; i < r.forces.count; ++i) {
    const ContactForce& c = r.forces.items[static_cast<std::size_t>(i)];
    REQUIRE(c.force > 0);
    REQUIRE(c.n.norm() == Approx(1));
    REQUIRE(c.part.index + 1 < scene.parts.size());
    REQUIRE((c.point - r.proxy.X * loop.center()).norm() < 1.001 * size);
  }
  const double force = felt.force.norm();
  worst.force = std::max(worst.force, (sum.force - felt.force).norm() / force);
  worst.torque = std::max(worst.torque, (sum.torque - felt.torque).norm() / (force * size));
  worst.lag = std::max(worst.lag, r.forces.lag.force.norm() / force);
  worst.rest = std::max(worst.rest, (sum.force + r.forces.lag.force - springs.force).norm() / force);
  worst.rest = std::max(worst.rest, (sum.torque + r.forces.lag.torque - springs.torque).norm() / (force * size));
  // The forces of several contacts may turn a part without shifting it; a single one may not.
  if (r.forces.count == 1) worst.arm = std::max(worst.arm, felt.torque.norm() / force / size);
  return true;
}

/// A tetrahedron of `size` (m), none of whose sides are alike, about its center of mass.
TriangleMesh tetrahedron(double size) {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, 0.05, -1}, {1.1, -0.2, 0.4}, {-0.5, 0.9, 0.35}, {-0.7, -0.75, 0.25}};
  for (Vec3& v : mesh.vertices) v *= size;
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  return mesh;
}

}  // namespace

TEST_CASE("at rest the wrench is the sum of the contact forces", "[sim][law]") {
  const double size = GENERATE(0.002, 0.02, 0.1, 0.5);
  CAPTURE(size);
  Sums worst;
  int contacts[7] = {};
  int held = 0;
  for (unsigned seed = 1; held < 40; ++seed) {
    REQUIRE(seed < 120);
    Scene scene = wedge(seed, size);
    if (seed % 4 < 2) scene.max_torsional_stiffness = 18;
    HapticLoop loop(scene);
    std::mt19937 rng(seed);
    const Vec3 spin = random_vector(rng, 4e-4), home = scene.parts.back().pose.p;
    const Quat q = scene.parts.back().pose.q;
    Pose Y;
    for (int tick = 0; tick < 1000; ++tick) {
      const double on = std::min(1.0, tick / 500.0);
      Y = {rotation(500 * on * spin) * q, home - Vec3(0, 0, 5 * size * on)};
      loop.step(Y, 1e-3);
    }
    if (!compare(scene, loop, Y, worst)) continue;
    ++held;
    ++contacts[loop.report().forces.count];
  }
  std::cout << "parts of " << size << " m: force off by " << 100 * worst.force << " %, torque by " << 100 * worst.torque
            << " %, lag " << 100 * worst.lag << " %; with 1 to 6 contacts";
  for (int i = 1; i <= 6; ++i) std::cout << " " << contacts[i];
  std::cout << "\n";
  CHECK(worst.force < 0.01);
  CHECK(worst.torque < 0.01);
  CHECK(worst.rest < 1e-6);
  // A part that rests stops short of the last hair of its way (see the contact loop's stiction); the servo does not.
  CHECK(worst.lag < 0.02);
  CHECK(worst.arm < 1.01);
}

TEST_CASE("a part on one corner feels the force there and its moment", "[sim][law]") {
  const double size = GENERATE(0.002, 0.02, 0.2);
  const double scale = GENERATE(1.0, 3.0);
  CAPTURE(size, scale);
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.scale = scale;
  scene.parts.push_back(
      {"floor", shared(box(Vec3(20, 20, 2) * size)), {rotation({0.2, 0.1, 0}), Vec3(0, 0, 0)}, false});
  const Vec3 up = scene.parts[0].pose.q * Vec3::UnitZ();
  const TriangleMesh held = tetrahedron(size);
  const Quat q = scene.parts[0].pose.q * rotation({0.11, -0.07, 0.4});
  scene.parts.push_back({"tetrahedron", shared(held), {q, 2.5 * size * up}, true});
  HapticLoop loop(scene);
  // The lowest corner to a tenth of the size, or 3 mm, under the floor.
  const double lowest = up.dot(q * held.vertices[0]);
  const Pose Y = {q, (size - lowest - std::min(0.1 * size, 3e-3)) * up};
  for (int tick = 0; tick < 1000; ++tick)
    loop.step({q, scene.parts[1].pose.p + std::min(1.0, tick / 400.0) * (Y.p - scene.parts[1].pose.p)}, 1e-3);
  const TickReport& r = loop.report();
  CouplingSettings felt = loop.coupling();
  felt.stiffness /= scale;  // as the servo renders it
  const Wrench w = coupling_wrench(felt, r.proxy, Y, {}, loop.center());
  const Vec3 c = r.proxy.X * loop.center(), arm = (r.proxy.X * held.vertices[0] - c) / scale;
  REQUIRE(w.force.norm() > 1e-3);
  CHECK(w.force.cross(up).norm() < 1e-3 * w.force.norm());
  CHECK((w.torque - arm.cross(w.force)).norm() < 0.01 * arm.norm() * w.force.norm());
  REQUIRE(r.forces.count == 1);
  CHECK(r.forces.items[0].force == Approx(w.force.norm()).epsilon(0.01));
  CHECK((r.forces.sum(c, scale).torque - w.torque).norm() < 0.01 * arm.norm() * w.force.norm());
}

TEST_CASE("what lags is told apart from what contacts exert", "[sim][law]") {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"floor", shared(box({0.3, 0.3, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"block", shared(box({0.02, 0.02, 0.02})), {Quat::Identity(), {0, 0, 0.011}}, true});
  HapticLoop loop(scene);
  for (int tick = 0; tick < 200; ++tick) loop.step({Quat::Identity(), {0, 0, 0.009}}, 1e-3);
  // In a tick the part does not go 80 mm; what it has not gone is a pull along the floor, the contacts' is across it.
  const Pose Y{Quat::Identity(), {0.08, 0, 0.009}};
  const TickReport& r = loop.step(Y, 1e-3);
  CouplingSettings springs = loop.coupling();
  springs.damping = springs.torsional_damping = 0;
  const Wrench w = coupling_wrench(springs, r.proxy, Y, {}, loop.center());
  const Wrench sum = r.forces.sum(r.proxy.X * loop.center());
  CHECK((sum.force + r.forces.lag.force - w.force).norm() < 1e-9);
  CHECK((sum.torque + r.forces.lag.torque - w.torque).norm() < 1e-9);
  CHECK(sum.force.head<2>().norm() < 1e-6);
  CHECK(sum.force.z() == Approx(0.8).epsilon(0.02));
  // Without contact nothing is exerted.
  for (int tick = 0; tick < 200; ++tick) loop.step({Quat::Identity(), {0, 0, 0.05}}, 1e-3);
  CHECK(loop.report().forces.count == 0);
  CHECK(loop.report().forces.lag.force.norm() == 0);
}

TEST_CASE("the paper's program has no contact forces to tell, and a servo no planes of it", "[sim][law]") {
  for (const char* resolver : {"lp", "impulse", "penalty"}) {
    CAPTURE(resolver);
    Scene scene = wedge(2, 0.02);
    scene.contact.resolver = resolver_kind(resolver);
    HapticLoop loop(scene);
    bool touched = false;
    for (int tick = 0; tick < 400; ++tick) {
      const TickReport& r = loop.step({scene.parts.back().pose.q, {0, 0, 0.09 - 2e-4 * tick}}, 1e-3);
      touched |= r.proxy.touching;
      REQUIRE(r.forces.count == 0);
      REQUIRE(r.planes.count == 0);
    }
    CHECK(touched);
  }
}
