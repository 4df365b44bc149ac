// peg_in_hole: a scripted hand carries a peg into its hole.
#include <string>

#include "peg_scene.hpp"
#include "run_options.hpp"

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
  app.add_option("--scene-out", folder, "Also write the scene, its meshes and its script to a folder")
      ->type_name("DIR");

  return guarded_main(app, argc, argv, [&] {
    if (!folder.empty()) write_peg_scene(ratio, folder);
    return run_and_report(make_peg_scene(ratio), options, "peg in hole, " + ratio_text(ratio), -kStartHeight);
  });
}
