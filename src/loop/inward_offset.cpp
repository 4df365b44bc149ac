#include "loop/inward_offset.hpp"

#include <algorithm>

#include "lp/least_distance.hpp"

namespace tegotae {
namespace {

// A vertex goes no farther than this many times what its faces go.
constexpr double kFarthestMoved = 10;

int most_faces(const Topology& topology) {
  std::uint32_t most = 0;
  for (std::size_t v = 0; v + 1 < topology.vertex_face_begin.size(); ++v)
    most = std::max(most, topology.vertex_face_begin[v + 1] - topology.vertex_face_begin[v]);
  return static_cast<int>(most);
}

}  // namespace

TriangleMesh inward_offset(const Surface& surface, double by) {
  const Topology& topology = surface.topology;
  TriangleMesh mesh = *surface.mesh;
  const int most = most_faces(topology);
  LeastDistanceSolver solver(most);
  LowRankMatrix normals(most);
  const std::vector<double> one(static_cast<std::size_t>(most), 1.0);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    normals.clear();
    for (std::uint32_t k = topology.vertex_face_begin[v]; k < topology.vertex_face_begin[v + 1]; ++k) {
      const Vec3& n = topology.face_normals[topology.vertex_faces[k]];
      if (n.isZero(0)) continue;
      Vec6 row = Vec6::Zero();
      row.head<3>() = -n;
      normals.push_row(row);
    }
    if (normals.rows() == 0) continue;
    const QpResult& r = solver.solve(normals, one.data(), Vec6::Zero());
    if (r.status != LpStatus::optimal) continue;
    const Vec3 d = r.z.head<3>();
    mesh.vertices[v] += by * std::min(1.0, kFarthestMoved / d.norm()) * d;
  }
  return mesh;
}

}  // namespace tegotae
