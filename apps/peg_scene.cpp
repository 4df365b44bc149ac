#include "peg_scene.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "models/shapes.hpp"
#include "models/write_obj.hpp"
#include "peg_script.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/load.hpp"

namespace tegotae::apps {

namespace {

// Finer fits get more facets, so that the clearance stays well above the facets' height.
int facets(double ratio) {
  return ratio <= 0.99 ? 64 : ratio <= 0.995 ? 128 : 256;
}

// As it comes back from a file in mm, whose numbers are read in single precision.
std::shared_ptr<const TriangleMesh> as_read(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices)
    for (double& x : v) x = static_cast<double>(static_cast<float>(1000 * x)) * unit_length("mm");
  return std::make_shared<TriangleMesh>(weld(mesh));
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(path.string() + ": cannot be written: " + std::strerror(errno));
}

std::string script_text(const std::vector<StylusScript::Key>& keys) {
  std::string text = "t,px,py,pz,qw,qx,qy,qz\n";
  for (const auto& [t, X] : keys) {
    char row[256];
    std::snprintf(row, sizeof row, "%.9g,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f\n", t, X.p.x(), X.p.y(), X.p.z(), X.q.w(),
                  X.q.x(), X.q.y(), X.q.z());
    text += row;
  }
  return text;
}

}  // namespace

std::string ratio_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", ratio);
  return text;
}

PegScene make_peg_scene(double ratio) {
  if (!(ratio >= kLoosestRatio && ratio <= kTightestRatio))
    throw Error("--ratio: must be between " + ratio_text(kLoosestRatio) + " and " + ratio_text(kTightestRatio));
  shapes::Block block;
  block.segments = facets(ratio);
  shapes::Peg peg;
  peg.diameter = ratio * block.hole_diameter;
  peg.segments = facets(ratio);
  PegTask task;
  task.tip = Vec3(0, 0, -peg.length / 2);
  task.start = 0.02;
  task.depth = block.depth;

  const std::vector<StylusScript::Key> keys = insertion_script(task);
  StylusScript script(keys);
  Scene scene;
  scene.parts.push_back({"hole", as_read(shapes::block_with_hole(block)), Pose(), false});
  scene.parts.push_back({"peg", as_read(shapes::peg(peg)), script.pose(script.begin()), true});
  return {ratio, task.start, keys, {"peg_in_hole_" + ratio_text(ratio), std::move(scene), {}, std::move(script)}};
}

void write_peg_scene(const PegScene& peg, const std::string& folder) {
  const std::string r = ratio_text(peg.ratio);
  const std::filesystem::path to = folder;
  std::error_code failed;
  std::filesystem::create_directories(to, failed);
  if (failed) throw Error(folder + ": " + failed.message());
  const std::string hole = facets(peg.ratio) == 64 ? "hole_20.obj" : "hole_20_" + r + ".obj";
  write_obj(*peg.file.scene.parts[0].mesh, (to / hole).string());
  write_obj(*peg.file.scene.parts[1].mesh, (to / ("peg_" + r + ".obj")).string());
  write_text(to / ("insert_" + r + ".csv"), script_text(peg.keys));
  char start[64];
  std::snprintf(start, sizeof start, "%.9g", peg.file.scene.parts[1].pose.p.z());
  write_text(to / ("peg_in_hole_" + r + ".toml"), "# A peg and its hole of 20 mm, as `peg_in_hole --ratio " + r +
                                                      " --scene-out DIR` writes them.\n"
                                                      "unit = \"mm\"\n"
                                                      "\n[[part]]\nname = \"hole\"\nmesh = \"" +
                                                      hole +
                                                      "\"\n"
                                                      "\n[[part]]\nname = \"peg\"\nmesh = \"peg_" +
                                                      r + ".obj\"\nheld = true\nposition = [0, 0, " + start +
                                                      "]\n"
                                                      "\n[device]\nscript = \"insert_" +
                                                      r + ".csv\"\n");
}

}  // namespace tegotae::apps
