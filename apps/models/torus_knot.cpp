#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/numbers.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {

TriangleMesh torus_knot(const Knot& k) {
  if (k.along < 3 || k.around < 3) throw Error("a knot needs at least 3 divisions along and around");
  if (std::gcd(k.p, k.q) != 1) throw Error("a knot's p and q must be coprime");
  TriangleMesh mesh;
  mesh.name = "torus knot";
  for (int i = 0; i < k.along; ++i) {
    const double t = 2 * kPi * i / k.along;
    const double a = k.p * t, b = k.q * t;  // angle about z, angle about the torus' circle
    const Vec3 radial(std::cos(a), std::sin(a), 0), tangential(-std::sin(a), std::cos(a), 0);
    // The torus' normal closes after one round, so the tube's frame, built on it, does too.
    const Vec3 normal = std::cos(b) * radial + std::sin(b) * Vec3::UnitZ();
    const Vec3 minor = -std::sin(b) * radial + std::cos(b) * Vec3::UnitZ();
    const Vec3 center = k.radius * radial + k.tube_radius * normal;
    const Vec3 tangent =
        (k.p * (k.radius + k.tube_radius * std::cos(b)) * tangential + k.q * k.tube_radius * minor).normalized();
    const Vec3 binormal = tangent.cross(normal);
    for (int j = 0; j < k.around; ++j) {
      const double c = 2 * kPi * j / k.around;
      mesh.vertices.push_back(center + k.thickness / 2 * (std::cos(c) * normal + std::sin(c) * binormal));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % k.along) * k.around + j % k.around); };
  for (int i = 0; i < k.along; ++i) {
    for (int j = 0; j < k.around; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

}  // namespace tegotae::shapes
