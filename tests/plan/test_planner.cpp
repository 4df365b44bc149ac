// The planner finds the ways that are known, and what it calls free FCL finds free.
#include <algorithm>
#include <atomic>
#include <map>
#include <string>
#include <utility>

#include "broadphase/bounding_spheres.hpp"
#include "catch.hpp"
#include "models/puzzles.hpp"
#include "path_check.hpp"
#include "plan/baseline.hpp"
#include "plan/exit.hpp"
#include "plan/motion_world.hpp"
#include "plan/planner.hpp"
#include "shared/clearance_probe.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

/// By FCL and by distances of triangles: the path is free, and leaves what the plan says.
void judge(const Scene& scene, const Plan& plan) {
  double reach = 0;
  for (const Part& part : scene.parts)
    if (part.held) reach = radius_about(*part.mesh, plan.center);
  REQUIRE(!plan.path.empty());
  const PathCheck check = check_path(FclOracle(scene), plan.path, plan.center, reach);
  CHECK(check.intersecting == 0);
  CHECK(plan.clearance >= kGapFloor);
  apps::ClearanceProbe probe(scene);
  std::vector<apps::Clearance> near;
  for (std::size_t i = 0; i < plan.path.size(); ++i)
    for (int k = 0; k < 10; ++k) {
      const Pose& to = plan.path[std::min(i + 1, plan.path.size() - 1)];
      probe.at(pose_between(plan.path[i], to, plan.center, 0.1 * k, PathKind::center), 0, near);
      // FCL rounds distances; the certificate by less than a hundredth of a micrometer.
      CHECK(near.front().distance > plan.clearance - 0.05e-6);
    }
}

bool same(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Pose& x, const Pose& y) { return x.p == y.p && x.q.coeffs() == y.q.coeffs(); });
}

void find_way_out(const shapes::Puzzle& p) {
  INFO(p.name);
  const Scene scene = p.scene();
  const Plan plan = plan_path(scene, {});
  REQUIRE(plan.found);
  judge(scene, plan);
  const Exit exit(scene, plan.center, radius_about(p.held, plan.center));
  CHECK(exit.is_out(plan.path.back()));
  // It starts where the scene has the part: nothing touches there.
  CHECK(displacement(plan.path.front(), p.start, plan.center).dp.norm() < 1e-12);
  CHECK(turn_of(plan.path) >= p.least_turn);
  CHECK(way_of(plan.path, plan.center) >= p.least_way);
}

}  // namespace

TEST_CASE("ways out of the puzzles are found and free") {
  for (const char* name : {"loose", "straight", "l-shaped", "burr", "bent-bar", "key"})
    find_way_out(shapes::puzzle(name));
}

// Its path is long in turns, and FCL slow in a thread.
TEST_CASE("a screw turns out of its nut", "[.][screw]") {
  find_way_out(shapes::puzzle("screw"));
}

TEST_CASE("a straight way is straight") {
  const shapes::Puzzle p = shapes::puzzle("straight");
  const Plan plan = plan_path(p.scene(), {});
  REQUIRE(plan.found);
  CHECK(way_of(plan.path, plan.center) < 1.02 * (p.known.back().p - p.known.front().p).norm());
  // In the middle of its hole it has 0.1 mm on all sides, and the path keeps nine tenths of it.
  CHECK(plan.clearance > 0.085e-3);
  CHECK(plan.clearance < 0.1e-3);
}

TEST_CASE("what the planner is compared with finds an easy way") {
  const shapes::Puzzle p = shapes::puzzle("loose");
  const Scene scene = p.scene();
  const Plan plan = plan_path(scene, {});
  const Exit exit(scene, plan.center, radius_about(p.held, plan.center));
  BaselineTask task;
  task.center = plan.center;
  task.gyration = 0.004;
  task.goals = exit.straight_out(p.start);
  task.room = exit.room();
  task.ended = [asked = 0]() mutable { return ++asked > 100000; };
  const BaselineResult result = rrt_connect(scene, task);
  CHECK(result.found);
  CHECK(result.asked > 100);
  REQUIRE(result.path.size() > 1);
  CHECK(result.path.front().p == p.start.p);
  CHECK(exit.is_out(result.path.back()));
}

TEST_CASE("the same seed gives the same path, another one another") {
  const Scene scene = shapes::puzzle("l-shaped").scene();
  PlanOptions options;
  options.seed = 3;
  const Plan one = plan_path(scene, options), two = plan_path(scene, options);
  CHECK(one.found);
  CHECK(same(one.path, two.path));
  CHECK(one.motions == two.motions);
  CHECK(one.clearance == two.clearance);
  options.seed = 4;
  CHECK(!same(one.path, plan_path(scene, options).path));
}

TEST_CASE("a goal in a hole is reached from outside") {
  shapes::Puzzle p = shapes::puzzle("l-shaped");
  Scene scene = p.scene();
  scene.parts[1].pose = p.known.back();
  PlanOptions options;
  options.goal = p.start;
  const Plan plan = plan_path(scene, options);
  REQUIRE(plan.found);
  judge(scene, plan);
  CHECK(displacement(plan.path.back(), p.start, plan.center).dp.norm() < 1e-12);
  CHECK(way_of(plan.path, plan.center) >= p.least_way);
}

TEST_CASE("a clearance that is asked for is kept") {
  shapes::Puzzle p = shapes::puzzle("l-shaped");
  PlanOptions options;
  options.clearance = 60e-6;
  const Plan plan = plan_path(p.scene(), options);
  REQUIRE(plan.found);
  CHECK(plan.clearance >= 60e-6);
  judge(p.scene(), plan);
  // Where it starts there are 0.1 mm.
  options.clearance = 0.2e-3;
  CHECK_THROWS_WITH(plan_path(p.scene(), options), Contains("starts nearer to \"channel\""));
}

