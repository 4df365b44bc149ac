// Coulomb friction in the contact loop and in the servo's local model: on meshes, through the certificate, tick by
// tick.
#include <cmath>
#include <iostream>

#include "bodies.hpp"
#include "catch.hpp"
#include "coupling/local_model.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// A block of 40 × 40 × 20 mm a hair above a floor whose normal is `up`.
Scene block_on_floor(double mu, const Quat& q = Quat::Identity()) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.friction.mu = mu;
  scene.parts.push_back({"floor", shared(box({0.4, 0.4, 0.02})), {q, q * Vec3(0, 0, -0.01)}, false});
  scene.parts.push_back({"block", shared(box({0.04, 0.04, 0.02})), {q, q * Vec3(0, 0, 0.0101)}, true});
  return scene;
}

Wrench springs(const HapticLoop& loop, const Pose& Y) {
  CouplingSettings k = loop.coupling();
  k.damping = k.torsional_damping = 0;
  return coupling_wrench(k, {loop.report().proxy.X, {}, true}, Y, {}, loop.center());
}

/// Presses the held part down by `depth` (m) along `up`, in 200 ticks.
Pose press(HapticLoop& loop, Pose Y, const Vec3& up, double depth) {
  const Vec3 from = Y.p;
  for (int i = 1; i <= 300; ++i) {
    Y.p = from - std::min(1.0, i / 200.0) * depth * up;
    loop.step(Y, 1e-3);
  }
  return Y;
}

}  // namespace

TEST_CASE("a block slides on a floor with mu N against its way, in every direction, and does not lift",
          "[sim][friction]") {
  const double mu = GENERATE(0.1, 0.3, 0.8);
  const int heading = GENERATE(0, 1, 2, 3, 4);
  CAPTURE(mu, heading);
  // The floor is turned, so that its plane lies across the axes.
  const Quat q = rotation({0.3 * heading, -0.2, 0.7});
  const Scene scene = block_on_floor(mu, q);
  HapticLoop loop(scene);
  Pose Y = press(loop, scene.parts[1].pose, q * Vec3::UnitZ(), 2e-3);
  const double angle = 0.4 + 1.1 * heading;
  const Vec3 way = q * Vec3(std::cos(angle), std::sin(angle), 0), up = q * Vec3::UnitZ();
  const Quat before = loop.report().proxy.X.q;
  double ratio = 0, aside = 0, least = 1, most = 0;
  for (int i = 0; i < 300; ++i) {  // 30 mm at 0.1 m/s
    Y.p += 1e-4 * way;
    const TickReport& r = loop.step(Y, 1e-3);
    if (i < 60) continue;
    const Vec3 f = springs(loop, Y).force;
    const double normal = f.dot(up);
    ratio = std::max(ratio, std::abs(-f.dot(way) / (mu * normal) - 1));
    aside = std::max(aside, std::abs(f.dot(up.cross(way))) / (mu * normal));
    least = std::min(least, r.gap);
    most = std::max(most, r.gap);
    REQUIRE(r.forces.items[0].slides);
  }
  CHECK(ratio < 0.01);
  CHECK(aside < 0.01);
  CHECK(most - least <= 0.5e-6);
  CHECK(loop.report().proxy.X.q.angularDistance(before) < 1e-6);
  // It stops where the pen stops, and what it tells says so.
  for (int i = 0; i < 20; ++i) loop.step(Y, 1e-3);
  for (int i = 0; i < loop.report().forces.count; ++i)
    CHECK_FALSE(loop.report().forces.items[static_cast<std::size_t>(i)].slides);
}

