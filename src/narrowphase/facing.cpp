#include "narrowphase/facing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/cache_entry.hpp"
#include "mesh/components.hpp"
#include "mesh/in_use.hpp"
#include "mesh/mesh_key.hpp"
#include "mesh/precision.hpp"
#include "mesh/surface.hpp"
#include "narrowphase/self_contact.hpp"

namespace tegotae {
namespace {

// To be raised whenever the same mesh may be judged otherwise.
constexpr std::uint32_t kSolidBuild = 1;
/// A shell of less volume than this part of its box may be inside out by rounding.
constexpr double kLeastVolume = 1e-9;
/// A ray that passes an edge by less than this part of the faces around is not counted.
constexpr double kGrazing = 1e-9;

struct Shell {
  Eigen::AlignedBox3d box;
  Vec3 first = Vec3::Zero();
  double volume = 0;  ///< signed, m³
};

std::vector<Shell> shells_of(const TriangleMesh& mesh, const Components& parts) {
  std::vector<Shell> all(parts.count);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Shell& shell = all[parts.of[f]];
    const auto& t = mesh.triangles[f];
    if (shell.box.isEmpty()) shell.first = mesh.vertices[t[0]];
    const Vec3 a = mesh.vertices[t[0]] - shell.first, b = mesh.vertices[t[1]] - shell.first,
               c = mesh.vertices[t[2]] - shell.first;
    shell.volume += a.dot(b.cross(c)) / 6;
    for (const std::uint32_t v : t) shell.box.extend(mesh.vertices[v]);
  }
  return all;
}

/// Whether every shell looks outwards, and none may be inside another.
bool face_outwards(const std::vector<Shell>& shells) {
  for (const Shell& s : shells) {
    const double size = s.box.diagonal().norm();
    if (!(s.volume > kLeastVolume * size * size * size)) return false;
    for (const Shell& other : shells)
      if (&other != &s && other.box.contains(s.box)) return false;
  }
  return true;
}

bool any_collapsed(const TriangleMesh& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), is_collapsed);
}

bool bounds_solid(const std::shared_ptr<const TriangleMesh>& shared, const PatchTree& tree) {
  const TriangleMesh& mesh = *shared;
  if (any_collapsed(mesh)) return false;
  const auto surface = cached_surface(shared);
  if (!is_closed(surface->topology)) return false;
  const Components parts = components(mesh, surface->topology);
  return parts.count <= Facing::kMostShells && face_outwards(shells_of(mesh, parts)) &&
         !meets_itself(tree, surface->topology);
}

bool known_to_bound_solid(const std::shared_ptr<const TriangleMesh>& mesh, const PatchTree& tree) {
  if (!has_cache_folder() || tree.order().size() < kMinCached) return bounds_solid(mesh, tree);
  const CacheName name{"solid", kSolidBuild, key_of(*mesh)};
  std::uint64_t answer = 0;
  CacheReader kept(name);
  if (kept.take_value(answer) && kept.done()) return answer == 1;
  answer = bounds_solid(mesh, tree) ? 1 : 0;
  CacheWriter entry(name);
  entry.put_value(answer);
  entry.keep();
  return answer == 1;
}

/// Whether a ray may meet the box of a node.
bool may_meet(const PatchNode& n, const Vec3& from, const Vec3& direction) {
  // The way of the box's center from the ray, against the ball around the box: rays are few.
  const Vec3 p = n.center_vec() - from;
  const double radius2 = double{n.half[0]} * n.half[0] + double{n.half[1]} * n.half[1] + double{n.half[2]} * n.half[2];
  const double along = p.dot(direction);
  const double off2 = along > 0 ? p.squaredNorm() - along * along : p.squaredNorm();
  return off2 <= 1.001 * radius2 + 1e-12 * p.squaredNorm();
}

/// Faces of each node as places in the order of the leaves, and the sum of their normals.
struct Range {
  std::uint32_t begin = 0, end = 0;
  Vec3 sum = Vec3::Zero();
};

Range range_of(const PatchTree& tree, std::size_t i, const std::vector<Vec3>& normals,
               const std::vector<Range>& ranges) {
  const PatchNode& n = tree.nodes()[i];
  Range r;
  if (n.leaf()) {
    r.begin = n.first;
    r.end = n.first + n.count;
    for (std::uint32_t k = r.begin; k < r.end; ++k) r.sum += normals[tree.order()[k]];
    return r;
  }
  const Range &left = ranges[n.first], &right = ranges[n.first + 1];
  if (left.end != right.begin) return r;  // no range, no cone
  return {left.begin, right.end, left.sum + right.sum};
}

}  // namespace

