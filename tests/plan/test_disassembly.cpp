// Orders of disassembly that are known by construction.
#include <set>

#include "catch.hpp"
#include "models/bricks.hpp"
#include "path_check.hpp"
#include "plan/disassembly.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::test;
using shapes::Brick;

namespace {

Brick brick(double x0, double y0, double z0, double x1, double y1, double z1, bool solid = true) {
  return {1e-3 * Vec3(x0, y0, z0), 1e-3 * Vec3(x1, y1, z1), solid};
}

/// A box that holds a cube under a plug in its opening.
Scene box_with_plug() {
  Scene scene;
  scene.add_fixed("box",
                  shapes::solid_of("box", {brick(-20, -20, -30, 20, 20, 0), brick(-10, -10, -25, 10, 10, 0, false)}));
  scene.add_fixed("plug", shapes::solid_of("plug", {brick(-9.8, -9.8, -8, 9.8, 9.8, 12)}));
  scene.add_fixed("cube", shapes::solid_of("cube", {brick(-4, -4, -20, 4, 4, -12)}));
  return scene;
}

/// A cube in a closed hollow box at `x` mm.
void add_rattle(Scene& scene, const std::string& name, double x) {
  scene.add_fixed(name + " cube", shapes::solid_of("cube", {brick(x - 4, -4, -4, x + 4, 4, 4)}));
  scene.add_fixed(name + " shell", shapes::solid_of("shell", {brick(x - 10, -10, -10, x + 10, 10, 10),
                                                              brick(x - 5, -5, -5, x + 5, 5, 5, false)}));
}

/// A cube in a closed box in a closed box at `x` mm: neither one nor two of them come out of the rest.
void add_nested_rattle(Scene& scene, const std::string& name, double x) {
  scene.add_fixed(name + " cube", shapes::solid_of("cube", {brick(x - 4, -4, -4, x + 4, 4, 4)}));
  scene.add_fixed(name + " inner shell", shapes::solid_of("shell", {brick(x - 7, -7, -7, x + 7, 7, 7),
                                                                    brick(x - 5, -5, -5, x + 5, 5, 5, false)}));
  scene.add_fixed(name + " outer shell", shapes::solid_of("shell", {brick(x - 10, -10, -10, x + 10, 10, 10),
                                                                    brick(x - 8, -8, -8, x + 8, 8, 8, false)}));
}

}  // namespace

TEST_CASE("what lies under a plug comes out after it, and the box is left") {
  const Scene scene = box_with_plug();
  const Disassembly d = take_apart(scene, {});
  REQUIRE(d.order.size() == 2);
  CHECK(d.order[0].parts == std::vector<std::size_t>{1});
  CHECK(d.order[1].parts == std::vector<std::size_t>{2});
  CHECK(d.left == std::vector<std::size_t>{0});
  CHECK(d.together.empty());
  CHECK(d.order[0].there.size() == 3);
  CHECK(d.order[1].there.size() == 2);
  // The cube had been tried before, and the box and the plug were in its way.
  REQUIRE(d.blocked.size() == 1);
  CHECK(d.blocked[0].part == 2);
  CHECK(d.blocked[0].by.size() == 2);
  CHECK(d.blocked[0].error.empty());
  for (const Removal& r : d.order) {
    const FclOracle oracle(removal_scene(scene, r.there, r.parts));
    CHECK(r.plan.clearance > 0);
    CHECK(check_path(oracle, r.plan.path, r.plan.center, 0.03).intersecting == 0);
  }
}

TEST_CASE("what does not come apart comes out as a group") {
  Scene scene;
  add_rattle(scene, "left", -15);
  add_rattle(scene, "right", 15);
  DisassemblyOptions options;
  options.quick = 15;
  options.iterations = 30;
  const Disassembly d = take_apart(scene, options);
  REQUIRE(d.order.size() == 1);
  CHECK(d.order[0].parts.size() == 2);
  CHECK(d.order[0].plan.found);
  CHECK(d.left.size() == 2);
  REQUIRE(d.together.size() == 1);
  CHECK(d.together[0] == d.order[0].parts);
  CHECK(d.blocked.size() == 4);
}

TEST_CASE("where no two come out together three do") {
  Scene scene;
  add_nested_rattle(scene, "left", -15);
  add_nested_rattle(scene, "right", 15);
  DisassemblyOptions options;
  options.quick = 13;
  options.iterations = 15;
  const Disassembly d = take_apart(scene, options);
  REQUIRE(d.order.size() == 1);
  const std::vector<std::size_t> left = {0, 1, 2}, right = {3, 4, 5};
  const Removal& out = d.order[0];
  CHECK((out.parts == left || out.parts == right));
  CHECK(d.left == (out.parts == left ? right : left));
  REQUIRE(d.together.size() == 1);
  CHECK(std::set<std::size_t>(d.together[0].begin(), d.together[0].end()) ==
        std::set<std::size_t>(out.parts.begin(), out.parts.end()));
  CHECK(d.blocked.size() == 6);
  const FclOracle oracle(removal_scene(scene, out.there, out.parts));
  CHECK(check_path(oracle, out.plan.path, out.plan.center, 0.03).intersecting == 0);
}

TEST_CASE("a part that overlaps another one is named, and the others come apart") {
  Scene scene = box_with_plug();
  scene.add_fixed("pin", shapes::solid_of("pin", {brick(15, -2, -15, 30, 2, -11)}));
  DisassemblyOptions options;
  options.quick = 15;
  options.iterations = 30;
  const Disassembly d = take_apart(scene, options);
  REQUIRE(d.order.size() == 2);
  CHECK(d.left.size() == 2);
  bool told = false;
  for (const Blocked& b : d.blocked) told = told || (b.part == 3 && b.error.find("box") != std::string::npos);
  CHECK(told);
}

TEST_CASE("one part is not an assembly") {
  Scene scene;
  scene.add_fixed("cube", shapes::solid_of("cube", {brick(0, 0, 0, 1, 1, 1)}));
  CHECK_THROWS_AS(take_apart(scene, {}), Error);
}
