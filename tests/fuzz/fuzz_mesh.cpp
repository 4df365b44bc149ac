// Mesh files of one format: load_mesh and everything that a part goes through before the first tick.
#include <cmath>
#include <optional>

#include "fuzz/fuzz.hpp"
#include "fuzz/mesh_format.hpp"
#include "fuzz/mesh_seeds.hpp"
#include "mesh/surface.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/assembly.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {

std::vector<Seed> seeds() {
  return mesh_seeds(kFormat);
}

namespace {

/// The parts of the file, which `whole` puts together: the same surface, placed.
void check_parts(const std::string& path, const TriangleMesh& whole) {
  AssemblyOptions options;
  options.unit = std::string(kFormat) == "3mf" ? std::nullopt : std::optional<std::string>("mm");
  const Assembly assembly = read_assembly(path, options);
  std::size_t triangles = 0;
  for (const AssemblyPart& part : assembly.parts) {
    require(part.shape < assembly.shapes.size(), "a part has a shape");
    require(part.pose.p.allFinite() && std::abs(part.pose.q.norm() - 1) < 1e-9, "a part has a pose");
    triangles += assembly.shapes[part.shape]->triangles.size();
  }
  require(triangles == whole.triangles.size(), "the parts have the triangles of the whole");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = mesh_file(kFormat, std::string(reinterpret_cast<const char*>(data), size));
  const std::string path = write_input(std::string("input.") + kFormat, bytes.data(), bytes.size());
  try {
    const auto mesh = std::make_shared<const TriangleMesh>(load_mesh(path, 1e-3));
    require(!mesh->triangles.empty(), "a mesh that loads has triangles");
    for (const auto& t : mesh->triangles) {
      for (const std::uint32_t v : t) {
        require(v < mesh->vertices.size(), "indices are in range");
        require(mesh->vertices[v].allFinite(), "coordinates are finite");
      }
    }
    const MeshReport r = report(*mesh);
    require(r.triangles == mesh->triangles.size(), "the report counts the triangles");
    const MassProperties mass = mass_properties(*mesh, r.closed);
    require(mass.mass > 0 && mass.center.allFinite() && mass.inertia.allFinite(), "mass properties are usable");
    const Surface surface(mesh);
    for (const Vec3& n : surface.topology.face_normals) require(n.allFinite(), "normals are finite");
    check_parts(path, *mesh);
  } catch (const Error& e) {
    const std::string what = e.what();
    require_error_of(path + ": ", what);
    require(what.find("not enough memory") == std::string::npos, "a small file takes little memory");
  }
  return 0;
}

}  // namespace tegotae