std::shared_ptr<const Facing> Facing::of(const std::shared_ptr<const TriangleMesh>& mesh,
                                         const std::shared_ptr<const PatchTree>& tree) {
  if (mesh->triangles.size() > kMostFaces || !known_to_bound_solid(mesh, *tree)) return nullptr;
  return std::make_shared<const Facing>(tree);
}

std::vector<Vec3> Facing::points_of(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (mesh->triangles.size() > kMostFaces || any_collapsed(*mesh)) return {};
  const auto surface = cached_surface(mesh);
  const Components parts = components(*mesh, surface->topology);
  std::vector<Vec3> points;
  if (parts.count > kMostShells) return points;
  for (const Shell& s : shells_of(*mesh, parts)) points.push_back(s.first);
  return points;
}

Facing::Facing(std::shared_ptr<const PatchTree> tree) : tree_(std::move(tree)), nodes_(tree_->nodes().size()) {
  const auto& order = tree_->order();
  std::vector<Vec3> normals;
  for (std::uint32_t f = 0; f < order.size(); ++f) {
    normals.push_back(normal_of(*tree_, f));
    faces_.push_back(normals.back().isZero() ? NormalCone{} : NormalCone::about(normals.back(), 1));
  }
  std::vector<Range> ranges(nodes_.size());
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Range& r = ranges[i] = range_of(*tree_, i, normals, ranges);
    if (!(r.sum.norm() > 0)) continue;
    const Vec3 axis = r.sum.normalized();
    double least = 1;
    for (std::uint32_t k = r.begin; k < r.end && least > 0; ++k) least = std::min(least, axis.dot(normals[order[k]]));
    nodes_[i] = NormalCone::about(axis, least);
  }
}

bool Facing::outside(const Vec3& p) const noexcept {
  // Directions without meaning; from the second on only where a ray grazes an edge.
  static const std::array<Vec3, 4> kDirections = {Vec3(0.36, 0.48, 0.8), Vec3(-0.6, 0.64, 0.48),
                                                  Vec3(0.28, -0.768, -0.576), Vec3(-0.768, -0.28, 0.576)};
  for (const Vec3& direction : kDirections) {
    bool sure = true;
    const int windings = this->windings(p, direction, sure);
    if (sure) return windings == 0;
  }
  return false;
}

/// How often the surface winds round `p`: faces that the ray leaves by, less those that it enters by.
int Facing::windings(const Vec3& p, const Vec3& direction, bool& sure) const noexcept {
  std::array<std::uint32_t, 128> stack;
  std::size_t count = 0;
  stack[count++] = 0;
  const Vec3 from = p - tree_->origin();
  int out = 0;
  while (count > 0 && sure) {
    const PatchNode& node = tree_->nodes()[stack[--count]];
    if (!may_meet(node, from, direction)) continue;
    if (!node.leaf()) {
      sure = count + 2 <= stack.size();
      if (!sure) break;
      stack[count++] = node.first;
      stack[count++] = node.first + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::uint32_t face = tree_->order()[i];
      std::array<Vec3, 3> v;
      double size = 0;
      for (int k = 0; k < 3; ++k) {
        v[static_cast<std::size_t>(k)] = tree_->corner(face, k) - p;
        size = std::max(size, v[static_cast<std::size_t>(k)].squaredNorm());
      }
      // On which side of each edge the ray passes, and whether the face is ahead.
      std::array<double, 3> side;
      for (std::size_t k = 0; k < 3; ++k) side[k] = direction.dot(v[k].cross(v[(k + 1) % 3]));
      const double least = kGrazing * size;
      const bool left = side[0] > least && side[1] > least && side[2] > least;
      const bool right = side[0] < -least && side[1] < -least && side[2] < -least;
      if (!left && !right) {
        const bool misses = std::any_of(side.begin(), side.end(), [&](double s) { return s > least; }) &&
                            std::any_of(side.begin(), side.end(), [&](double s) { return s < -least; });
        sure = sure && misses;
        continue;
      }
      const double ahead = v[0].dot(v[1].cross(v[2]));  // of the sign of the side for what lies ahead
      sure = sure && std::abs(ahead) > least * std::sqrt(size);
      if ((ahead > 0) == left) out += left ? 1 : -1;
    }
  }
  return out;
}

}  // namespace tegotae