TEST_CASE("a block under force and twist within the cone does not creep, between ticks neither", "[sim][friction]") {
  const double mu = GENERATE(0.1, 0.3, 0.8);
  CAPTURE(mu);
  const Scene scene = block_on_floor(mu);
  HapticLoop loop(scene);
  Pose Y = press(loop, scene.parts[1].pose, Vec3::UnitZ(), 2e-3);
  // A third of what the corners' friction holds along the floor, and a third of what it holds about the normal.
  const double friction = mu * springs(loop, Y).force.z();
  Y.p.x() += 0.3 * friction / loop.coupling().stiffness;
  Y.q = rotation({0.01, 0.005, 0.3 * friction * 0.028 / loop.coupling().torsional_stiffness}) * Y.q;
  for (int i = 0; i < 200; ++i) loop.step(Y, 1e-3);
  const Pose X = loop.report().proxy.X;
  for (int i = 0; i < 20000; ++i) loop.step(Y, 1e-3);
  const Displacement crept = displacement(X, loop.report().proxy.X, loop.center());
  CHECK(crept.dp.norm() <= 1e-9);
  CHECK(crept.dr.norm() <= 1e-6);
  CHECK(loop.report().lag_reason == LagReason::contact);
  // The servo holds it at the same place, and while the pen goes to and fro within the cone.
  LocalModel model;
  for (int i = 0; i < 50; ++i) {
    Pose pen = Y;
    pen.p += 0.02 * mu * 2e-3 * Vec3(std::sin(i), std::cos(1.7 * i), 0);
    ProxyState x = loop.report().proxy;
    REQUIRE(model.update(loop.report().planes, coupling_radius(loop.coupling()), loop.center(), pen, {}, x));
    const Displacement d = displacement(X, x.X, loop.center());
    REQUIRE(d.dp.norm() <= 1e-9);
    REQUIRE(d.dr.norm() <= 1e-6);
  }
}

TEST_CASE("the servo's part slides as the contact loop's does, and a part that sticks has no velocity",
          "[sim][friction]") {
  const double mu = 0.3;
  const Scene scene = block_on_floor(mu);
  HapticLoop loop(scene);
  Pose Y = press(loop, scene.parts[1].pose, Vec3::UnitZ(), 2e-3);
  LocalModel model;
  const auto update = [&](const Pose& pen, ProxyState& x) {
    x = loop.report().proxy;
    return model.update(loop.report().planes, coupling_radius(loop.coupling()), loop.center(), pen,
                        {{0.05, 0, 0}, {0, 0, 0}}, x);
  };
  ProxyState x;
  REQUIRE(update(Y, x));
  CHECK(x.velocity.v.norm() < 1e-9);
  for (int i = 0; i < 200; ++i) {
    Y.p.x() += 5e-5;
    loop.step(Y, 1e-3);
  }
  Pose next = Y;
  next.p.x() += 5e-5;
  REQUIRE(update(next, x));
  CHECK(x.velocity.v.x() == Approx(0.05));
  loop.step(next, 1e-3);
  CHECK((x.X.p - loop.report().proxy.X.p).norm() < 1e-9);
}

TEST_CASE("contact forces with friction sum up to the springs' wrench, each within its cone", "[sim][friction]") {
  const unsigned seed = GENERATE(range(1u, 25u));
  std::mt19937 rng(seed);
  const double size = seed % 2 == 0 ? 0.02 : 0.1, mu = 0.1 + 0.1 * (seed % 5);
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.friction.mu = mu;
  for (int k = 0; k < 3; ++k) {
    const double a = 2 * M_PI * k / 3;
    scene.parts.push_back({"fixed" + std::to_string(k),
                           shared(random_convex_body(rng, 12, 1.5 * size)),
                           {rotation(3 * random_direction(rng)), 1.5 * size * Vec3(std::cos(a), std::sin(a), 0)}});
  }
  scene.parts.push_back(
      {"held", shared(random_convex_body(rng, 12, size)), {rotation(random_direction(rng)), {0, 0, 4.5 * size}}, true});
  HapticLoop loop(scene);
  const Vec3 spin = random_vector(rng, 4e-4), home = scene.parts.back().pose.p;
  const Quat q = scene.parts.back().pose.q;
  for (int tick = 0; tick < 800; ++tick) {
    const double on = std::min(1.0, tick / 400.0);
    const Pose Y{rotation(500 * on * spin) * q, home - Vec3(0, 0, 5 * size * on)};
    const TickReport& r = loop.step(Y, 1e-3);
    if (!r.proxy.touching) continue;
    const Wrench w = springs(loop, Y), sum = r.forces.sum(r.proxy.X * loop.center());
    const double force = w.force.norm() + w.torque.norm() / size;
    REQUIRE((sum.force + r.forces.lag.force - w.force).norm() <= 1e-6 * force + 1e-9);
    REQUIRE((sum.torque + r.forces.lag.torque - w.torque).norm() <= 1e-6 * force * size + 1e-9);
    for (int i = 0; i < r.forces.count; ++i) {
      const ContactForce& c = r.forces.items[static_cast<std::size_t>(i)];
      REQUIRE(c.force > 0);
      REQUIRE(c.mu == mu);
      REQUIRE(std::abs(c.friction.dot(c.n)) <= 1e-9 * force);
      REQUIRE(c.friction.norm() <= c.mu * c.force + 1e-6 * force);
    }
  }
}

