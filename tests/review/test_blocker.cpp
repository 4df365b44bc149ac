// Who is in the way, by the last poses of a run.
#include <atomic>

#include "bodies.hpp"
#include "catch.hpp"
#include "shared/blocker.hpp"

using namespace tegotae;
using namespace tegotae::apps;
using namespace tegotae::test;

namespace {

constexpr double kGap = 2e-6;

/// A block of 10 mm in a corner: over a floor (top at z = 0) and beside a wall (its side at x = 0), both by kGap.
Scene corner() {
  Scene scene;
  scene.parts.push_back({"floor", shared(box({0.2, 0.2, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"wall", shared(box({0.02, 0.2, 0.1})), {Quat::Identity(), {-0.01, 0, 0.04}}, false});
  scene.parts.push_back(
      {"block", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {0.005 + kGap, 0, 0.005 + kGap}}, true});
  return scene;
}

/// At the start's place moved by `off`, for `seconds` from `t` on, with the pen `ahead` of it.
void stay(const Scene& scene, double t, double seconds, const Vec3& off, const Vec3& ahead,
          std::vector<TickPoses>& ticks) {
  Pose X = scene.parts.back().pose;
  X.p += off;
  for (int i = 0; i < static_cast<int>(1e3 * seconds); ++i) ticks.push_back({t + 1e-3 * i, {X.q, X.p + ahead}, X});
}

std::string blocker(const Scene& scene, const std::vector<TickPoses>& ticks, const InitialContactReport& start = {}) {
  return find_blocker(scene, start, ticks).part;
}

}  // namespace

TEST_CASE("who is in the way is whom the pen pushes into", "[blocker]") {
  const Scene scene = corner();
  const auto pushed = [&](const Vec3& ahead) {
    std::vector<TickPoses> ticks;
    stay(scene, 0, 1, Vec3::Zero(), ahead, ticks);
    return blocker(scene, ticks);
  };
  CHECK(pushed({0, 0, -1e-3}) == "floor");
  CHECK(pushed({-1e-3, 0, 0}) == "wall");
  CHECK(pushed({-1e-3, 0, -2e-3}) == "floor");
  CHECK(pushed({-2e-3, 0, -1e-3}) == "wall");
  // A pen that turns the block about y pushes its lower edge through the floor or its side through the wall; one that
  // pulls away pushes into nobody, and then it is who was touched.
  CHECK_FALSE(pushed({1e-3, 0, 1e-3}).empty());

  std::vector<TickPoses> ticks;
  stay(scene, 0, 1, Vec3::Zero(), {0, 0, -1e-3}, ticks);
  const Blocker found = find_blocker(scene, {}, ticks);
  CHECK(std::abs(found.place_W.z()) < 1e-9);  // on the floor, under the block
  CHECK(std::abs(found.place_W.x() - 0.005) < 0.0051);
  CHECK(std::abs(found.place_W.y()) < 0.0051);
}

TEST_CASE("only the last half second counts, and parts that were touched for long", "[blocker]") {
  const Scene scene = corner();
  std::vector<TickPoses> ticks;
  CHECK(blocker(scene, ticks).empty());
  stay(scene, 0, 1, Vec3::Zero(), {0, 0, -1e-3}, ticks);
  stay(scene, 1, 0.6, {1e-3, 0, 1e-3}, {0, 0, -2e-3}, ticks);  // in the air
  CHECK(blocker(scene, ticks).empty());
  // A hard push into the wall of a tenth of a second, a soft one onto the floor for the rest.
  ticks.clear();
  stay(scene, 0, 0.1, {1e-3, 0, 0}, {0, 0, -1e-4}, ticks);
  stay(scene, 0.1, 0.1, Vec3::Zero(), {-5e-3, 0, 0}, ticks);
  stay(scene, 0.2, 0.3, {1e-3, 0, 0}, {0, 0, -1e-4}, ticks);
  CHECK(blocker(scene, ticks) == "floor");
}

TEST_CASE("a search that is stopped finds nobody", "[blocker]") {
  const Scene scene = corner();
  std::vector<TickPoses> ticks;
  stay(scene, 0, 1, Vec3::Zero(), {0, 0, -1e-3}, ticks);
  std::atomic<bool> stop{false};
  CHECK(find_blocker(scene, {}, ticks, &stop).part == "floor");
  stop = true;
  CHECK(find_blocker(scene, {}, ticks, &stop).part.empty());
}

TEST_CASE("what is looked at is spread over the last half second, whatever the rate of the ticks", "[blocker]") {
  const Scene scene = corner();
  const double rate = GENERATE(50.0, 100.0, 1000.0, 4000.0);
  const auto blocker_at = [&](double wall, double floor) {
    std::vector<TickPoses> ticks;
    const Pose X = scene.parts.back().pose;
    const auto add = [&](double from, double to, const Vec3& off, const Vec3& ahead) {
      for (double t = from; t < to - 1e-9; t += 1 / rate)
        ticks.push_back({t, {X.q, X.p + off + ahead}, {X.q, X.p + off}});
    };
    add(0, 1, {1e-3, 0, 1e-3}, Vec3::Zero());
    add(1, 1 + wall, {0, 0, 1e-3}, {-1e-4, 0, 0});
    add(1 + wall, 1 + wall + floor, {1e-3, 0, 0}, {0, 0, -1e-3});
    return blocker(scene, ticks);
  };
  CHECK(blocker_at(0.2, 0.24) == "floor");
  CHECK(blocker_at(0.38, 0.1) == "wall");  // the floor for less than half as long, however hard
}

TEST_CASE("a suspended part is in nobody's way, a relieved one where it is felt", "[blocker]") {
  Scene scene = corner();
  scene.parts.back().pose.p.z() -= 5e-6;  // 3 µm deep in the floor
  std::vector<TickPoses> ticks;
  stay(scene, 0, 1, Vec3::Zero(), {-1e-4, 0, -1e-3}, ticks);
  InitialContactReport start;
  start.pairs.emplace_back();
  start.pairs[0].part = 0;
  start.pairs[0].state = InitialContactState::filtered;
  CHECK(blocker(scene, ticks, start) == "wall");
  start.pairs[0].state = InitialContactState::shrunk;
  start.pairs[0].inward_offset = 5e-6;  // then it is 2 µm above what is felt
  CHECK(blocker(scene, ticks, start) == "floor");
  start.pairs[0].inward_offset = 1e-4;  // and then out of touch
  CHECK(blocker(scene, ticks, start) == "wall");
}
