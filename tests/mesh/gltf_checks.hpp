// What tests of glTF ask of a file.
#pragma once

#include <string>

#include "mesh/assembly_checks.hpp"
#include "mesh/gltf_doc.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::test {

/// glTF's coordinates are floats.
inline void check_near(const Eigen::AlignedBox3d& box, const Vec3& lo, const Vec3& hi) {
  check_box(box, lo, hi, 2e-6);
}

/// The file read both ways: as parts and as one surface, whose boxes must be the same.
inline Assembly read(const std::string& file) {
  AssemblyOptions options;
  options.unit = "m";  // also where the parts stand far from each other
  const Assembly a = read_assembly(file, options);
  Eigen::AlignedBox3d parts;
  for (std::size_t i = 0; i < a.parts.size(); ++i) parts.extend(box_of(a, i));
  const MeshReport whole = report(load_mesh(file));
  check_near(parts, whole.box_min, whole.box_max);
  for (const auto& shape : a.shapes) {
    CHECK(report(*shape).closed);
    CHECK(volume(*shape) > 0);
  }
  return a;
}

inline std::string refused(const std::string& file) {
  return refusal([&] { load_mesh(file); }) + refusal(file);
}

/// A file of one tetrahedron whose positions are the accessor `position` of `doc`.
inline Assembly read_with_position(GltfDoc& doc, std::size_t position, const Json& node = {}) {
  const TempFolder folder;
  Json of = node.is_null() ? Json::object() : node;
  of["mesh"] = doc.mesh({{"attributes", {{"POSITION", position}}}, {"indices", doc.faces()}});
  doc.node(of);
  return read(doc.save(folder));
}

}  // namespace tegotae::test