TEST_CASE("around closed ways of the pen friction only takes energy", "[sim][friction]") {
  const double mu = GENERATE(0.0, 0.1, 0.5);
  const Scene scene = block_on_floor(mu);
  HapticLoop loop(scene);
  Pose home = press(loop, scene.parts[1].pose, Vec3::UnitZ(), 1e-3);
  // Slides, tilts, spins, lifts off and comes back; smooth, so that what a sampled spring makes of steps stays small.
  const auto at = [&](double s) {
    const double a = 2 * M_PI * s;
    Pose Y = home;
    Y.p += Vec3(3e-3 * std::sin(a), 2e-3 * std::sin(2 * a), 0.7e-3 * (1 - std::cos(a)));
    Y.q = rotation(Vec3(0.01 * std::sin(2 * a), 0.02 * std::sin(a), 0.05 * std::sin(a))) * Y.q;
    return Y;
  };
  // Friction's first round leaves the part where the way begins for good.
  double given = 0;
  constexpr int kSteps = 20000;
  for (int round = 0; round < 2; ++round) {
    given = 0;
    Wrench last;
    Pose last_Y;
    for (int i = 0; i <= kSteps; ++i) {
      const Pose Y = at(static_cast<double>(i % kSteps) / kSteps);
      loop.step(Y, 1e-3);
      const Wrench w = springs(loop, Y);
      if (i > 0) {
        const Displacement d = displacement(last_Y, Y, loop.center());
        given += 0.5 * ((w.force + last.force).dot(d.dp) + (w.torque + last.torque).dot(d.dr));
      }
      last = w;
      last_Y = Y;
    }
  }
  std::cout << "mu " << mu << ": the hand gets " << given << " J on a closed way\n";
  CHECK(given <= 1e-9);
  if (mu > 0) CHECK(given < -1e-6);
}

TEST_CASE("a plate in a slot of 5 um play slides at mu 0.8 and does not jam", "[sim][friction]") {
  const double mu = 0.8, play = 5e-6;
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.friction.mu = mu;
  const double half = 0.005 + 0.5 * play;
  scene.parts.push_back({"under", shared(box({0.2, 0.1, 0.01})), {Quat::Identity(), {0, 0, -0.005 - half}}});
  scene.parts.push_back({"over", shared(box({0.2, 0.1, 0.01})), {Quat::Identity(), {0, 0, 0.005 + half}}});
  scene.parts.push_back({"plate", shared(box({0.04, 0.04, 0.01})), {Quat::Identity(), Vec3::Zero()}, true});
  HapticLoop loop(scene);
  Pose Y = press(loop, scene.parts[2].pose, Vec3::UnitZ(), 1e-3);
  const double from = loop.report().proxy.X.p.x();
  double ratio = 0;
  for (int i = 0; i < 300; ++i) {
    Y.p.x() += 1e-4;
    loop.step(Y, 1e-3);
    const Vec3 f = springs(loop, Y).force;
    if (i > 100) ratio = std::max(ratio, std::abs(-f.x() / (mu * f.z()) - 1));
  }
  CHECK(loop.report().proxy.X.p.x() - from > 0.028);
  CHECK(ratio < 0.01);
}

