#include "feature/signed_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feature/simplex_distance.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

// Axes of patches are unit vectors and square to each other up to rounding to float; bounds are lowered by this share.
constexpr double kAxisRounding = 1e-5;

/// Lower bound of the squared distance of `p` (from the tree's origin) to a patch.
double squared_bound(const PatchNode& node, const Vec3& p) {
  const Vec3 d = p - node.center_vec();
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double out = std::max(0.0, std::abs(d.dot(node.axis_vec(i))) - double{node.half[i]});
    sum += out * out;
  }
  return (1 - kAxisRounding) * sum;
}

struct Nearest {
  double squared = std::numeric_limits<double>::infinity();
  Vec3 point = Vec3::Zero();
  Feature feature;
};

class Search {
 public:
  Search(const PatchTree& tree, const Surface& surface, const Vec3& p) : tree_(tree), surface_(surface), p_(p) {}

  Nearest run() {
    visit(0, squared_bound(tree_.nodes()[0], p_ - tree_.origin()));
    return best_;
  }

 private:
  void visit(std::uint32_t index, double bound) {
    if (bound >= best_.squared) return;
    const PatchNode& node = tree_.nodes()[index];
    if (node.leaf()) {
      for (std::uint32_t i = 0; i < node.count; ++i) look_at(tree_.order()[node.first + i]);
      return;
    }
    const Vec3 p = p_ - tree_.origin();
    const double first = squared_bound(tree_.nodes()[node.first], p);
    const double second = squared_bound(tree_.nodes()[node.first + 1], p);
    const bool swap = second < first;
    visit(node.first + (swap ? 1 : 0), std::min(first, second));
    visit(node.first + (swap ? 0 : 1), std::max(first, second));
  }

  void look_at(std::uint32_t face) {
    if (surface_.topology.face_normals[face].isZero(0)) return;  // collapsed: its corners belong to others too
    const Feature whole = {FeatureKind::face, face};
    const ClosestPoints c = closest_points({1, {p_}}, corners(surface_, whole));
    if (c.squared_distance < best_.squared)
      best_ = {c.squared_distance, c.b, subfeature(surface_, whole, c.mask_b)};
  }

  const PatchTree& tree_;
  const Surface& surface_;
  const Vec3& p_;
  Nearest best_;
};

/// Angle of `face` at its corner `vertex`.
double angle_at(const Surface& s, std::uint32_t face, std::uint32_t vertex) {
  const auto& t = s.mesh->triangles[face];
  const int k = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
  const Vec3 a = s.mesh->vertices[t[(k + 1) % 3]] - s.mesh->vertices[t[k]];
  const Vec3 b = s.mesh->vertices[t[(k + 2) % 3]] - s.mesh->vertices[t[k]];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Normal, of any length, that tells the side of points nearest to `f`.
Vec3 pseudonormal(const Surface& s, Feature f) {
  const Topology& topology = s.topology;
  if (f.kind == FeatureKind::face) return topology.face_normals[f.index];
  Vec3 n = Vec3::Zero();
  if (f.kind == FeatureKind::edge) {
    for (const std::uint32_t face : topology.edges[f.index].f)
      if (face != kNone) n += topology.face_normals[face];
    return n;
  }
  for (std::uint32_t i = topology.vertex_face_begin[f.index]; i < topology.vertex_face_begin[f.index + 1]; ++i) {
    const std::uint32_t face = topology.vertex_faces[i];
    n += angle_at(s, face, f.index) * topology.face_normals[face];
  }
  return n;
}

}  // namespace

SignedDistance::SignedDistance(const std::shared_ptr<const TriangleMesh>& mesh)
    : tree_(mesh), surface_(mesh), closed_(report(*mesh).closed) {}

double SignedDistance::at(const Vec3& p) const {
  const Nearest nearest = Search(tree_, surface_, p).run();
  const bool inside = (p - nearest.point).dot(pseudonormal(surface_, nearest.feature)) < 0;
  return inside ? -std::sqrt(nearest.squared) : std::sqrt(nearest.squared);
}

}  // namespace tegotae
