#include "check.hpp"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>

#include "run_options.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"
#include "tegotae/sim/haptic_loop.hpp"

namespace tegotae::apps {

namespace {

void print_mesh(const MeshReport& r, double unit_in_m, const char* unit) {
  std::printf("  %zu triangle%s, %zu vertices, %zu component%s, %s\n", r.triangles, r.triangles == 1 ? "" : "s",
              r.vertices, r.components, r.components == 1 ? "" : "s", r.closed ? "closed" : "not closed");
  if (r.boundary_edges + r.non_manifold_edges + r.degenerate_faces + r.duplicate_faces > 0)
    std::printf("  %zu boundary edges, %zu non-manifold edges, %zu degenerate faces, %zu duplicate faces\n",
                r.boundary_edges, r.non_manifold_edges, r.degenerate_faces, r.duplicate_faces);
  const Vec3 lo = r.box_min / unit_in_m, hi = r.box_max / unit_in_m;
  std::printf("  box %.6g..%.6g  %.6g..%.6g  %.6g..%.6g %s\n", lo.x(), hi.x(), lo.y(), hi.y(), lo.z(), hi.z(), unit);
}

void check_mesh(const std::string& file, const MeshLoader& load) {
  const TriangleMesh mesh = load(file, 1.0);
  std::cout << file << "\n" << std::flush;
  print_mesh(report(mesh), 1.0, "(file units)");
}

void check_scene(const std::string& path, const MeshLoader& load) {
  const SceneFile file = load_scene(path, load);
  std::cout << path << "\n" << std::flush;
  std::map<const TriangleMesh*, std::string> seen;
  for (const Part& part : file.scene.parts) {
    std::printf("%s%s: %s\n", part.name.c_str(), part.held ? " (held)" : "", part.mesh->name.c_str());
    const auto [first, fresh] = seen.emplace(part.mesh.get(), part.name);
    if (fresh)
      print_mesh(report(*part.mesh), 1e-3, "mm");
    else
      std::printf("  as %s\n", first->second.c_str());
  }
  std::printf("script: %.3g s\n", file.script.end() - file.script.begin());
  std::fflush(stdout);
  try {
    const HapticLoop loop(file.scene);
    std::printf("start: free; l_min %.3g um, l_0 %.3g um, resolver %s\n", 1e6 * loop.contact().l_min,
                1e6 * loop.contact().l_0, loop.contact().resolver.c_str());
  } catch (const Error& e) {
    throw Error(path + ": " + e.what());
  }
}

}  // namespace

int check_files(const std::vector<std::string>& files, const MeshLoader& load) {
  int code = kDone;
  for (const std::string& file : files) {
    try {
      if (std::filesystem::path(file).extension() == ".toml")
        check_scene(file, load);
      else
        check_mesh(file, load);
    } catch (const Error& e) {
      std::fflush(stdout);
      std::cerr << "tegotae: " << e.what() << "\n";
      code = kBadInput;
    }
  }
  return code;
}

}  // namespace tegotae::apps
