#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "catch.hpp"
#include "models/shapes.hpp"
#include "tegotae/mesh/mass.hpp"

using namespace tegotae;

namespace {

const double kPi = std::acos(-1.0);

TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  TriangleMesh mesh;
  mesh.vertices = {a, b, c, d};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

TriangleMesh inverted(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto base = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  return a;
}

Mat3 box_inertia(double mass, const Vec3& s) {
  return (mass / 12 * Vec3(s.y() * s.y() + s.z() * s.z(), s.z() * s.z() + s.x() * s.x(), s.x() * s.x() + s.y() * s.y()))
      .asDiagonal();
}

bool positive_definite(const Mat3& m) {
  return m.allFinite() && Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues().minCoeff() > 0;
}

}  // namespace

TEST_CASE("mass of a box", "[mass]") {
  const Vec3 size(0.1, 0.2, 0.3);
  const MassProperties m = mass_properties(shapes::box(size, {2, 3, 1}), true, 7800);
  REQUIRE(m.from_volume);
  REQUIRE(m.mass == Approx(7800 * 0.006).epsilon(1e-13));
  REQUIRE(m.center.norm() < 1e-15);
  REQUIRE((m.inertia - box_inertia(m.mass, size)).norm() < 1e-12 * m.inertia.norm());
}

TEST_CASE("mass of moved and turned bodies", "[mass]") {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(-1, 1);
  const Vec3 size(0.1, 0.2, 0.3);
  for (int i = 0; i < 50; ++i) {
    const Pose X{rotation({3 * u(rng), 2 * u(rng), u(rng)}), Vec3(u(rng), u(rng), u(rng))};
    TriangleMesh mesh = shapes::box(size);
    for (Vec3& p : mesh.vertices) p = X * p;
    const MassProperties m = mass_properties(mesh, true);
    const Mat3 R = X.q.toRotationMatrix();
    REQUIRE((m.center - X.p).norm() < 1e-14);
    REQUIRE((m.inertia - R * box_inertia(6.0, size) * R.transpose()).norm() < 1e-12 * m.inertia.norm());
  }
}

TEST_CASE("mass of tetrahedra, by the closed form of their corners", "[mass]") {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 100; ++i) {
    std::array<Vec3, 4> v;
    for (Vec3& p : v) p = Vec3(u(rng), u(rng), u(rng));
    const Vec3 center = (v[0] + v[1] + v[2] + v[3]) / 4;
    const double volume = std::abs((v[1] - v[0]).cross(v[2] - v[0]).dot(v[3] - v[0])) / 6;
    // About its center a tetrahedron weighs like four points of 1/20 of its mass at the corners.
    Mat3 covariance = Mat3::Zero();
    for (const Vec3& p : v) covariance += 1000 * volume / 20 * (p - center) * (p - center).transpose();
    const Mat3 inertia = covariance.trace() * Mat3::Identity() - covariance;
    // Half of them are inside out.
    const MassProperties m = mass_properties(tetrahedron(v[0], v[1], v[2], v[3]), true);
    REQUIRE(m.mass == Approx(1000 * volume).epsilon(1e-10));
    REQUIRE((m.center - center).norm() < 1e-10);
    REQUIRE((m.inertia - inertia).norm() < 1e-10 * inertia.norm());
  }
}

TEST_CASE("mass of round bodies", "[mass]") {
  const int n = 24;
  const double r = 0.02, h = 0.1;
  const MassProperties rod = mass_properties(shapes::cylinder(2 * r, h, n, 3), true);
  const double area = 0.5 * n * r * r * std::sin(2 * kPi / n);
  // Second moment of a regular polygon: A r² (2 + cos(2π/n)) / 12 in any direction of its plane.
  const double second = area * r * r * (2 + std::cos(2 * kPi / n)) / 12;
  const double mass = 1000 * area * h;
  REQUIRE(rod.mass == Approx(mass).epsilon(1e-12));
  REQUIRE(rod.inertia(2, 2) == Approx(1000 * h * 2 * second).epsilon(1e-12));
  REQUIRE(rod.inertia(0, 0) == Approx(1000 * h * second + mass * h * h / 12).epsilon(1e-12));
  REQUIRE(rod.inertia(1, 1) == Approx(rod.inertia(0, 0)).epsilon(1e-12));

  double last = 1;
  for (int k : {16, 32, 64, 128}) {
    const MassProperties ball = mass_properties(shapes::sphere(2 * r, 2 * k, k), true);
    const double m = 1000 * 4.0 / 3 * kPi * r * r * r, inertia = 0.4 * m * r * r;
    const double error = std::abs(ball.inertia(0, 0) / inertia - 1);
    REQUIRE(error < last / 3.5);  // second order in the tessellation
    last = error;
  }
  REQUIRE(last < 1e-3);
}

TEST_CASE("mass of hollow and of inside-out bodies", "[mass]") {
  const Vec3 outer(0.1, 0.2, 0.3), inner(0.02, 0.03, 0.04), at(0.01, -0.02, 0.05);
  const TriangleMesh cavity = inverted(shapes::moved(shapes::box(inner), at));
  const double mo = 1000 * outer.prod(), mi = 1000 * inner.prod();
  const Vec3 center = -mi * at / (mo - mi);
  const auto shifted = [](const Mat3& inertia, double m, const Vec3& d) {
    return Mat3(inertia + m * (d.squaredNorm() * Mat3::Identity() - d * d.transpose()));
  };
  const Mat3 inertia = shifted(box_inertia(mo, outer), mo, center) - shifted(box_inertia(mi, inner), mi, at - center);
  const TriangleMesh hollow = joined(shapes::box(outer), cavity);
  for (const TriangleMesh& mesh : {hollow, inverted(hollow)}) {
    const MassProperties m = mass_properties(mesh, true);
    REQUIRE(m.from_volume);
    REQUIRE(m.mass == Approx(mo - mi).epsilon(1e-12));
    REQUIRE((m.center - center).norm() < 1e-14);
    REQUIRE((m.inertia - inertia).norm() < 1e-12 * inertia.norm());
  }
}

TEST_CASE("open, flat and folded surfaces get the box's mass", "[mass]") {
  TriangleMesh open = shapes::box({0.1, 0.2, 0.3});
  open.triangles.pop_back();
  const MassProperties m = mass_properties(open, false);
  REQUIRE(!m.from_volume);
  REQUIRE(m.mass == Approx(6.0));
  REQUIRE((m.inertia - box_inertia(6.0, {0.1, 0.2, 0.3})).norm() < 1e-12 * m.inertia.norm());

  TriangleMesh flat;
  flat.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  flat.triangles = {{0, 1, 2}};
  const MassProperties f = mass_properties(flat, false);
  REQUIRE(f.mass == Approx(1000 * 0.01));
  REQUIRE((f.center - Vec3(1.0 / 3, 1.0 / 3, 1)).norm() < 1e-15);
  REQUIRE(positive_definite(f.inertia));

  TriangleMesh line = flat;
  line.vertices[2] = {2, 0, 1};
  REQUIRE(positive_definite(mass_properties(line, false).inertia));

  // Both sides of a triangle: closed, without a volume.
  TriangleMesh folded = flat;
  folded.triangles.push_back({0, 2, 1});
  const MassProperties two = mass_properties(folded, true);
  REQUIRE(!two.from_volume);
  REQUIRE(positive_definite(two.inertia));
}
