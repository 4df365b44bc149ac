// A STEP assembly is taken apart with two commands, and FCL is asked about the path of each step.
#include <algorithm>
#include <sstream>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "loop/scene_parts.hpp"
#include "mesh/step_assembly.hpp"
#include "plan/disassembly.hpp"
#include "plan/path_judge.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

/// The cells of a CSV file that has no commas in them, without its first row; quotes are left out.
std::vector<std::vector<std::string>> rows_of(const std::string& path) {
  std::istringstream text(read_text(path));
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    line.erase(std::remove(line.begin(), line.end(), '"'), line.end());
    std::istringstream row(line);
    rows.emplace_back();
    for (std::string cell; std::getline(row, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

std::vector<Pose> path_of(const std::string& file) {
  std::vector<Pose> out;
  for (const auto& row : rows_of(file)) {
    std::vector<double> x;
    for (std::size_t i = 1; i < 8; ++i) x.push_back(std::stod(row.at(i)));
    out.push_back({Quat(x[3], x[4], x[5], x[6]), {x[0], x[1], x[2]}});
  }
  return out;
}

std::size_t number_of(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    if (scene.parts[i].name == name) return i;
  FAIL("no part " << name);
  return 0;
}

}  // namespace

TEST_CASE("two commands take a STEP assembly apart") {
  const TempFolder folder;
  write_step_assembly(folder / "assembly.step", {}, "MM", "AP214IS");
  const std::string in = folder / "assembly", to = folder / "order";
  const Output import = run_program("tegotae", "import " + (folder / "assembly.step") + " -o " + in);
  INFO(import.err);
  REQUIRE(import.code == 0);
  const Output plan = run_program("tegotae", "plan " + in + "/scene.toml --all --to " + to);
  INFO(plan.out << plan.err);
  REQUIRE(plan.code == 0);
  CHECK_THAT(plan.out, Contains("\nLeft: Grundplatte\n"));

  const auto steps = rows_of(to + "/order.csv");
  REQUIRE(steps.size() == 6);
  SceneOptions how;
  how.held_needed = false;
  const Scene scene = load_scene(in + "/scene.toml", how).scene;
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) there.push_back(i);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string name = steps[i].at(1);
    CAPTURE(i, name);
    CHECK(std::stod(steps[i].at(3)) > 1);  // um
    const std::size_t part = number_of(scene, name);
    const Scene then = removal_scene(scene, there, {part});
    const TriangleMesh& mesh = *held_part(then).mesh;
    const Vec3 center = mass_properties(mesh, report(mesh).closed).center;
    const std::vector<Pose> path = path_of(to + "/step-0" + std::to_string(i + 1) + ".csv");
    REQUIRE(path.size() > 1);
    // From where it stands in the assembly, but for what it is moved off the others that it touches.
    CHECK((path.front().p - held_part(then).pose.p).norm() < 20e-6);
    tegotae::plan::PathJudge judge(then, center);
    const tegotae::plan::PathVerdict verdict = judge.ask(path);
    CHECK(verdict.poses > 100);
    CHECK(verdict.intersecting == 0);
    there.erase(std::find(there.begin(), there.end(), part));
  }
  REQUIRE(there.size() == 1);
  CHECK(scene.parts[there.front()].name == "Grundplatte");
}
