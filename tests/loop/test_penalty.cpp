// The penalty method against closed forms, and the depth it reports against brute force.
#include "bodies.hpp"
#include "catch.hpp"
#include "loop/triangle_oracle.hpp"
#include "models/shapes.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "winding_number.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// The deepest vertex of either body inside the other: inside by solid angles, the depth to all triangles.
double deepest(const TriangleMesh& a, const Pose& X_WA, const TriangleMesh& b, const Pose& X_WB) {
  double depth = 0;
  const auto look = [&](const TriangleMesh& of, const Pose& X_in) {
    return [&, X_in](const TriangleMesh& in) {
      for (const Vec3& v : of.vertices) {
        const Vec3 p = X_in * v;
        if (winding_number(in, p) > 0.5) depth = std::max(depth, distance_to_surface(in, p));
      }
    };
  };
  look(a, X_WB.inverse() * X_WA)(b);
  look(b, X_WA.inverse() * X_WB)(a);
  return depth;
}

Scene pressed(double stiffness) {
  Scene scene;
  scene.contact.resolver = ResolverKind::penalty;
  scene.contact.penalty.stiffness = stiffness;
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"floor", shared(shapes::box({0.3, 0.3, 0.2})), {Quat::Identity(), {0, 0, -0.1}}, false});
  scene.parts.push_back({"box", shared(shapes::box({0.02, 0.02, 0.02})), {Quat::Identity(), {0, 0, 0.012}}, true});
  return scene;
}

}  // namespace

TEST_CASE("a pressed box sinks in by force / (4 stiffness)", "[penalty]") {
  const double k = GENERATE(500.0, 2000.0, 50000.0), below = 0.002;
  CAPTURE(k);
  const Scene scene = pressed(k);
  HapticLoop loop(scene);
  const Pose Y{Quat::Identity(), {0, 0, 0.01 - below}};
  for (int tick = 0; tick < 300; ++tick) loop.step(Y, 1e-3);
  const TickReport& r = loop.report();
  // Two springs in a row: the coupling's and four at the corners.
  const double depth = scene.coupling.stiffness * below / (scene.coupling.stiffness + 4 * k);
  CHECK(r.contacts == 4);
  CHECK(r.depth == Approx(depth).epsilon(1e-6));
  CHECK(r.gap == Approx(-depth).epsilon(1e-6));
  CHECK(0.01 - r.proxy.X.p.z() == Approx(depth).epsilon(1e-6));
  const double force = coupling_wrench(scene.coupling, r.proxy, Y, {}, loop.center()).force.z();
  CHECK(force == Approx(4 * k * depth).epsilon(1e-3));
}

TEST_CASE("damping slows the sinking, not the depth", "[penalty]") {
  double after_one[2];
  for (const int damped : {0, 1}) {
    Scene scene = pressed(2000);
    scene.contact.penalty.damping = damped * 50.0;
    HapticLoop loop(scene);
    for (int tick = 0; tick < 50; ++tick) loop.step({Quat::Identity(), {0, 0, 0.01}}, 1e-3);
    const Pose Y{Quat::Identity(), {0, 0, 0.008}};
    // The second tick: in the first the corners were just on the surface.
    loop.step(Y, 1e-3);
    after_one[damped] = loop.step(Y, 1e-3).depth;
    for (int tick = 0; tick < 2000; ++tick) loop.step(Y, 1e-3);
    CHECK(loop.report().depth == Approx(800 * 0.002 / (800 + 8000)).epsilon(1e-3));
  }
  CHECK(after_one[1] < 0.7 * after_one[0]);
}

TEST_CASE("the reported depth is that of brute force", "[penalty]") {
  std::mt19937 rng(5);
  int checked = 0;
  for (int body = 0; body < 12; ++body) {
    Scene scene;
    scene.contact.resolver = ResolverKind::penalty;
    scene.contact.tick_budget = INFINITY;
    const bool convex = body % 2 == 0;
    const auto make = [&](double size) {
      return shared(convex ? random_convex_body(rng, 14, size) : random_star_body(rng, 14, size));
    };
    scene.parts.push_back({"fixed", make(0.03), {rotation(3 * random_direction(rng)), Vec3::Zero()}, false});
    scene.parts.push_back({"held", make(0.02), {rotation(3 * random_direction(rng)), {0, 0, 0.09}}, true});
    HapticLoop loop(scene);
    for (int tick = 0; tick < 400; ++tick) {
      const TickReport& r = loop.step({scene.parts[1].pose.q, {0, 0, 0.09 - 1.5e-4 * tick}}, 1e-3);
      if (tick % 10 != 0) continue;
      const double depth = deepest(*scene.parts[1].mesh, r.proxy.X, *scene.parts[0].mesh, scene.parts[0].pose);
      REQUIRE(r.depth == Approx(depth).margin(1e-9));
      checked += depth > 1e-5 ? 1 : 0;
    }
  }
  CHECK(checked > 20);
}
