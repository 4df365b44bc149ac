#include "mesh/t_junctions.hpp"

#include <algorithm>
#include <unsupported/Eigen/BVH>

#include "mesh/precision.hpp"
#include "mesh/topology.hpp"

namespace tegotae {
namespace {

struct Segment {
  std::uint32_t a, b;
  Eigen::AlignedBox3d box;
};

/// Finds a segment that has a vertex between its ends, within `reach`.
struct Search {
  const TriangleMesh& mesh;
  std::uint32_t vertex;
  double reach;
  bool found = false;

  bool intersectVolume(const Eigen::AlignedBox3d& box) const {
    return box.exteriorDistance(mesh.vertices[vertex]) <= reach;
  }
  bool intersectObject(const Segment& s) { return found = found || passes(s); }
  bool passes(const Segment& s) const {
    if (s.a == vertex || s.b == vertex) return false;
    const Vec3 along = mesh.vertices[s.b] - mesh.vertices[s.a], to = mesh.vertices[vertex] - mesh.vertices[s.a];
    const double length = along.norm(), at = length > 0 ? to.dot(along) / length : 0;
    return at > reach && at < length - reach && (to - at / length * along).norm() <= reach;
  }
};

}  // namespace

std::size_t count_t_junctions(const TriangleMesh& mesh) {
  std::vector<Segment> open;
  std::vector<std::uint32_t> ends;
  for (const Topology::Edge& edge : build_topology(mesh).edges) {
    if (edge.f[1] != kNone) continue;
    Eigen::AlignedBox3d box(mesh.vertices[edge.v[0]]);
    open.push_back({edge.v[0], edge.v[1], box.extend(mesh.vertices[edge.v[1]])});
    ends.insert(ends.end(), edge.v.begin(), edge.v.end());
  }
  if (open.empty()) return 0;
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Segment& s : open) boxes.push_back(s.box);
  const Eigen::KdBVH<double, 3, Segment> tree(open.begin(), open.end(), boxes.begin(), boxes.end());
  // What is narrower than a sliver is none.
  const double reach = kSliverSteps * rounding_step(mesh);
  return static_cast<std::size_t>(std::count_if(ends.begin(), ends.end(), [&](std::uint32_t vertex) {
    Search search{mesh, vertex, reach};
    Eigen::BVIntersect(tree, search);
    return search.found;
  }));
}

}  // namespace tegotae
