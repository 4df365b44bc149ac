#include "feature/signed_distance.hpp"

#include <cmath>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Below this distance (m) the direction to the nearest point is rounding; the feature's normal stands for it.
constexpr double kOnSurface = 1e-9;

double corner_angle(const TriangleMesh& mesh, std::uint32_t face, int k) {
  const auto& t = mesh.triangles[face];
  const Vec3 a = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
  const Vec3 b = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

SignedDistance::SignedDistance(std::shared_ptr<const Surface> surface, std::shared_ptr<const PatchTree> tree)
    : surface_(surface), nearest_(std::move(surface), std::move(tree)) {
  if (!nearest_.complete()) throw Error(surface_->mesh->name + ": its hierarchy is too deep");
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

Vec3 SignedDistance::feature_normal(const NearFace& best, bool& rim) const {
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
  NearFace best;
  best.squared = INFINITY;
  nearest_.try_face(p, hint, best);
  nearest_.find(p, best, [](std::uint32_t) { return true; });
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
