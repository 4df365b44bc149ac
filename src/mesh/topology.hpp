#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

inline constexpr std::uint32_t kNone = 0xffffffffu;

/// How the two faces of an edge meet, seen from outside.
enum class EdgeKind : std::uint8_t {
  convex,       ///< they bend away from the viewer, or are folded onto each other
  flat,         ///< coplanar within kFlatAngle
  concave,      ///< they bend towards the viewer
  boundary,     ///< one face only
  non_manifold  ///< more than two faces, or two that turn against each other, or one of the two has no normal
};

/// Half-edge adjacency of a welded mesh. Half-edge h = 3 f + k runs from triangles[f][k] to triangles[f][(k + 1) % 3].
///
/// A *collapsed* face (two corners are one vertex) is not part of it: no walk reaches one, its neighbors are linked to
/// each other. A *sliver* (three corners on a line, see precision.hpp) is linked like any face and has the normal of
/// the face across its longest edge, so that a sliver in a flat region makes no crease.
struct Topology {
  struct Edge {
    std::array<std::uint32_t, 2> v;  ///< end vertices; the half-edge of face f[0] runs from v[0] to v[1]
    std::array<std::uint32_t, 2> f;  ///< faces (f[1] is kNone at a boundary; a non-manifold edge keeps its first two)
    EdgeKind kind;
  };

  std::vector<std::uint32_t> twin;                       ///< 3 F: opposite half-edge, kNone where there is no one
  std::vector<Edge> edges;                               ///< E
  std::vector<std::array<std::uint32_t, 3>> face_edges;  ///< F: edge of half-edge 3 f + k; kNone if collapsed
  std::vector<Vec3> face_normals;                        ///< F: unit, file frame; zero if collapsed (or no one lends)
  std::vector<std::uint32_t> vertex_face_begin;          ///< V + 1: offsets into vertex_faces
  std::vector<std::uint32_t> vertex_faces;               ///< faces around each vertex
  std::vector<std::uint32_t> vertex_edge_begin;          ///< V + 1: offsets into vertex_edges
  std::vector<std::uint32_t> vertex_edges;               ///< edges around each vertex
  std::vector<std::uint8_t> vertex_flat;                 ///< V: all faces around the vertex coplanar, none missing
};

/// Adjacency of `mesh`, which must be welded. Works for any surface; what is not manifold is marked.
Topology build_topology(const TriangleMesh& mesh);

/// Whether every edge joins exactly two faces with the same orientation.
bool is_closed(const Topology& topology);

}  // namespace tegotae
