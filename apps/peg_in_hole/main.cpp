// peg_in_hole: a scripted hand carries a peg into its hole.
#include <filesystem>
#include <string>

#include "peg_in_hole/peg_scene.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "tegotae/narrowphase/hierarchy_cache.hpp"

using namespace tegotae;
using namespace tegotae::apps;

int main(int argc, char** argv) {
  CLI::App app("A scripted hand carries a peg into its hole (20 mm): off center and tilted at first.", "peg_in_hole");
  RunOptions options;
  double ratio = 0.94;
  std::string folder;
  app.add_option(
         "--ratio", ratio,
         "Diameter of the peg by that of the hole, " + ratio_text(kLoosestRatio) + " to " + ratio_text(kTightestRatio))
      ->capture_default_str()
      ->type_name("R");
  add_run_options(app, options);
  add_progress_option(app);
  app.add_option("--scene-out", folder,
                 "Keep the scene, its meshes and its script in a folder (with --record: FILE.scene)")
      ->type_name("DIR");

  return guarded_main(app, argc, argv, [&] {
    set_hierarchy_cache(default_cache_folder());
    // A recording needs its scene beside it; the run reports a recording that cannot be written.
    if (folder.empty() && !options.record.empty() &&
        std::filesystem::is_directory(std::filesystem::absolute(options.record).parent_path()))
      folder = options.record + ".scene";
    const SceneFile file = folder.empty() ? make_peg_scene(ratio) : load_scene(write_peg_scene(ratio, folder));
    return run_and_report(file, options, "peg in hole, " + ratio_text(ratio));
  });
}
