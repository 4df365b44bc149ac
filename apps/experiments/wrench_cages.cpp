#include "experiments/wrench_cages.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include "models/random_bodies.hpp"
#include "models/shapes.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/mass.hpp"

namespace tegotae::experiments {
namespace {

constexpr int kPlanes = 6;
constexpr double kCagePlay = 1e-4;  // m, of every corner from its plane
constexpr double kGap = 2e-6;       // m, what contacts keep
constexpr double kFlat = 0.05;  // a corner is the only one near a plane when the others are so much of the size farther
constexpr int kMaxSteps = 100;
constexpr double kMinForce = 0.3;  // N
constexpr double kMinArm = 0.1;    // of the torque, by the size

/// A plane that a corner of the part may not pass: n · x >= height.
struct Wall {
  std::size_t corner;
  Vec3 n;
  double height;
};

using Row = Eigen::Matrix<double, 1, 6>;

/// Of ½ |d - e|² in the metric diag(1, 1, 1, ρ², ρ², ρ²), with J d >= b, the least: every set of rows is tried.
std::optional<Vec6> least(const std::vector<Row>& J, const std::vector<double>& b, const Vec6& e, double radius2) {
  Vec6 inverse;
  inverse << Vec3::Ones(), Vec3::Constant(1 / radius2);
  std::optional<Vec6> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (unsigned set = 0; set < 1u << J.size(); ++set) {
    std::vector<std::size_t> in;
    for (std::size_t i = 0; i < J.size(); ++i)
      if (set >> i & 1u) in.push_back(i);
    const auto n = static_cast<Eigen::Index>(in.size());
    Eigen::MatrixXd A(n, 6);
    Eigen::VectorXd c(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      A.row(k) = J[in[static_cast<std::size_t>(k)]];
      c[k] = b[in[static_cast<std::size_t>(k)]];
    }
    Vec6 d = e;
    if (n > 0) {
      const Eigen::FullPivLU<Eigen::MatrixXd> lu(A * inverse.asDiagonal() * A.transpose());
      if (lu.rank() < n) continue;
      d += inverse.asDiagonal() * A.transpose() * lu.solve(c - A * e);
    }
    bool allowed = true;
    for (std::size_t i = 0; i < J.size(); ++i) allowed &= (J[i] * d)(0) >= b[i] - 1e-12;
    const double cost = (d - e).dot(inverse.cwiseInverse().cwiseProduct(d - e));
    if (!allowed || cost >= lowest) continue;
    lowest = cost;
    best = d;
  }
  return best;
}

/// Where the part rests for the pen at `Y`; nothing when it finds no rest, or another corner would pass a wall.
std::optional<Pose> rest(const TriangleMesh& mesh, const std::vector<Wall>& walls, const Pose& Y, double radius2) {
  Pose X;
  for (int step = 0; step < kMaxSteps; ++step) {
    std::vector<Row> J;
    std::vector<double> b;
    for (const Wall& w : walls) {
      const Vec3 r = X.q * mesh.vertices[w.corner];
      Row row;
      row << w.n.transpose(), r.cross(w.n).transpose();
      J.push_back(row);
      b.push_back(w.height + kGap - w.n.dot(X.p + r));
    }
    const Displacement error = displacement(X, Y, Vec3::Zero());
    Vec6 e;
    e << error.dp, error.dr;
    const std::optional<Vec6> d = least(J, b, e, radius2);
    if (!d) return std::nullopt;
    X = displaced(X, Vec3::Zero(), {d->head<3>(), d->tail<3>()});
    if (d->norm() > 1e-12) continue;
    for (const Wall& w : walls)
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
        if (i != w.corner && w.n.dot(X * mesh.vertices[i]) < w.height + kCagePlay / 2) return std::nullopt;
    return X;
  }
  return std::nullopt;
}

/// Six walls before corners of the part, and whether no other corner is near any of them.
std::vector<Wall> random_walls(const TriangleMesh& mesh, double size, std::mt19937& rng) {
  std::vector<Wall> walls;
  while (walls.size() < kPlanes) {
    const Vec3 n = shapes::random_direction(rng);
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      if (n.dot(mesh.vertices[i]) < n.dot(mesh.vertices[lowest])) lowest = i;
    bool alone = true;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      alone &= i == lowest || n.dot(mesh.vertices[i] - mesh.vertices[lowest]) > kFlat * size;
    if (alone) walls.push_back({lowest, n, n.dot(mesh.vertices[lowest]) - kCagePlay});
  }
  return walls;
}

TriangleMesh centered(TriangleMesh mesh, double size) {
  const Vec3 center = mass_properties(mesh, true).center;
  double radius = 0;
  for (const Vec3& v : mesh.vertices) radius = std::max(radius, (v - center).norm());
  for (Vec3& v : mesh.vertices) v = size / radius * (v - center);
  return mesh;
}

TriangleMesh bar() {
  return shapes::box({1, 0.3, 0.2}, {1, 1, 1});
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0.1, 0.05, -1}, {1.1, -0.2, 0.4}, {-0.5, 0.9, 0.35}, {-0.7, -0.75, 0.25}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  return mesh;
}

/// An L of unequal legs, extruded.
TriangleMesh angle() {
  TriangleMesh mesh;
  for (const double z : {0.0, 0.25})
    for (const auto& [x, y] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 0.3}, {0.2, 0.3}, {0.2, 0.7}, {0.0, 0.7}})
      mesh.vertices.push_back({x, y, z});
  const std::array<std::array<std::uint32_t, 3>, 4> cap = {{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}};
  for (const auto& [a, b, c] : cap) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + 6, b + 6, c + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t k = (i + 1) % 6;
    mesh.triangles.push_back({i, k, k + 6});
    mesh.triangles.push_back({i, k + 6, i + 6});
  }
  return mesh;
}

