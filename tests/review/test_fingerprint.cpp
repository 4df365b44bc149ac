// What makes two calls of `tegotae try` the same task.
#include <set>

#include "catch.hpp"
#include "review/cube_scene.hpp"
#include "study/task.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("every setting that a scene file knows makes another task, and how it is written does not") {
  const TempFolder folder;
  const std::string scene = write_cube_scene(folder);
  std::string text = read_text(scene);
  const auto print = [&](const std::string& more, std::uint64_t seed = 1, double seconds = 6) {
    folder.write("scene.toml", text + more);
    study::Study study;
    study.scenes = {scene};
    study.goal = "0,0,0.01002";
    study.seed = seed;
    study.seconds = seconds;
    return study::Tasks(study, {load_scene(scene)}).fingerprint();
  };
  const std::string plain = print("");
  CHECK(print("") == plain);
  CHECK(print("\n# a comment\n\n") == plain);
  std::set<std::string> prints = {plain, print("", 2), print("", 1, 7)};
  const char* const settings[] = {"[safety]\nforce_slew = 20\n",
                                  "[safety]\ntorque_slew = 1\n",
                                  "[safety]\nvelocity_limit = 0.02\n",
                                  "[safety]\nforce_limit = 2\n",
                                  "[safety]\ntorque_limit = 0.1\n",
                                  "[safety]\ncontinuous_force = 0.5\n",
                                  "[safety]\nheartbeat_timeout = 0.5\n",
                                  "[device]\nscale = 2\n",
                                  "[device]\nhand = { stiffness = 40 }\n",
                                  "[device]\nhand = { damping = 3 }\n",
                                  "[device]\nhand = { mass = 2.0 }\n",
                                  "[contact]\nl_min = 1e-5\n",
                                  "[contact]\ndensity = 100\n",
                                  "[contact]\nresolver = \"lp\"\n",
                                  "[contact]\nnarrowphase = \"fcl\"\n",
                                  "[contact]\ntouch_tolerance = 2e-5\n",
                                  "[contact]\ninitial_overlap = \"ignore\"\n",
                                  "[contact]\ntick_budget = 1e-3\n",
                                  "[contact]\nimpulse = { restitution = 0.1 }\n",
                                  "[contact]\nimpulse = { substep = 1e-5 }\n",
                                  "[contact]\npenalty = { stiffness = 100 }\n",
                                  "[contact]\npenalty = { damping = 1 }\n",
                                  "[coupling]\nstiffness = 700\n",
                                  "[coupling]\ndamping = 4\n",
                                  "[coupling]\ntorsional_stiffness = 0.2\n",
                                  "[coupling]\ntorsional_damping = 0.003\n",
                                  "[contact]\nl_0 = 1e-4\n",
                                  "[device]\nhand = { torsional_stiffness = 4 }\n",
                                  "[device]\nhand = { torsional_damping = 0.1 }\n",
                                  "[device]\nhand = { inertia = 1e-3 }\n",
                                  "[friction]\nmu = 0.1\n",
                                  "[friction]\nmu = 0.2\n",
                                  "[[friction.pair]]\nparts = [\"block\", \"roof\"]\nmu = 0.1\n"};
  for (const char* setting : settings) prints.insert(print(setting));
  // Keys of no table stand above the first one, those of a part in its own.
  const std::string own = text;
  const std::string above[] = {"weight = true\n", "weight = true\ngravity = [0, 0, -5]\n"};
  for (const std::string& key : above) {
    text = key + own;
    prints.insert(print(""));
  }
  text = own + "mass = 0.1\n";
  prints.insert(print(""));
  CHECK(prints.size() == 3 + std::size(settings) + std::size(above) + 1);
}