TEST_CASE("friction is that of the pair, and none where nothing rubs is as none at all", "[sim][friction]") {
  Scene scene = block_on_floor(0.5);
  scene.parts.push_back({"wall", shared(box({0.02, 0.4, 0.1})), {Quat::Identity(), {0.2, 0, 0.05}}});
  scene.friction.pairs = {{"floor", "block", 0.2}, {"wall", "nobody", 0.9}};
  HapticLoop loop(scene);
  Pose Y = press(loop, scene.parts[1].pose, Vec3::UnitZ(), 2e-3);
  for (int i = 0; i < 100; ++i) {
    Y.p.y() += 1e-4;
    loop.step(Y, 1e-3);
  }
  const Vec3 f = springs(loop, Y).force;
  CHECK(-f.y() == Approx(0.2 * f.z()).epsilon(0.01));

  Scene plain = block_on_floor(0);
  Scene named = block_on_floor(0.5);
  named.friction.pairs = {{"block", "floor", 0}};
  HapticLoop a(plain), b(named);
  for (int i = 0; i < 400; ++i) {
    const Pose pen{rotation({1e-4 * i, 0, 0}), {1e-4 * i, 0, 0.0101 - 1e-5 * i}};
    const Pose X = a.step(pen, 1e-3).proxy.X;
    const TickReport& r = b.step(pen, 1e-3);
    REQUIRE(X.p == r.proxy.X.p);
    REQUIRE(X.q.coeffs() == r.proxy.X.q.coeffs());
  }
}

namespace {

/// Knows normals alone.
class Normals final : public Resolver {
 public:
  explicit Normals(int capacity) : qp_(make_resolver(ResolverKind::qp, capacity)) {}
  Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept override {
    return qp_->resolve(rows, bounds, wanted);
  }
  bool projects() const override { return true; }

 private:
  std::unique_ptr<Resolver> qp_;
};

}  // namespace

TEST_CASE("a custom resolver that knows only normals goes on working in a scene with friction", "[sim][friction]") {
  Scene with = block_on_floor(0.5), without = block_on_floor(0);
  with.contact.custom_resolver = without.contact.custom_resolver = [](int n) { return std::make_unique<Normals>(n); };
  HapticLoop a(with), b(without);
  for (int i = 0; i < 300; ++i) {
    const Pose pen{Quat::Identity(), {1e-4 * i, 0, 0.0101 - 1e-5 * i}};
    const Pose X = a.step(pen, 1e-3).proxy.X;
    REQUIRE(X.p == b.step(pen, 1e-3).proxy.X.p);
    for (int k = 0; k < a.report().forces.count; ++k)
      REQUIRE(a.report().forces.items[static_cast<std::size_t>(k)].friction.isZero());
  }
}

TEST_CASE("friction that cannot be is refused", "[sim][friction]") {
  for (const double mu : {-0.1, 10.1, std::nan(""), static_cast<double>(INFINITY)})
    CHECK_THROWS_AS(HapticLoop(block_on_floor(mu)), Error);
  Scene pair = block_on_floor(0);
  pair.friction.pairs = {{"floor", "block", -1}};
  CHECK_THROWS_AS(HapticLoop(pair), Error);
  for (const char* resolver : {"lp", "impulse", "penalty"}) {
    Scene scene = block_on_floor(0.3);
    scene.contact.resolver = resolver_kind(resolver);
    CHECK_THROWS_WITH(HapticLoop(scene), Catch::Contains("does not support friction"));
    scene.friction.mu = 0;
    CHECK_NOTHROW(HapticLoop(scene));
  }
}