WrenchScene cage(const std::string& name, const TriangleMesh& shape, double size, int probes, unsigned seed) {
  WrenchScene w{name, "min ½ Eᵀ K E over all sets of corners on their planes", {}, {}};
  std::mt19937 rng(seed);
  const TriangleMesh mesh = weld(centered(shape, size));
  const std::vector<Wall> walls = random_walls(mesh, size, rng);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    // A slab whose face is the plane, wide enough for the part wherever it goes.
    const double side = 8 * size, thick = size;
    const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), walls[i].n);
    const Vec3 foot = mesh.vertices[walls[i].corner] - kCagePlay * walls[i].n;
    w.scene.parts.push_back({"plane" + std::to_string(i),
                             std::make_shared<const TriangleMesh>(weld(shapes::box({side, side, thick}, {1, 1, 1}))),
                             {q, foot - 0.5 * thick * walls[i].n},
                             false});
  }
  w.scene.contact.l_min = 2 * kGap;
  w.scene.parts.push_back({"held", std::make_shared<const TriangleMesh>(mesh), {}, true});
  CouplingSettings& k = w.scene.coupling;
  k.torsional_stiffness = fitted_torsional_stiffness(k.stiffness, radius_of_gyration(mass_properties(mesh, true)), 1e3);
  const double radius2 = k.torsional_stiffness / k.stiffness;
  while (static_cast<int>(w.probes.size()) < probes) {
    const double push = std::min(3e-3, 0.3 * size), turn = std::min(0.1, 2e-3 / size);
    const Pose Y{rotation(shapes::random_vector(rng, turn)), push * shapes::random_direction(rng)};
    const std::optional<Pose> X = rest(mesh, walls, Y, radius2);
    if (!X) continue;
    const Displacement d = displacement(Y, *X, Vec3::Zero());
    const Wrench expected{k.stiffness * d.dp, k.torsional_stiffness * d.dr};
    // Of less nothing would be left above the gap that contacts keep, and a torque of nearly nothing has no direction.
    const double force = expected.force.norm(), torque = expected.torque.norm();
    if (force > kMinForce && torque > kMinArm * size * force) w.probes.push_back({Y, expected});
  }
  return w;
}

}  // namespace

std::vector<WrenchScene> cage_scenes(int probes) {
  std::vector<WrenchScene> all;
  unsigned seed = 1;
  const std::pair<const char*, TriangleMesh> shapes[] = {
      {"bar", bar()}, {"L", angle()}, {"tetrahedron", tetrahedron()}};
  for (const auto& [name, mesh] : shapes)
    for (const double size : {0.002, 0.03, 0.5})
      all.push_back(cage(std::string(name) + " of " + std::to_string(static_cast<int>(2e3 * size)) + " mm in a cage",
                         mesh, size, probes, seed++));
  return all;
}

}  // namespace tegotae::experiments
