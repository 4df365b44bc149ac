#pragma once

#include <array>

#include "mesh/surface.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Corner points of a feature: 1, 2 or 3 of them.
struct Simplex {
  int size = 0;
  std::array<Vec3, 3> p;
};

/// The corners of `f` (an edge is one of Topology::edges) in the mesh's file frame; an edge's in the order of
/// Topology::Edge::v.
inline Simplex corners(const Surface& s, Feature f) {
  const auto& v = s.mesh->vertices;
  switch (f.kind) {
    case FeatureKind::vertex:
      return {1, {v[f.index]}};
    case FeatureKind::edge: {
      const auto& e = s.topology.edges[f.index].v;
      return {2, {v[e[0]], v[e[1]]}};
    }
    default: {
      const auto& t = s.mesh->triangles[f.index];
      return {3, {v[t[0]], v[t[1]], v[t[2]]}};
    }
  }
}

/// The feature on the corners of `f` that `mask` names (bit k is corner k; not zero).
inline Feature subfeature(const Surface& s, Feature f, unsigned mask) {
  switch (f.kind) {
    case FeatureKind::vertex:
      return f;
    case FeatureKind::edge: {
      const auto& e = s.topology.edges[f.index].v;
      return mask == 3 ? f : Feature{FeatureKind::vertex, e[mask == 1 ? 0 : 1]};
    }
    default: {
      const auto& t = s.mesh->triangles[f.index];
      const auto& e = s.topology.face_edges[f.index];
      switch (mask) {
        case 1:
          return {FeatureKind::vertex, t[0]};
        case 2:
          return {FeatureKind::vertex, t[1]};
        case 4:
          return {FeatureKind::vertex, t[2]};
        case 3:
          return {FeatureKind::edge, e[0]};
        case 6:
          return {FeatureKind::edge, e[1]};
        case 5:
          return {FeatureKind::edge, e[2]};
        default:
          return f;
      }
    }
  }
}

}  // namespace tegotae
