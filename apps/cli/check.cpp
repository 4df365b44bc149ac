#include "cli/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "core/number_text.hpp"
#include "loop/mesh_structures.hpp"
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

/// What is found in a mesh.
struct Findings {
  MeshReport report;
  std::size_t t_junctions = 0;
};

Findings find(const TriangleMesh& mesh, const std::string& name) {
  StatusLine status;
  status.say("checking " + name);
  Findings found{report(mesh)};
  if (found.report.boundary_edges > 0) found.t_junctions = count_t_junctions(mesh);
  return found;
}

void print_mesh(const TriangleMesh& mesh, const Findings& found, double unit_in_m, const char* unit) {
  const MeshReport& r = found.report;
  std::printf("  %zu triangle%s, %zu vertices, %zu component%s, %s\n", r.triangles, r.triangles == 1 ? "" : "s",
              r.vertices, r.components, r.components == 1 ? "" : "s", r.closed ? "closed" : "not closed");
  if (r.boundary_edges + r.non_manifold_edges + r.degenerate_faces + r.duplicate_faces > 0)
    std::printf("  %zu boundary edges, %zu non-manifold edges, %zu degenerate faces, %zu duplicate faces\n",
                r.boundary_edges, r.non_manifold_edges, r.degenerate_faces, r.duplicate_faces);
  if (const std::size_t n = found.t_junctions; n > 0)
    std::printf(
        "  %zu vert%s on an edge of another face (T-junction%s): the surface is open there until that edge is split\n",
        n, n == 1 ? "ex lies" : "ices lie", n == 1 ? "" : "s");
  if (r.inverted_shells > 0)
    std::printf("  %zu of %zu shells look%s the wrong way: a shell faces outwards, the wall of a cavity inwards\n",
                r.inverted_shells, r.components, r.inverted_shells == 1 ? "s" : "");
  const Vec3 lo = r.box_min / unit_in_m, hi = r.box_max / unit_in_m;
  std::string box;
  for (int i = 0; i < 3; ++i) box += "  " + number_text(lo[i], 6) + ".." + number_text(hi[i], 6);
  std::printf("  box%s %s\n", box.substr(1).c_str(), unit);
  for (const std::string& note : mesh.notes) std::printf("  note: %s\n", note.c_str());
}

void check_mesh(const std::string& file, const MeshLoader& load) {
  TriangleMesh mesh;
  {
    StatusLine status;
    status.say("reading " + file);
    mesh = load(file, 1.0);
  }
  const Findings found = find(mesh, file);
  std::cout << file << "\n" << std::flush;
  print_mesh(mesh, found, 1.0, "(file units)");
}

std::unique_ptr<const HapticLoop> build_loop(const Scene& scene) {
  StatusLine status;
  const MeshStructures made(scene.parts, scene.contact.narrowphase, [&](std::size_t done, std::size_t total) {
    status.show("building hierarchies", done, total);
  });
  status.say("looking for contacts at the start");
  return std::make_unique<const HapticLoop>(scene);
}

void check_scene(const std::string& path, const MeshLoader& load) {
  const SceneFile file = load_with_progress(path, {"", false, {}, load});
  std::cout << path << "\n" << std::flush;
  std::map<const TriangleMesh*, std::string> seen;
  for (const Part& part : file.scene.parts) {
    std::printf("%s%s: %s\n", part.name.c_str(), part.held ? " (held)" : "", part.mesh->name.c_str());
    const auto [first, fresh] = seen.emplace(part.mesh.get(), part.name);
    if (fresh)
      print_mesh(*part.mesh, find(*part.mesh, part.name), 1e-3, "mm");
    else
      std::printf("  as %s\n", first->second.c_str());
  }
  const auto& parts = file.scene.parts;
  if (std::none_of(parts.begin(), parts.end(), [](const Part& p) { return p.held; })) {
    std::printf("no part is held: name one with --hold NAME when running, or give it held = true\n");
    return;
  }
  std::printf("script: %s s\n", number_text(file.script.end() - file.script.begin(), 3).c_str());
  std::fflush(stdout);
  try {
    const std::unique_ptr<const HapticLoop> built = build_loop(file.scene);
    const HapticLoop& loop = *built;
    const InitialContactReport& start = loop.start();
    std::printf("start: %s; l_min %s um, l_0 %s um, resolver %s\n%s",
                start.pairs.empty() ? "free" : "touching or overlapping other parts",
                number_text(1e6 * *loop.contact().l_min, 3).c_str(), number_text(1e6 * *loop.contact().l_0, 3).c_str(),
                to_string(loop.contact().resolver).c_str(), start_text(start, file.scene).c_str());
  } catch (const Error& e) {
    throw Error(path + ": " + e.what());
  }
}

void print_clash(const Clash& c, const Scene& scene) {
  const auto millimeters = [](double m) { return number_text(1e3 * m, 4) + " mm"; };
  std::string how = "overlap, open surfaces cross";
  if (c.kind == ClashKind::near || c.gap > 0)
    how = std::string(c.kind == ClashKind::near ? "near" : "touch") + ", gap " + millimeters(c.gap);
  else if (c.depth)
    how = std::string(c.kind == ClashKind::overlap ? "overlap" : "touch") + ", depth " + millimeters(*c.depth);
  std::string place;
  for (const double m : c.place_W) place += " " + number_text(1e3 * m, 6);
  std::printf("%s and %s: %s, at%s mm\n", scene.parts[c.a].name.c_str(), scene.parts[c.b].name.c_str(), how.c_str(),
              place.c_str());
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
  if (within > 0) std::printf(", %zu are within %s mm", counts[ClashKind::near], number_text(1e3 * within, 4).c_str());
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
