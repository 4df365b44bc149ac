#include "import/usable.hpp"

#include "core/valid_pose.hpp"
#include "mesh/precision.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae {
std::string cause_of(const std::vector<std::string>& notes) {
  for (const char* words : {"left out", "is not read", "without a volume"})
    for (const std::string& note : notes)
      if (note.find(words) != std::string::npos) return ": " + note;
  return "";
}

void require_usable(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw Error(mesh.name + ": no triangles" + cause_of(mesh.notes));
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3& p = mesh.vertices[v];
      if (!p.allFinite()) throw Error(mesh.name + ": a coordinate is not a finite number");
      if (p.cwiseAbs().maxCoeff() > kFarthestVertex) {
        throw Error(mesh.name + ": a coordinate lies beyond 1000 km: damaged, or a wrong unit");
      }
    }
  }
}

void require_area(const TriangleMesh& welded) {
  const double step = rounding_step(welded);
  for (const auto& t : welded.triangles) {
    if (!is_degenerate(welded, t, step)) return;
  }
  throw Error(welded.name + ": no triangle has an area" + cause_of(welded.notes));
}

TriangleMesh usable(TriangleMesh mesh, const std::string& path, const std::string& name) {
  mesh.name = path + ": \"" + name + '"';
  require_usable(mesh);
  TriangleMesh welded = weld(mesh);
  require_area(welded);
  welded.name = name;
  return welded;
}

}  // namespace tegotae
