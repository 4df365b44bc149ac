#include "feature/signed_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "feature/simplex_distance.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

constexpr int kDeepest = 500;
// Boxes are stored in single precision, their axes are unit vectors up to rounding.
constexpr double kBoxRounding = 1 - 1e-5;
// Below this distance (m) the direction to the nearest point is rounding; the feature's normal stands for it.
constexpr double kOnSurface = 1e-9;

int depth(const PatchTree& tree, std::uint32_t node) {
  std::vector<std::pair<std::uint32_t, int>> stack{{node, 1}};
  int deepest = 0;
  while (!stack.empty()) {
    const auto [i, d] = stack.back();
    stack.pop_back();
    deepest = std::max(deepest, d);
    if (tree.nodes()[i].leaf()) continue;
    stack.push_back({tree.nodes()[i].first, d + 1});
    stack.push_back({tree.nodes()[i].first + 1, d + 1});
  }
  return deepest;
}

double corner_angle(const TriangleMesh& mesh, std::uint32_t face, int k) {
  const auto& t = mesh.triangles[face];
  const Vec3 a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
  const Vec3 b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

SignedDistance::SignedDistance(std::shared_ptr<const Surface> surface, std::shared_ptr<const PatchTree> tree)
    : surface_(std::move(surface)), tree_(std::move(tree)) {
  if (depth(*tree_, 0) > kDeepest) throw Error(surface_->mesh->name + ": its hierarchy is too deep");
  const TriangleMesh& mesh = *surface_->mesh;
  const Topology& topology = surface_->topology;
  vertex_normals_.assign(mesh.vertices.size(), Vec3::Zero());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k)
      vertex_normals_[mesh.triangles[f][k]] += corner_angle(mesh, f, k) * topology.face_normals[f];
  vertex_rim_.assign(mesh.vertices.size(), 0);
  for (const Topology::Edge& e : topology.edges)
    if (e.kind == EdgeKind::boundary) vertex_rim_[e.v[0]] = vertex_rim_[e.v[1]] = 1;
}

void SignedDistance::try_face(const Vec3& p, std::uint32_t face, Best& best) const {
  if (surface_->topology.face_normals[face].isZero(0)) return;  // collapsed: its corners belong to others too
  const ClosestPoints c =
      closest_points({1, {p}}, {3, {tree_->corner(face, 0), tree_->corner(face, 1), tree_->corner(face, 2)}});
  if (c.squared_distance < best.squared) best = {c.squared_distance, c.b, face, c.mask_b};
}

double SignedDistance::squared_bound(const Vec3& p, const PatchNode& node) const {
  const Vec3 d = p - tree_->origin() - node.center_vec();
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double out = std::max(0.0, std::abs(d.dot(node.axis_vec(i))) - double{node.half[i]});
    sum += out * out;
  }
  return kBoxRounding * sum;
}

Vec3 SignedDistance::feature_normal(const Best& best, bool& rim) const {
  const Topology& topology = surface_->topology;
  const auto& t = surface_->mesh->triangles[best.face];
  for (int k = 0; k < 3; ++k) {
    if (best.mask == 1u << k) {
      rim = vertex_rim_[t[k]] != 0;
      return vertex_normals_[t[k]];
    }
    const std::uint32_t e = topology.face_edges[best.face][k];
    if (best.mask != ((1u << k) | (1u << (k + 1) % 3)) || e == kNone) continue;
    const Topology::Edge& edge = topology.edges[e];
    rim = edge.kind == EdgeKind::boundary;
    return topology.face_normals[edge.f[0]] + (rim ? Vec3(Vec3::Zero()) : topology.face_normals[edge.f[1]]);
  }
  return topology.face_normals[best.face];
}

SurfacePoint SignedDistance::at(const Vec3& p, std::uint32_t hint) const noexcept {
  Best best;
  best.squared = INFINITY;
  try_face(p, hint, best);
  struct Entry {
    std::uint32_t node;
    double bound;
  };
  std::array<Entry, kDeepest + 2> stack;
  int top = 0;
  stack[top++] = {0, 0};
  while (top > 0) {
    const Entry e = stack[--top];
    if (e.bound >= best.squared) continue;
    const PatchNode& node = tree_->nodes()[e.node];
    if (node.leaf()) {
      for (std::uint32_t i = 0; i < node.count; ++i) try_face(p, tree_->order()[node.first + i], best);
      continue;
    }
    Entry near{node.first, squared_bound(p, tree_->nodes()[node.first])};
    Entry far{node.first + 1, squared_bound(p, tree_->nodes()[node.first + 1])};
    if (near.bound > far.bound) std::swap(near, far);
    stack[top++] = far;
    stack[top++] = near;
  }
  bool rim = false;
  const Vec3 normal = feature_normal(best, rim);
  const Vec3 away = p - best.point;
  SurfacePoint out;
  out.point = best.point;
  out.face = best.face;
  const bool inside = !rim && away.dot(normal) < 0;
  out.distance = (inside ? -1 : 1) * std::sqrt(best.squared);
  out.normal = std::abs(out.distance) > kOnSurface ? Vec3(away / out.distance) : Vec3(normal.normalized());
  return out;
}

}  // namespace tegotae
