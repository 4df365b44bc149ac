#include "mesh/topology.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/precision.hpp"
#include "tegotae/core/constants.hpp"

namespace tegotae {
namespace {

std::uint32_t next(std::uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
std::uint32_t tail(const TriangleMesh& mesh, std::uint32_t h) {
  return mesh.triangles[h / 3][h % 3];
}
std::uint32_t head(const TriangleMesh& mesh, std::uint32_t h) {
  return tail(mesh, next(h));
}

/// Unit normals; zero for degenerate faces.
std::vector<Vec3> own_normals(const TriangleMesh& mesh) {
  const double step = rounding_step(mesh);
  std::vector<Vec3> normals(mesh.triangles.size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto& t = mesh.triangles[f];
    if (is_degenerate(mesh, t, step)) continue;
    const Vec3& a = mesh.vertices[t[0]];
    normals[f] = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
  }
  return normals;
}

/// Finds edges and twins. Half-edges are filed by their lower vertex, then sorted by the other one: linear but for the
/// sort of each vertex's few edges.
void link_half_edges(const TriangleMesh& mesh, Topology& topology) {
  const auto half_edges = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  const auto lower = [&](std::uint32_t h) { return std::min(tail(mesh, h), head(mesh, h)); };
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 1, 0);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    if (!is_collapsed(mesh.triangles[h / 3])) ++begin[lower(h) + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];

  struct Entry {
    std::uint32_t upper, h;
    bool operator<(const Entry& o) const { return upper != o.upper ? upper < o.upper : h < o.h; }
  };
  std::vector<Entry> entries(begin.back());
  std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
  for (std::uint32_t h = 0; h < half_edges; ++h) {
    if (is_collapsed(mesh.triangles[h / 3])) continue;
    entries[fill[lower(h)]++] = {std::max(tail(mesh, h), head(mesh, h)), h};
  }

  topology.twin.assign(half_edges, kNone);
  topology.face_edges.assign(mesh.triangles.size(), {kNone, kNone, kNone});
  topology.edges.reserve(entries.size() / 2 + 1);
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(entries.begin() + begin[v], entries.begin() + begin[v + 1]);
    for (std::uint32_t i = begin[v], j = i; i < begin[v + 1]; i = j) {
      while (j < begin[v + 1] && entries[j].upper == entries[i].upper) ++j;
      const std::uint32_t h = entries[i].h;
      const std::uint32_t other = j - i > 1 ? entries[i + 1].h : kNone;
      Topology::Edge edge{{tail(mesh, h), head(mesh, h)}, {h / 3, kNone}, EdgeKind::boundary};
      if (other != kNone) {
        edge.f[1] = other / 3;
        edge.kind = EdgeKind::non_manifold;
        if (j - i == 2 && tail(mesh, other) == edge.v[1]) {
          edge.kind = EdgeKind::flat;  // until classify() has the normals
          topology.twin[h] = other;
          topology.twin[other] = h;
        }
      }
      const auto id = static_cast<std::uint32_t>(topology.edges.size());
      for (std::uint32_t k = i; k < j; ++k) topology.face_edges[entries[k].h / 3][entries[k].h % 3] = id;
      topology.edges.push_back(edge);
    }
  }
}

/// Gives every sliver the normal of the face across its longest edge, through chains of slivers too: a sliver in a seam
/// then bends nothing, and the true angle stays on its other long edge.
void borrow_normals(const TriangleMesh& mesh, Topology& topology) {
  const auto lender_of = [&](std::uint32_t f) {
    std::uint32_t longest = 3 * f;
    double length = -1;
    for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
      const double l = (mesh.vertices[head(mesh, h)] - mesh.vertices[tail(mesh, h)]).squaredNorm();
      if (l > length) {
        length = l;
        longest = h;
      }
    }
    const std::uint32_t twin = topology.twin[longest];
    return twin == kNone ? kNone : twin / 3;
  };
  std::vector<std::uint32_t> chain;
  for (std::uint32_t start = 0; start < mesh.triangles.size(); ++start) {
    if (!topology.face_normals[start].isZero(0) || is_collapsed(mesh.triangles[start])) continue;
    // Two slivers can be each other's lenders; a chain with no end in sight borrows nothing.
    constexpr std::size_t kLongestChain = 64;
    chain.assign(1, start);
    std::uint32_t f = lender_of(start);
    while (f != kNone && topology.face_normals[f].isZero(0) && chain.size() < kLongestChain) {
      chain.push_back(f);
      f = lender_of(f);
    }
    if (f == kNone || topology.face_normals[f].isZero(0)) continue;
    for (const std::uint32_t sliver : chain) topology.face_normals[sliver] = topology.face_normals[f];
  }
}

