#include "tegotae/mesh/report.hpp"

#include <algorithm>

#include "mesh/components.hpp"
#include "mesh/inverted_shells.hpp"
#include "mesh/precision.hpp"
#include "mesh/topology.hpp"

namespace tegotae {
namespace {

std::size_t count_duplicates(const TriangleMesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> faces;
  faces.reserve(mesh.triangles.size());
  for (auto t : mesh.triangles) {
    if (is_collapsed(t)) continue;
    std::sort(t.begin(), t.end());
    faces.push_back(t);
  }
  std::sort(faces.begin(), faces.end());
  return faces.size() - static_cast<std::size_t>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

}  // namespace

MeshReport report(const TriangleMesh& mesh) {
  const Topology topology = build_topology(mesh);
  MeshReport out;
  out.vertices = mesh.vertices.size();
  out.triangles = mesh.triangles.size();
  const Components shells = components(mesh, topology);
  out.components = shells.count;
  out.duplicate_faces = count_duplicates(mesh);

  const double step = rounding_step(mesh);
  for (const auto& t : mesh.triangles) out.degenerate_faces += is_degenerate(mesh, t, step);
  // By the faces that meet, not by the kind: next to a sliver without a normal the kind says non_manifold.
  for (std::uint32_t e = 0; e < topology.edges.size(); ++e) {
    const Topology::Edge& edge = topology.edges[e];
    if (edge.f[1] == kNone) {
      ++out.boundary_edges;
      continue;
    }
    const auto& around = topology.face_edges[edge.f[0]];
    const auto k = static_cast<std::uint32_t>(std::find(around.begin(), around.end(), e) - around.begin());
    if (topology.twin[3 * edge.f[0] + k] == kNone) ++out.non_manifold_edges;
  }
  out.closed = is_closed(topology);
  out.inverted_shells = count_inverted_shells(mesh, shells, open_components(topology, shells));

  if (!mesh.vertices.empty()) out.box_min = out.box_max = mesh.vertices[0];
  for (const Vec3& p : mesh.vertices) {
    out.box_min = out.box_min.cwiseMin(p);
    out.box_max = out.box_max.cwiseMax(p);
  }
  return out;
}

}  // namespace tegotae
