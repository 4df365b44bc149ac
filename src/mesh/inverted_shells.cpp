#include "mesh/inverted_shells.hpp"

#include <cmath>
#include <vector>

namespace tegotae {
namespace {

struct Shell {
  Eigen::AlignedBox3d box;
  double volume = 0;  ///< signed, m³
  std::vector<std::uint32_t> faces;
};

Vec3 corner(const TriangleMesh& mesh, std::uint32_t face, int k) {
  return mesh.vertices[mesh.triangles[face][static_cast<std::size_t>(k)]];
}

/// Whether `shell` winds round `p`: the solid angle of a triangle (van Oosterom and Strackee 1983), summed up.
bool winds_round(const TriangleMesh& mesh, const Shell& shell, const Vec3& p) {
  double angle = 0;
  for (const std::uint32_t f : shell.faces) {
    const Vec3 a = corner(mesh, f, 0) - p, b = corner(mesh, f, 1) - p, c = corner(mesh, f, 2) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(angle) > 2 * 3.14159265358979323846;  // half of a whole sphere
}

}  // namespace

std::size_t count_inverted_shells(const TriangleMesh& mesh, const Components& shells, const std::vector<bool>& open) {
  std::vector<Shell> all(shells.count);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (shells.of[f] == kNone) continue;
    Shell& shell = all[shells.of[f]];
    const Vec3 a = corner(mesh, f, 0), b = corner(mesh, f, 1), c = corner(mesh, f, 2);
    shell.box.extend(a).extend(b).extend(c);
    shell.volume += a.dot(b.cross(c)) / 6;
    shell.faces.push_back(f);
  }
  std::size_t inverted = 0;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (open[s]) continue;
    const Shell& shell = all[s];
    const std::uint32_t f = shell.faces.front();
    const Vec3 p = (corner(mesh, f, 0) + corner(mesh, f, 1) + corner(mesh, f, 2)) / 3;
    std::size_t around = 0;
    bool unsure = false;
    for (std::size_t o = 0; o < all.size() && !unsure; ++o) {
      if (o == s || !all[o].box.contains(shell.box) || !winds_round(mesh, all[o], p)) continue;
      ++around;
      unsure = open[o];
    }
    inverted += !unsure && (around % 2 == 1) == (shell.volume > 0);
  }
  return inverted;
}

}  // namespace tegotae
