#include "peg_in_hole/peg_scene.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/output_file.hpp"
#include "models/shapes.hpp"
#include "models/write_obj.hpp"
#include "peg_in_hole/peg_script.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::apps {

namespace fs = std::filesystem;

namespace {

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

std::string scene_text(const std::string& ratio, const std::string& hole, const std::string& peg,
                       const std::string& script, double z) {
  char position[32];
  std::snprintf(position, sizeof position, "%.9g", z);
  return "# A peg and its hole of 20 mm, as written by `peg_in_hole --ratio " + ratio +
         " --scene-out DIR`.\n"
         "unit = \"mm\"\n\n"
         "[[part]]\nname = \"hole\"\nmesh = \"" +
         hole +
         "\"\n\n"
         "[[part]]\nname = \"peg\"\nmesh = \"" +
         peg + "\"\nheld = true\nposition = [0, 0, " + position +
         "]\n\n"
         "[device]\nscript = \"" +
         script + "\"\n";
}

/// A folder of its own, gone with the object.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (fs::temp_directory_path() / "peg_in_hole_XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw Error(pattern + ": cannot be made: " + std::strerror(errno));
    path_ = pattern;
  }
  ~TempFolder() {
    std::error_code ignored;  // what is left in the temporary folder does no harm
    fs::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

int facets(double ratio) {
  return ratio <= 0.99 ? 64 : ratio <= 0.995 ? 128 : 256;
}

std::string ratio_text(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", ratio);
  return text;
}

std::string write_peg_scene(double ratio, const std::string& folder) {
  if (!(ratio >= kLoosestRatio && ratio <= kTightestRatio))
    throw Error("--ratio: " + ratio_text(ratio) + " is not a number from " + ratio_text(kLoosestRatio) + " to " +
                ratio_text(kTightestRatio));
  make_folder(folder);

  shapes::Block block;
  block.segments = facets(ratio);
  shapes::Peg peg;
  peg.diameter = ratio * block.hole_diameter;
  peg.segments = facets(ratio);
  PegTask task;
  task.tip = Vec3(0, 0, -peg.length / 2);
  task.start = kStartHeight;
  task.depth = block.depth;
  const std::vector<StylusScript::Key> keys = insertion_script(task);

  const std::string r = ratio_text(ratio), peg_file = "peg_" + r + ".obj", script_file = "insert_" + r + ".csv";
  const std::string hole_file =
      block.segments == shapes::Block().segments ? "hole_20.obj" : "hole_20_" + std::to_string(block.segments) + ".obj";
  const fs::path to = folder, scene_file = to / ("peg_in_hole_" + r + ".toml");
  write_obj(shapes::block_with_hole(block), (to / hole_file).string());
  write_obj(shapes::peg(peg), (to / peg_file).string());
  write_file((to / script_file).string(), script_text(keys));
  write_file(scene_file.string(), scene_text(r, hole_file, peg_file, script_file, keys.front().pose.p.z()));
  return scene_file.string();
}

SceneFile make_peg_scene(double ratio) {
  const TempFolder folder;
  SceneFile file = load_scene(write_peg_scene(ratio, folder.path()));
  file.path = "peg_in_hole_" + ratio_text(ratio);
  return file;
}

}  // namespace tegotae::apps
