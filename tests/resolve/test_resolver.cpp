#include <cmath>

#include "bodies.hpp"
#include "catch.hpp"
#include "resolve/metric.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/resolve/resolver.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

MassProperties random_mass(std::mt19937& rng) {
  MassProperties m;
  m.mass = 0.3;
  const Mat3 U = rotation(3 * random_direction(rng)).toRotationMatrix();
  m.inertia = U * (Vec3(2e-4, 3e-4, 4e-4) + random_vector(rng, 1e-4)).asDiagonal() * U.transpose();
  return m;
}

}  // namespace

TEST_CASE("whitened coordinates are the mass metric, and rows keep their meaning in them", "[resolve]") {
  std::mt19937 rng(51);
  for (int i = 0; i < 200; ++i) {
    const MassProperties mass = random_mass(rng);
    Metric metric(mass);
    const Quat q = rotation(3 * random_direction(rng));
    metric.set_orientation(q);
    const Displacement d{random_vector(rng, 1e-3), random_vector(rng, 1e-2)};
    const Mat3 I_W = q.toRotationMatrix() * mass.inertia * q.toRotationMatrix().transpose();
    const double expected = d.dp.squaredNorm() + d.dr.dot(I_W * d.dr) / mass.mass;
    REQUIRE(metric.whiten(d).squaredNorm() == Approx(expected).epsilon(1e-10));
    const Displacement back = metric.unwhiten(metric.whiten(d));
    REQUIRE((back.dp - d.dp).norm() < 1e-15);
    REQUIRE((back.dr - d.dr).norm() < 1e-14);
    const Contact c{random_direction(rng), random_vector(rng, 0.03), 0, {}, 0};
    REQUIRE(metric.row(c).dot(metric.whiten(d)) == Approx(c.n.dot(d.dp + d.dr.cross(c.r))).margin(1e-15));
  }
}

TEST_CASE("in the metric of the coupling the squared length is the springs' energy, the same about every axis",
          "[resolve]") {
  std::mt19937 rng(53);
  const double k = 700, torsional = 0.2;
  Metric metric(std::sqrt(torsional / k));
  for (int i = 0; i < 200; ++i) {
    metric.set_orientation(rotation(3 * random_direction(rng)));
    const Displacement d{random_vector(rng, 1e-3), random_vector(rng, 1e-2)};
    const double energy = 0.5 * (k * d.dp.squaredNorm() + torsional * d.dr.squaredNorm());
    REQUIRE(0.5 * k * metric.whiten(d).squaredNorm() == Approx(energy).epsilon(1e-12));
    const Displacement back = metric.unwhiten(metric.whiten(d));
    REQUIRE((back.dp - d.dp).norm() < 1e-15);
    REQUIRE((back.dr - d.dr).norm() < 1e-14);
    const Contact c{random_direction(rng), random_vector(rng, 0.03), 0, {}, 0};
    REQUIRE(metric.row(c).dot(metric.whiten(d)) == Approx(c.n.dot(d.dp + d.dr.cross(c.r))).margin(1e-15));
  }
}

TEST_CASE("a resolved motion satisfies every constraint and never goes away from the target", "[resolve]") {
  const std::string name = GENERATE("lp", "qp");
  CAPTURE(name);
  std::mt19937 rng(52);
  const auto resolver = make_resolver(resolver_kind(name), 64);
  Metric metric(random_mass(rng));
  metric.set_orientation(Quat::Identity());
  for (int i = 0; i < 500; ++i) {
    LowRankMatrix rows(64);
    std::vector<double> bounds;
    const int n = 1 + static_cast<int>(rng() % 60);
    for (int k = 0; k < n; ++k) {
      rows.push_row(metric.row({random_direction(rng), random_vector(rng, 0.03), 0, {}, 0}));
      bounds.push_back(-1e-4 * static_cast<double>(rng() % 100) / 100);  // standing still is allowed
    }
    const Vec6 wanted = metric.whiten({random_vector(rng, 1e-3), random_vector(rng, 2e-2)});
    const Resolution r = resolver->resolve(rows, bounds.data(), wanted);
    REQUIRE(r.status == ResolveStatus::solved);
    for (int k = 0; k < n; ++k) REQUIRE(rows.row(k).dot(r.motion) >= bounds[k] - 1e-12);
    REQUIRE((wanted - r.motion).norm() <= wanted.norm() * (1 + 1e-12));
    // Half or twice the motion is no better when nothing but its own length is free (line search, projection).
    if (name == "lp") REQUIRE((wanted - r.motion).norm() <= (wanted - 0.9 * r.motion).norm() + 1e-15);
  }
}

TEST_CASE("constraints that contradict each other are reported, and nothing moves", "[resolve]") {
  const std::string name = GENERATE("lp", "qp");
  const auto resolver = make_resolver(resolver_kind(name), 8);
  LowRankMatrix rows(8);
  Vec6 up = Vec6::Zero();
  up[2] = 1;
  rows.push_row(up);
  rows.push_row(-up);
  const double bounds[] = {1e-6, 1e-6};
  const Resolution r = resolver->resolve(rows, bounds, Vec6::Ones());
  REQUIRE(r.status == ResolveStatus::infeasible);
  REQUIRE(r.motion.isZero());
}

TEST_CASE("an unknown resolver is an error that names it", "[resolve]") {
  REQUIRE_THROWS_AS(resolver_kind("magic"), Error);
  for (const std::string& name : resolver_names()) CHECK(to_string(resolver_kind(name)) == name);
  for (const ResolverKind kind : {ResolverKind::impulse, ResolverKind::penalty})
    REQUIRE_THROWS_WITH(make_resolver(kind, 8), Catch::Contains("loop of its own"));
  for (const std::string name : {"lp", "qp"}) REQUIRE(make_resolver(resolver_kind(name), 8) != nullptr);
}
