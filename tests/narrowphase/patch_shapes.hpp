// Small procedural meshes for the tests and the benchmark of the patch front.
#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::test {

using MeshPtr = std::shared_ptr<const TriangleMesh>;
inline constexpr double kPi = 3.14159265358979323846;

/// A surface of revolution about z through the profile points (r, z), `n` facets around; r = 0 closes to a point.
inline MeshPtr revolve(const std::vector<std::pair<double, double>>& profile, int n) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "revolved";
  std::vector<std::vector<std::uint32_t>> ring;
  for (const auto& [r, z] : profile) {
    ring.emplace_back();
    for (int i = 0; i < n; ++i) {
      if (r > 0 || i == 0) {
        const double a = 2 * kPi * i / n;
        mesh->vertices.emplace_back(r * std::cos(a), r * std::sin(a), z);
      }
      ring.back().push_back(static_cast<std::uint32_t>(mesh->vertices.size() - 1));
    }
  }
  for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      const auto a = ring[k][i], b = ring[k][j], c = ring[k + 1][j], d = ring[k + 1][i];
      if (a != b) mesh->triangles.push_back({a, b, c});
      if (c != d) mesh->triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

inline void line(std::vector<std::pair<double, double>>& profile, double r, double z, int pieces) {
  const auto [r0, z0] = profile.back();
  for (int i = 1; i <= pieces; ++i) {
    const double s = static_cast<double>(i) / pieces;
    profile.emplace_back(i == pieces ? r : r0 + s * (r - r0), i == pieces ? z : z0 + s * (z - z0));
  }
}

/// Peg of radius r and length l, axis z, from z = 0 up; about `triangles` triangles.
inline MeshPtr peg(double r, double l, int triangles) {
  const int n = std::max(8, static_cast<int>(std::sqrt(0.5 * triangles * 2 * kPi * r / l)));
  const int along = std::max(1, (triangles / n - 2) / 2);
  std::vector<std::pair<double, double>> p{{0, 0}};
  line(p, r, 0, 1);
  line(p, r, l, along);
  line(p, 0, l, 1);
  return revolve(p, n);
}

/// Block (a ring of outer radius 2 r) with a blind hole of inner radius r (across flats) and depth l, mouth at z = 0.
inline MeshPtr hole(double r, double l, int triangles) {
  const int n = std::max(8, static_cast<int>(std::sqrt(0.35 * triangles * 2 * kPi * r / l)));
  const int along = std::max(1, static_cast<int>(0.8 * triangles / n / 2)), rest = std::max(1, along / 8);
  const double inner = r / std::cos(kPi / n);
  std::vector<std::pair<double, double>> p{{0, -l}};
  line(p, inner, -l, rest);
  line(p, inner, 0, along);
  line(p, 2 * r, 0, rest);
  line(p, 2 * r, -1.2 * l, rest);
  line(p, 0, -1.2 * l, 1);
  return revolve(p, n);
}

/// Torus knot (2, 3) of size R with a tube of radius r; about `triangles` triangles.
inline MeshPtr knot(double R, double r, int triangles) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "knot";
  const int around = std::max(6, static_cast<int>(std::sqrt(triangles / 2.0 * r / (2.5 * R)))) | 1;
  const int along = std::max(16, triangles / 2 / around);
  auto curve = [&](double t) {
    const double q = R * (2 + std::cos(3 * t)) / 3;
    return Vec3(q * std::cos(2 * t), q * std::sin(2 * t), -R * std::sin(3 * t) / 3);
  };
  for (int i = 0; i < along; ++i) {
    const double t = 2 * kPi * i / along, h = 1e-4;
    const Vec3 c = curve(t), d = (curve(t + h) - curve(t - h)).normalized();
    const Vec3 u = d.cross(c).normalized(), v = d.cross(u);
    for (int k = 0; k < around; ++k) {
      const double a = 2 * kPi * k / around;
      mesh->vertices.push_back(c + r * (std::cos(a) * u + std::sin(a) * v));
    }
  }
  for (int i = 0; i < along; ++i) {
    for (int k = 0; k < around; ++k) {
      const int i1 = (i + 1) % along, k1 = (k + 1) % around;
      const auto a = static_cast<std::uint32_t>(i * around + k), b = static_cast<std::uint32_t>(i1 * around + k),
                 c = static_cast<std::uint32_t>(i1 * around + k1), d = static_cast<std::uint32_t>(i * around + k1);
      mesh->triangles.push_back({a, b, c});
      mesh->triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

/// One face of a mesh.
inline MeshPtr single(const TriangleMesh& m, std::uint32_t face) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (const std::uint32_t v : m.triangles[face]) mesh->vertices.push_back(m.vertices[v]);
  mesh->triangles.push_back({0, 1, 2});
  return mesh;
}

/// Box with the half extents `h`, 12 triangles.
inline MeshPtr box(const Vec3& h) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh->vertices.emplace_back(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
  }
  const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    mesh->triangles.push_back({q[0], q[1], q[2]});
    mesh->triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

inline double uniform(std::mt19937& rng, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(rng);
}
inline Vec3 random_in_ball(std::mt19937& rng, double size) {
  for (;;) {
    const Vec3 v(uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1));
    if (v.squaredNorm() <= 1) return size * v;
  }
}

/// Random small triangles in a ball: no adjacency, slivers, points and repeated faces among them.
inline MeshPtr soup(std::mt19937& rng, int triangles, double ball, double size) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "soup";
  for (int i = 0; i < triangles; ++i) {
    const Vec3 c = random_in_ball(rng, ball);
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    const Vec3 u = random_in_ball(rng, size),
               v = i % 10 == 0 ? Vec3(1e-9 * random_in_ball(rng, size)) : random_in_ball(rng, size);
    mesh->vertices.insert(mesh->vertices.end(), {c, c + u, i % 25 == 0 ? c : Vec3(c + v)});
    mesh->triangles.push_back({first, first + 1, first + 2});
    if (i % 17 == 0) mesh->triangles.push_back({first + 1, first, first + 2});
  }
  return mesh;
}

}  // namespace tegotae::test
