#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// A part of a scene: its index into Scene::parts, whether the part is held or not. After a change of the scene the ids
/// are those of the new one.
struct PartId {
  std::uint32_t index = 0;  ///< into Scene::parts

  bool operator==(PartId other) const noexcept { return index == other.index; }  ///< the same part
  bool operator!=(PartId other) const noexcept { return index != other.index; }  ///< another part
  bool operator<(PartId other) const noexcept { return index < other.index; }    ///< by index
};

/// What a feature of a mesh is.
enum class FeatureKind : std::uint8_t { vertex, edge, face };

/// A vertex, edge or face of a mesh.
struct Feature {
  FeatureKind kind = FeatureKind::vertex;  ///< what it is
  /// Into TriangleMesh::vertices or TriangleMesh::triangles; edges are numbered by the library, the same way each time
  /// for the same mesh.
  std::uint32_t index = 0;

  bool operator==(const Feature& o) const noexcept { return kind == o.kind && index == o.index; }  ///< the same one
  bool operator!=(const Feature& o) const noexcept { return !(*this == o); }                       ///< another one
};

}  // namespace tegotae
