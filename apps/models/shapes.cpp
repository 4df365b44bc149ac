#include "models/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/numbers.hpp"
#include "models/mesh_builder.hpp"
#include "models/revolved.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::shapes {
namespace {

void require(bool good, const std::string& what) {
  if (!good) throw Error(what);
}

double between(double a, double b, int i, int n) {
  return i == n ? b : a + (b - a) * i / n;
}

}  // namespace

TriangleMesh peg(const Peg& p) {
  const double r = p.diameter / 2;
  require(p.segments >= 3 && p.rings >= 1, "a peg needs at least 3 segments and 1 ring");
  require(p.chamfer >= 0 && p.chamfer < r && p.chamfer < p.length, "a peg's chamfer must be smaller than the peg");
  std::vector<ProfilePoint> profile = {{0, -p.length / 2}};
  if (p.chamfer > 0) profile.push_back({r - p.chamfer, -p.length / 2});
  for (int i = 0; i <= p.rings; ++i) {
    profile.push_back({r, between(-p.length / 2 + p.chamfer, p.length / 2, i, p.rings)});
  }
  profile.push_back({0, p.length / 2});
  return revolved("peg", profile, p.segments);
}

TriangleMesh cylinder(double diameter, double length, int segments, int rings) {
  TriangleMesh mesh = peg({diameter, length, 0, segments, rings});
  mesh.name = "cylinder";
  return mesh;
}

TriangleMesh sphere(double diameter, int segments, int rings) {
  require(diameter > 0 && segments >= 3 && rings >= 2, "a sphere needs a size, 3 segments and 2 rings");
  std::vector<ProfilePoint> profile = {{0, -diameter / 2}};
  for (int i = 1; i < rings; ++i) {
    const double angle = kPi * i / rings;
    profile.push_back({diameter / 2 * std::sin(angle), -diameter / 2 * std::cos(angle)});
  }
  profile.push_back({0, diameter / 2});
  return revolved("sphere", profile, segments);
}

/// Four bottom corners carry the sides and the bottom of a block with the outline `top`: of every side's top edge, half
/// fans to each of its corners.
void close_block(MeshBuilder& b, const Block& p, const Ring& top) {
  const int side = p.segments / 4, half = p.segments / 8;
  std::array<std::uint32_t, 4> corner;
  for (int c = 0; c < 4; ++c) {
    const double x = c == 0 || c == 3 ? 1 : -1, y = c < 2 ? 1 : -1;
    corner[c] = b.vertex({x * p.size.x() / 2, y * p.size.y() / 2, -p.size.z()});
  }
  for (int c = 0; c < 4; ++c) {
    const auto at = [&](int i) { return top[static_cast<std::size_t>((half + c * side + i) % p.segments)]; };
    const std::uint32_t left = corner[c], right = corner[(c + 1) % 4];
    for (int i = 0; i < side; ++i) b.face(at(i + 1), at(i), i < half ? left : right);
    b.face(at(half), left, right);
  }
  b.face(corner[0], corner[2], corner[1]);
  b.face(corner[0], corner[3], corner[2]);
}

TriangleMesh block_with_hole(const Block& p) {
  const double stretch = 1 / std::cos(kPi / p.segments);  // corner radius of a circumscribed polygon of radius 1
  const double r = p.hole_diameter / 2 * stretch;
  const double rim = (p.hole_diameter / 2 + p.chamfer) * stretch;
  const double floor = p.through ? -p.size.z() : -p.depth;
  require(p.segments >= 8 && p.segments % 8 == 0, "a hole's number of segments must be a multiple of 8");
  require(p.rings >= 1, "a hole needs at least 1 ring");
  require(p.hole_diameter > 0 && 2 * rim < p.size.head<2>().minCoeff(), "the hole does not fit into its block");
  require(p.chamfer >= 0 && p.chamfer < -floor, "the chamfer is deeper than the hole");
  require(p.through || (p.depth > 0 && p.depth < p.size.z()), "a blind hole must be less deep than its block");

  MeshBuilder b("block with hole");
  // The outline has a corner for each of the hole's, straight outward (in the square's own measure, so that the eighth
  // ones are the block's corners).
  const auto outline = [&](double z) {
    Ring out;
    for (int i = 0; i < p.segments; ++i) {
      const double x = std::cos(2 * kPi * i / p.segments), y = std::sin(2 * kPi * i / p.segments);
      const bool diagonal = i % (p.segments / 4) == p.segments / 8;
      const double largest = std::max(std::abs(x), std::abs(y));
      const double u = diagonal ? std::copysign(1.0, x) : x / largest;
      const double v = diagonal ? std::copysign(1.0, y) : y / largest;
      out.push_back(b.vertex({u * p.size.x() / 2, v * p.size.y() / 2, z}));
    }
    return out;
  };
  const Ring top = outline(0);
  Ring ring = b.ring(rim, 0, p.segments);
  b.band(top, ring);
  if (p.chamfer > 0) {
    Ring lower = b.ring(r, -p.chamfer, p.segments);
    b.band(ring, lower);
    ring = std::move(lower);
  }
  for (int i = 1; i <= p.rings; ++i) {
    Ring lower = b.ring(r, between(-p.chamfer, floor, i, p.rings), p.segments);
    b.band(ring, lower);
    ring = std::move(lower);
  }
  if (p.through) {
    const Ring bottom = outline(-p.size.z());
    b.band(ring, bottom);
    b.band(bottom, top);
    return b.take();
  }
  b.disk(ring, b.vertex({0, 0, floor}));

  close_block(b, p, top);
  return b.take();
}

TriangleMesh box(const Vec3& size, const std::array<int, 3>& parts) {
  require(size.minCoeff() > 0 && parts[0] > 0 && parts[1] > 0 && parts[2] > 0, "a box needs a size in all directions");
  MeshBuilder b("box");
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int sign : {-1, 1}) {
      std::vector<Ring> rows;
      for (int i = 0; i <= parts[u]; ++i) {
        Ring row;
        for (int j = 0; j <= parts[v]; ++j) {
          Vec3 p;
          p[axis] = sign * size[axis] / 2;
          p[u] = between(-size[u] / 2, size[u] / 2, i, parts[u]);
          p[v] = between(-size[v] / 2, size[v] / 2, j, parts[v]);
          row.push_back(b.vertex(p));
        }
        rows.push_back(row);
      }
      for (int i = 0; i < parts[u]; ++i) {
        for (int j = 0; j < parts[v]; ++j) {
          std::array<std::uint32_t, 4> q = {rows[i][j], rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]};
          if (sign < 0) std::swap(q[1], q[3]);
          b.face(q[0], q[1], q[2]);
          b.face(q[0], q[2], q[3]);
        }
      }
    }
  }
  // The sides' rims have bit-equal vertices.
  return weld(b.take());
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& d) {
  for (Vec3& p : mesh.vertices) p += d;
  return mesh;
}

}  // namespace tegotae::shapes