/// The kind of the manifold edge `edge`.
EdgeKind classify(const TriangleMesh& mesh, const Topology& topology, const Topology::Edge& edge) {
  const Vec3& n0 = topology.face_normals[edge.f[0]];
  const Vec3& n1 = topology.face_normals[edge.f[1]];
  if (n0.isZero(0) || n1.isZero(0)) return EdgeKind::non_manifold;
  const Vec3 cross = n0.cross(n1);
  const double sine = cross.norm();
  const bool folded = n0.dot(n1) < 0;
  if (sine < kFlatAngle) return folded ? EdgeKind::convex : EdgeKind::flat;
  return cross.dot(mesh.vertices[edge.v[1]] - mesh.vertices[edge.v[0]]) > 0 ? EdgeKind::convex : EdgeKind::concave;
}

/// Lists per vertex (CSR) of the items whose corners `corners(i)` name it.
template <class Corners>
void list_by_vertex(std::size_t vertices, std::size_t items, const Corners& corners, std::vector<std::uint32_t>& begin,
                    std::vector<std::uint32_t>& list) {
  begin.assign(vertices + 1, 0);
  for (std::size_t i = 0; i < items; ++i) {
    for (const std::uint32_t v : corners(i)) ++begin[v + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  list.resize(begin.back());
  std::vector<std::uint32_t> fill(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < items; ++i) {
    for (const std::uint32_t v : corners(i)) list[fill[v]++] = static_cast<std::uint32_t>(i);
  }
}

bool is_flat(const Topology& topology, std::size_t v) {
  const std::uint32_t begin = topology.vertex_face_begin[v], end = topology.vertex_face_begin[v + 1];
  if (begin == end) return false;
  for (std::uint32_t i = topology.vertex_edge_begin[v]; i < topology.vertex_edge_begin[v + 1]; ++i) {
    if (topology.edges[topology.vertex_edges[i]].kind != EdgeKind::flat) return false;
  }
  const Vec3& n = topology.face_normals[topology.vertex_faces[begin]];
  for (std::uint32_t i = begin; i < end; ++i) {
    const Vec3& m = topology.face_normals[topology.vertex_faces[i]];
    if (n.dot(m) < 0 || n.cross(m).norm() >= kFlatAngle) return false;
  }
  return true;
}

}  // namespace

Topology build_topology(const TriangleMesh& mesh) {
  Topology topology;
  topology.face_normals = own_normals(mesh);
  link_half_edges(mesh, topology);
  borrow_normals(mesh, topology);
  for (Topology::Edge& edge : topology.edges) {
    if (edge.kind == EdgeKind::flat) edge.kind = classify(mesh, topology, edge);
  }

  const std::size_t vertices = mesh.vertices.size();
  // A collapsed face lists no corners.
  std::vector<std::uint32_t> real_faces;
  real_faces.reserve(mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!is_collapsed(mesh.triangles[f])) real_faces.push_back(f);
  }
  list_by_vertex(
      vertices, real_faces.size(), [&](std::size_t i) { return mesh.triangles[real_faces[i]]; },
      topology.vertex_face_begin, topology.vertex_faces);
  for (std::uint32_t& f : topology.vertex_faces) f = real_faces[f];
  list_by_vertex(
      vertices, topology.edges.size(), [&](std::size_t e) { return topology.edges[e].v; }, topology.vertex_edge_begin,
      topology.vertex_edges);
  topology.vertex_flat.resize(vertices);
  for (std::size_t v = 0; v < vertices; ++v) topology.vertex_flat[v] = is_flat(topology, v) ? 1 : 0;
  return topology;
}

bool is_closed(const Topology& topology) {
  for (std::size_t h = 0; h < topology.twin.size(); ++h)
    if (topology.twin[h] == kNone && topology.face_edges[h / 3][h % 3] != kNone) return false;
  return !topology.edges.empty();
}

}  // namespace tegotae
