// tegotae-models: writes the parts of the experiments as OBJ files (mm).

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/output_file.hpp"
#include "models/puzzles.hpp"
#include "models/shapes.hpp"
#include "models/write_obj.hpp"
#include "shared/guarded_main.hpp"
#include "shared/option_check.hpp"

namespace {

using namespace tegotae;

void write_models(const std::string& folder, const std::vector<double>& ratios, bool all, int segments, int rings) {
  make_folder(folder);
  const auto path = [&](const std::string& name) { return (std::filesystem::path(folder) / name).string(); };

  shapes::Block block;
  block.segments = segments;
  block.rings = rings;
  write_obj(shapes::block_with_hole(block), path("hole_20.obj"));
  for (const double ratio : ratios) {
    shapes::Peg peg;
    peg.diameter = ratio * block.hole_diameter;
    peg.segments = segments;
    peg.rings = rings;
    char name[64];
    std::snprintf(name, sizeof name, "peg_%.9g.obj", ratio);
    write_obj(shapes::peg(peg), path(name));
  }
  if (!all) return;
  write_obj(shapes::box({0.04, 0.04, 0.04}), path("cube.obj"));
  // The wall's face is the plane x = 0, the floor's the plane z = 0; both look at the cube.
  write_obj(shapes::moved(shapes::box({0.01, 0.2, 0.2}), {0.005, 0, 0}), path("wall.obj"));
  write_obj(shapes::moved(shapes::box({0.2, 0.2, 0.01}), {0, 0, -0.005}), path("floor.obj"));
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// Scenes of two parts, with their meshes.
void write_puzzles(const std::string& folder) {
  make_folder(folder);
  for (const shapes::Puzzle& p : shapes::puzzles()) {
    const std::string path = (std::filesystem::path(folder) / p.name).string();
    write_obj(p.held, path + "_held.obj");
    write_obj(p.fixed, path + "_fixed.obj");
    const Vec3& at = p.start.p;
    const Quat& q = p.start.q;
    std::string text = "# The puzzle \"" + p.name + "\", as written by `tegotae-models --puzzles`.\nunit = \"mm\"\n\n";
    text += "[[part]]\nname = \"" + p.fixed.name + "\"\nmesh = \"" + p.name + "_fixed.obj\"\n\n";
    text += "[[part]]\nname = \"" + p.held.name + "\"\nmesh = \"" + p.name + "_held.obj\"\nheld = true\n";
    text += "position = [" + number(at.x()) + ", " + number(at.y()) + ", " + number(at.z()) + "]\n";
    text +=
        "orientation = [" + number(q.w()) + ", " + number(q.x()) + ", " + number(q.y()) + ", " + number(q.z()) + "]\n";
    write_file(path + ".toml", text);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Writes the parts of the experiments as OBJ files, in mm: pegs for a hole of 20 mm, a block with that "
      "hole, a cube, a wall and a floor.",
      "tegotae-models");
  std::string out;
  std::vector<double> ratios;
  int segments = 64, rings = 8;
  app.add_option("--out", out, "Folder to write to")->required();
  app.add_option("--ratio", ratios, "Peg diameter / hole diameter: writes only these pegs and the hole")
      ->check(apps::between(0.01, 0.999999));
  bool puzzles = false;
  app.add_flag("--puzzles", puzzles, "Write scenes instead, of a part that is to be taken out of another one");
  app.add_option("--segments", segments, "Facets around peg and hole, a multiple of 8")->check(apps::between(8, 8192));
  app.add_option("--rings", rings, "Bands along peg and hole")->check(apps::between(1, 8192));
  return apps::guarded_main(app, argc, argv, [&] {
    if (puzzles) {
      write_puzzles(out);
      return apps::kDone;
    }
    const bool all = ratios.empty();
    if (all) ratios = {0.91, 0.92, 0.93, 0.94, 0.99};
    write_models(out, ratios, all, segments, rings);
    return apps::kDone;
  });
}