TEST_CASE("who is locked in is not let out, and the plan says what holds it") {
  const shapes::Puzzle p = shapes::puzzle("locked-in");
  PlanOptions options;
  options.iterations = 300;
  const Plan plan = plan_path(p.scene(), options);
  CHECK(!plan.found);
  CHECK(plan.iterations == 300);
  CHECK(plan.turn > 1);
  REQUIRE(plan.in_the_way.size() == 1);
  CHECK(plan.in_the_way.front().part == 0);
  CHECK(plan.in_the_way.front().stops > 10);
  judge(p.scene(), plan);  // the way to the farthest pose
}

TEST_CASE("a plan is ended from outside with what there is") {
  const shapes::Puzzle p = shapes::puzzle("locked-in");
  std::atomic<bool> stop{false};
  int asked = 0;
  PlanOptions options;
  options.stop = &stop;
  options.search_ends = [&] { return stop = ++asked > 50; };
  const Plan plan = plan_path(p.scene(), options);
  CHECK(!plan.found);
  CHECK(plan.interrupted);
  CHECK(plan.iterations < 300);
  CHECK(plan.path.size() > 1);
}

TEST_CASE("a plan that is stopped after its way was found keeps it, proved as far as it had come") {
  const shapes::Puzzle p = shapes::puzzle("l-shaped");
  const bool in_time = GENERATE(true, false);  // ended by who watches it, or because its time is up
  CAPTURE(in_time);
  const std::string at =
      GENERATE(std::string("shortening"), std::string("certifying"), std::string("searching for a wider way"));
  CAPTURE(at);
  std::atomic<bool> stop{false};
  PlanOptions options;
  if (in_time)
    options.stop = &stop;
  else
    options.ends = [&stop] { return stop.load(); };
  std::string last;
  int told = 0, told_after = 0;
  options.progress = [&](const PlanProgress& now) {
    if (stop) told_after += now.what == last ? 0 : 1;
    last = now.what;
    stop = stop || (now.what == at && ++told == 1);
  };
  const Plan plan = plan_path(p.scene(), options);
  CHECK(told == 1);
  CHECK(plan.found);
  CHECK(plan.interrupted == in_time);
  CHECK(plan.out_of_time == !in_time);
  // What is left to do is to prove what there is.
  CHECK(told_after <= 1);
  CHECK((last == "certifying" || last == at));
  judge(p.scene(), plan);
  const Exit exit(p.scene(), plan.center, radius_about(p.held, plan.center));
  CHECK(exit.is_out(plan.path.back()));
}

TEST_CASE("how wide the way of a plan is hardly depends on the seed") {
  // Of what its fit leaves on each side: l-shaped 0.1 mm, bent-bar 0.5 mm, the bit of the key in its slot 0.4 mm, which
  // it has to meet.
  struct Case {
    std::string name;
    double play, share;
  };
  const auto [name, play, share] =
      GENERATE(Case{"l-shaped", 0.1e-3, 0.2}, Case{"bent-bar", 0.5e-3, 0.2}, Case{"key", 0.4e-3, 0.1});
  CAPTURE(name);
  const Scene scene = shapes::puzzle(name).scene();
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    CAPTURE(seed);
    PlanOptions options;
    options.seed = seed;
    const Plan plan = plan_path(scene, options);
    REQUIRE(plan.found);
    CHECK(plan.clearance > share * play);
    CHECK(plan.clearance < play);
  }
}

TEST_CASE("goals and scenes that cannot be are refused") {
  const shapes::Puzzle p = shapes::puzzle("straight");
  PlanOptions options;
  options.goal = Pose{Quat::Identity(), {0.003, 0, 0}};
  CHECK_THROWS_WITH(plan_path(p.scene(), options), Contains("at the goal the held part is in \"block\""));
  // Inside the material: no surface meets another.
  shapes::Puzzle small = p;
  for (Vec3& v : small.held.vertices) v *= 0.2;
  options.goal = Pose{Quat::Identity(), {0, 0, -0.025}};
  CHECK_THROWS_WITH(plan_path(small.scene(), options), Contains("at the goal the held part is in \"block\""));
  Scene alone;
  alone.add_held("peg", p.held);
  CHECK_THROWS_WITH(plan_path(alone, {}), Contains("no other part"));
}

TEST_CASE("a motion that the certificate calls free is free, and the free share ends before the wall") {
  const shapes::Puzzle p = shapes::puzzle("straight");
  MotionWorld world(p.scene(), kGapFloor);
  Pose up = p.start, aside = p.start;
  up.p.z() += 0.05;
  aside.p.x() += 1e-3;
  CHECK(world.is_free(p.start, up));
  // 0.1 mm of play.
  Pose near = p.start;
  near.p.x() += 0.098e-3;
  CHECK(world.is_free(p.start, near));
  CHECK(!world.is_free(p.start, aside));
  CHECK(world.free_share(p.start, aside) < 0.1);
  CHECK(world.blocker() == 0u);
  // Led aside and up, it slides up along the wall.
  Pose both = up;
  both.p.x() += 5e-3;
  std::vector<Pose> pieces;
  world.comply(p.start, both, 0.1, pieces);
  REQUIRE(!pieces.empty());
  CHECK(pieces.back().p.z() > p.start.p.z() + 0.02);
  std::vector<Pose> path = {p.start};
  path.insert(path.end(), pieces.begin(), pieces.end());
  CHECK(check_path(FclOracle(p.scene()), path, world.center(), world.radius()).intersecting == 0);
}
