// A run whose hand is guided along a path: a hand that holds the pen loosely is led out of the hole, one that pulls
// away is let go.
#include <cmath>
#include <vector>

#include "apps/run_program.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "models/puzzles.hpp"
#include "session/loose_hand.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/session/session.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

SceneFile file_of(Scene scene, StylusScript script) {
  SceneFile file{"guide.toml", std::move(scene), {}, std::move(script)};
  file.scene.weight.max_force = 0.7;  // half of what the simulated pen stands for long, as a scene file has it
  return file;
}

/// A file of poses as `tegotae plan` writes it, with a part's name that has a comma.
std::string path_file(const TempFolder& folder, const std::vector<Pose>& path) {
  std::string text = "t,px,py,pz,qw,qx,qy,qz,clearance,part,force,torque\n";
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Pose& X = path[i];
    char row[400];
    std::snprintf(row, sizeof row, "%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,0.001,\"left, upper\",0,0\n", i,
                  X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z());
    text += row;
  }
  folder.write("path.csv", text);
  return folder / "path.csv";
}

}  // namespace

TEST_CASE("a hand that holds the pen loosely is led out of a puzzle", "[guide]") {
  const std::string name =
      GENERATE(std::string("straight"), std::string("l-shaped"), std::string("bent-bar"), std::string("key"));
  CAPTURE(name);
  const shapes::Puzzle puzzle = shapes::puzzle(name);
  const TempFolder folder;
  LooseHand hand(puzzle.start);
  Ticks ticks;
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = 20;
  settings.hand = &hand;
  settings.observer = &ticks;
  settings.check_all = true;
  settings.record = folder / "run.mcap";
  settings.guide_path = path_file(folder, puzzle.known);
  std::string told;
  settings.on_start = [&told](const RunStart& start) { told = start.guide; };
  const SceneFile file = file_of(puzzle.scene(), StylusScript({{0, puzzle.start}}));
  const RunSummary summary = run_session(file, settings);
  CHECK_THAT(told, Contains("0.7 N and"));
  CHECK(read_recording(settings.record).info.guide == settings.guide_path);
  // Out, which it is not without the pull.
  const Displacement left = displacement(ticks.X.back(), puzzle.known.back(), puzzle.pivot);
  CHECK(left.dp.norm() < 1e-3);
  CHECK(left.dr.norm() < 0.05);
  CHECK(summary.penetrating == 0);
  CHECK(ticks.off == 0);
  settings.guide_path.clear();
  settings.record.clear();
  ticks.X.clear();
  LooseHand alone(puzzle.start);
  settings.hand = &alone;
  run_session(file, settings);
  CHECK(displacement(ticks.X.back(), puzzle.start, puzzle.pivot).dp.norm() < 1e-4);
}

TEST_CASE("a hand that pulls away from the guide is let go, and guided again when it is back", "[guide]") {
  Scene scene;
  scene.parts = {{"floor", shared(box(Vec3(0.4, 0.4, 0.01))), {Quat::Identity(), Vec3(0, 0, -0.005)}},
                 {"block", shared(box(Vec3(0.02, 0.02, 0.02))), {Quat::Identity(), Vec3(0, 0, 0.05)}, true}};
  const auto at = [](double x, double y) { return Pose{Quat::Identity(), Vec3(x, y, 0.05)}; };
  const TempFolder folder;
  Ticks ticks;
  RunSettings settings;
  settings.real_time = false;
  settings.observer = &ticks;
  settings.guide_path = path_file(folder, {at(0, 0), at(0.1, 0)});
  const StylusScript script(
      {{0, at(0, 0)}, {1, at(0, 0)}, {1.5, at(0, 0.04)}, {2, at(0, 0.04)}, {2.5, at(0, 0)}, {3.5, at(0, 0)}});
  run_session(file_of(scene, script), settings);
  double jump = 0, most = 0;
  for (std::size_t i = 1; i < ticks.wrench.size(); ++i) {
    jump = std::max(jump, (ticks.wrench[i].force - ticks.wrench[i - 1].force).norm());
    most = std::max(most, ticks.wrench[i].force.norm());
  }
  CHECK(most < 0.7 + 1e-6);
  CHECK(jump < 0.05);
  CHECK(ticks.wrench[900].force.x() == Approx(0.7).epsilon(0.01));   // on the path
  CHECK(ticks.wrench[1700].force.norm() == 0);                       // 40 mm off it
  CHECK(ticks.wrench[3400].force.x() == Approx(0.7).epsilon(0.01));  // back
  CHECK((ticks.flags & TEGOTAE_SHM_FLAG_DAMPED) == 0);
  CHECK(ticks.off == 0);
}

TEST_CASE("the weight leaves the guide what the device stands for", "[guide]") {
  Scene scene;
  scene.parts = {{"floor", shared(box(Vec3(0.4, 0.4, 0.01))), {Quat::Identity(), Vec3(0, 0, -0.005)}},
                 {"block", shared(box(Vec3(0.02, 0.02, 0.02))), {Quat::Identity(), Vec3(0, 0, 0.05)}, true}};
  scene.weight.on = true;
  scene.parts[1].mass = 0.06;  // 0.588 N
  const TempFolder folder;
  Ticks ticks;
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = 1;
  settings.observer = &ticks;
  const Pose start = scene.parts[1].pose;
  settings.guide_path = path_file(folder, {start, {Quat::Identity(), Vec3(0.1, 0, 0.05)}});
  SceneFile file = file_of(scene, StylusScript({{0, start}}));
  run_session(file, settings);
  const Vec3 force = ticks.wrench.back().force;
  // The pen sags by 1.5 mm from the path, so the pull carries a little of the weight.
  CHECK(force.z() > -0.588);
  CHECK(force.z() < -0.45);
  CHECK(force.x() == Approx((1.4 - 0.588) / 2).epsilon(0.05));
  // A device that is not known to have a limit.
  file.scene.weight.on = false;
  file.scene.weight.max_force.reset();
  std::string told;
  settings.on_start = [&told](const RunStart& start_of) { told = start_of.guide; };
  run_session(file, settings);
  CHECK_THAT(told, Contains("1 N and"));
}

TEST_CASE("a guide that cannot be is refused before the run", "[guide]") {
  const shapes::Puzzle puzzle = shapes::puzzle("loose");
  const TempFolder folder;
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = 0.1;
  SceneFile file = file_of(puzzle.scene(), StylusScript({{0, puzzle.start}}));
  settings.guide_path = folder / "none.csv";
  CHECK_THROWS_WITH(run_session(file, settings), Contains("none.csv: cannot be opened as a path"));
  folder.write("none.csv", "t,px,py\n0,0,0\n");
  CHECK_THROWS_WITH(run_session(file, settings), Contains("none.csv:1: column pz is missing"));
  settings.guide_path = path_file(folder, puzzle.known);
  file.scene.contact.resolver = ResolverKind::lp;
  CHECK_THROWS_WITH(run_session(file, settings), Contains("the resolver lp does not support a load; qp does"));
}
