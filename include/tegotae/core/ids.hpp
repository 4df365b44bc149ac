#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Identifies a part of a scene, held or fixed, by its index into Scene::parts. After a scene change, ids refer to the
/// new scene.
struct PartId {
  std::uint32_t index = 0;  ///< into Scene::parts

  bool operator==(PartId other) const noexcept { return index == other.index; }  ///< the same part
  bool operator!=(PartId other) const noexcept { return index != other.index; }  ///< another part
  bool operator<(PartId other) const noexcept { return index < other.index; }    ///< by index
};

/// Kind of a mesh feature.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// A vertex, edge or face of a mesh.
struct Feature {
  FeatureKind kind = FeatureKind::vertex;  ///< vertex, edge or face
  /// Index into TriangleMesh::vertices or TriangleMesh::triangles. The library numbers the edges itself, always in the
  /// same way for the same mesh.
  std::uint32_t index = 0;

  bool operator==(const Feature& o) const noexcept { return kind == o.kind && index == o.index; }  ///< the same one
  bool operator!=(const Feature& o) const noexcept { return !(*this == o); }                       ///< another one
};

}  // namespace tegotae
