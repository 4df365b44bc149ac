// A hand that holds the pen loosely is led out along a path that was planned.
#include "apps/run_program.hpp"
#include "catch.hpp"
#include "models/puzzles.hpp"
#include "session/loose_hand.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/record/recording.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("a hand is led along a planned path to its end") {
  const std::string name = GENERATE(std::string("straight"), std::string("l-shaped"), std::string("key"));
  CAPTURE(name);
  const TempFolder folder;
  REQUIRE(run_program("tegotae-models", "--puzzles --out " + (folder / "puzzles")).code == 0);
  const Output plan = run_program(
      "tegotae", "plan " + (folder / ("puzzles/" + name + ".toml")) + " --seed 1 --to " + (folder / "plan"));
  INFO(plan.out << plan.err);
  REQUIRE(plan.code == 0);
  const shapes::Puzzle puzzle = shapes::puzzle(name);
  const Pose end = read_recording(folder / "plan/recording.csv").frames.back().x;
  const Vec3 center = mass_properties(puzzle.held, true).center;
  LooseHand hand(puzzle.start);
  Ticks ticks;
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = 30;
  settings.hand = &hand;
  settings.observer = &ticks;
  settings.check_all = true;
  settings.guide_path = folder / "plan/path.csv";
  SceneFile file{"guide.toml", puzzle.scene(), {}, StylusScript({{0, puzzle.start}})};
  file.scene.weight.max_force = 0.7;  // half of what the simulated pen stands for long, as a scene file has it
  const RunSummary summary = run_session(file, settings);
  const Displacement left = displacement(ticks.X.back(), end, center);
  CHECK(left.dp.norm() < 1e-3);
  CHECK(left.dr.norm() < 0.05);
  CHECK(summary.penetrating == 0);
  CHECK(ticks.off == 0);
  // The end of the path is out, far from where the hand began.
  CHECK(displacement(puzzle.start, ticks.X.back(), center).dp.norm() > 0.01);
}
