#include "cli/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>

#include "mesh/t_junctions.hpp"
#include "shared/run_options.hpp"
#include "shared/start_text.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/clash.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae::apps {

namespace {

void print_mesh(const TriangleMesh& mesh, double unit_in_m, const char* unit) {
  const MeshReport r = report(mesh);
  std::printf("  %zu triangle%s, %zu vertices, %zu component%s, %s\n", r.triangles, r.triangles == 1 ? "" : "s",
              r.vertices, r.components, r.components == 1 ? "" : "s", r.closed ? "closed" : "not closed");
  if (r.boundary_edges + r.non_manifold_edges + r.degenerate_faces + r.duplicate_faces > 0)
    std::printf("  %zu boundary edges, %zu non-manifold edges, %zu degenerate faces, %zu duplicate faces\n",
                r.boundary_edges, r.non_manifold_edges, r.degenerate_faces, r.duplicate_faces);
  if (const std::size_t n = r.boundary_edges > 0 ? count_t_junctions(mesh) : 0; n > 0)
    std::printf(
        "  %zu vert%s on an edge of another face (T-junction%s): the surface is open there until that edge is split\n",
        n, n == 1 ? "ex lies" : "ices lie", n == 1 ? "" : "s");
  if (r.inverted_shells > 0)
    std::printf("  %zu of %zu shells look%s the wrong way: a shell faces outwards, the wall of a cavity inwards\n",
                r.inverted_shells, r.components, r.inverted_shells == 1 ? "s" : "");
  const Vec3 lo = r.box_min / unit_in_m, hi = r.box_max / unit_in_m;
  std::printf("  box %.6g..%.6g  %.6g..%.6g  %.6g..%.6g %s\n", lo.x(), hi.x(), lo.y(), hi.y(), lo.z(), hi.z(), unit);
  for (const std::string& note : mesh.notes) std::printf("  note: %s\n", note.c_str());
}

void check_mesh(const std::string& file, const MeshLoader& load) {
  const TriangleMesh mesh = load(file, 1.0);
  std::cout << file << "\n" << std::flush;
  print_mesh(mesh, 1.0, "(file units)");
}

void check_scene(const std::string& path, const MeshLoader& load) {
  const SceneFile file = load_with_progress(path, {"", false, {}, load});
  std::cout << path << "\n" << std::flush;
  std::map<const TriangleMesh*, std::string> seen;
  for (const Part& part : file.scene.parts) {
    std::printf("%s%s: %s\n", part.name.c_str(), part.held ? " (held)" : "", part.mesh->name.c_str());
    const auto [first, fresh] = seen.emplace(part.mesh.get(), part.name);
    if (fresh)
      print_mesh(*part.mesh, 1e-3, "mm");
    else
      std::printf("  as %s\n", first->second.c_str());
  }
  const auto& parts = file.scene.parts;
  if (std::none_of(parts.begin(), parts.end(), [](const Part& p) { return p.held; })) {
    std::printf("no part is held: name one with --hold NAME when running, or give it held = true\n");
    return;
  }
  std::printf("script: %.3g s\n", file.script.end() - file.script.begin());
  std::fflush(stdout);
  try {
    const HapticLoop loop(file.scene);
    const InitialContactReport& start = loop.start();
    std::printf("start: %s; l_min %.3g um, l_0 %.3g um, resolver %s\n%s",
                start.pairs.empty() ? "free" : "touching or overlapping other parts", 1e6 * *loop.contact().l_min,
                1e6 * *loop.contact().l_0, to_string(loop.contact().resolver).c_str(),
                start_text(start, file.scene).c_str());
  } catch (const Error& e) {
    throw Error(path + ": " + e.what());
  }
}

void print_clash(const Clash& c, const Scene& scene) {
  char how[64];
  if (c.kind == ClashKind::near || c.gap > 0)
    std::snprintf(how, sizeof how, "%s, gap %.4g mm", c.kind == ClashKind::near ? "near" : "touch", 1e3 * c.gap);
  else if (!c.depth)
    std::snprintf(how, sizeof how, "overlap, open surfaces cross");
  else
    std::snprintf(how, sizeof how, "%s, depth %.4g mm", c.kind == ClashKind::overlap ? "overlap" : "touch",
                  1e3 * *c.depth);
  const Vec3 p = 1e3 * c.place_W;
  std::printf("%s and %s: %s, at %.6g %.6g %.6g mm\n", scene.parts[c.a].name.c_str(), scene.parts[c.b].name.c_str(),
              how, p.x(), p.y(), p.z());
}

void check_clashes(const std::string& path, double within, const MeshLoader& load) {
  const SceneFile file = load_with_progress(path, {"", false, {}, load});
  ClashOptions options;
  options.within = within;
  print_notes(file.scene);
  std::vector<Clash> clashes;
  {
    StatusLine status;
    options.progress = [&](std::size_t done, std::size_t total) { status.show("pair", done, total); };
    clashes = find_clashes(file.scene, options);
  }
  std::map<ClashKind, std::size_t> counts;
  for (const Clash& c : clashes) {
    print_clash(c, file.scene);
    ++counts[c.kind];
  }
  std::printf("%s: of %zu parts %zu pairs overlap, %zu touch", path.c_str(), file.scene.parts.size(),
              counts[ClashKind::overlap], counts[ClashKind::touch]);
  if (within > 0) std::printf(", %zu are within %.4g mm", counts[ClashKind::near], 1e3 * within);
  std::printf("\n");
}

bool is_scene(const std::string& file) {
  return std::filesystem::path(file).extension() == ".toml";
}

}  // namespace

int check_files(const CheckOptions& options) {
  int code = kDone;
  for (const std::string& file : options.files) {
    try {
      if (options.clash && !is_scene(file))
        throw Error(file + ": --clash needs a scene file (.toml); `tegotae import` makes one");
      if (options.clash)
        check_clashes(file, options.within, options.load);
      else if (is_scene(file))
        check_scene(file, options.load);
      else
        check_mesh(file, options.load);
    } catch (const Error& e) {
      std::fflush(stdout);
      std::cerr << "tegotae: " << e.what() << "\n";
      code = kBadInput;
    }
  }
  return code;
}

}  // namespace tegotae::apps
