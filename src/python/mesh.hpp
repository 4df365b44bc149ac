#pragma once

#include <memory>
#include <utility>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae::python {

/// A mesh in Python. Scenes and arrays share it.
struct Mesh {
  std::shared_ptr<const TriangleMesh> shared;

  explicit Mesh(TriangleMesh mesh) : shared(std::make_shared<const TriangleMesh>(std::move(mesh))) {}
  explicit Mesh(std::shared_ptr<const TriangleMesh> mesh) : shared(std::move(mesh)) {}
};

}  // namespace tegotae::python
