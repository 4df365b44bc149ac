// The check of a run's poses beside it: what it counts, what it leaves out, and when it ends.
#include <time.h>

#include <atomic>
#include <thread>

#include "alloc_guard.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "loop/scene_parts.hpp"
#include "session/run_check.hpp"
#include "tegotae/session/session.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

Scene block_over_floor() {
  Scene scene;
  scene.parts = {{"floor", shared(box(Vec3(0.2, 0.2, 0.01))), {Quat::Identity(), Vec3(0, 0, -0.005)}},
                 {"block", shared(box(Vec3(0.02, 0.02, 0.02))), {Quat::Identity(), Vec3(0, 0, 0.03)}, true}};
  return scene;
}

/// Pose `i`: every tenth is in the floor, the others are over it.
Pose pose(int i) {
  return {Quat::Identity(), Vec3(1e-6 * i, 0, i % 10 == 0 ? 0.009 : 0.02)};
}

void add(CheckedSegment& segment, int n) {
  for (int i = 0; i < n; ++i) segment.add(pose(i), 0);
}

}  // namespace

TEST_CASE("every different pose is asked about once", "[check]") {
  const bool real_time = GENERATE(false, true);
  const Scene scene = block_over_floor();
  RunCheck check(true, real_time);
  const auto segment = check.segment(scene, {});
  check.watch(*segment);
  std::uint64_t allocations = 0;
  for (int i = 0; i < 3000; ++i) {
    const AllocGuard guard;
    segment->add(pose(i), 0);
    segment->add(pose(i), 0);  // the same again
    allocations += guard.count();
  }
  std::atomic<double> share{-1};
  check.end(0, nullptr, &share);
  CHECK(check.poses() == 3000);
  CHECK(check.checked() == 3000);
  CHECK(check.intersecting() == 300);
  CHECK(allocations == 0);
}

TEST_CASE("of more poses than can wait a fair part is asked, unless all are wanted", "[check]") {
  const bool all = GENERATE(false, true);
  const Scene scene = block_over_floor();
  RunCheck check(all, false);
  const auto segment = check.segment(scene, {});
  add(*segment, 60'000);  // before anybody looks
  check.watch(*segment);
  check.end(1e9, nullptr, nullptr);  // with time enough
  CHECK(check.poses() == 60'000);
  if (all) {
    CHECK(check.checked() == 60'000);
    CHECK(check.intersecting() == 6'000);
  } else {
    CHECK(check.checked() < 30'000);
    CHECK(check.checked() > 5'000);
    // Of every second, or fourth, pose; a tenth of them, or twice that, intersects.
    const double share = static_cast<double>(check.intersecting()) / static_cast<double>(check.checked());
    CHECK(share > 0.05);
    CHECK(share < 0.35);
  }
}

TEST_CASE("a check that is stopped ends as it is", "[check]") {
  const bool all = GENERATE(false, true);
  const Scene scene = block_over_floor();
  RunCheck check(all, true);
  const auto segment = check.segment(scene, {});
  check.watch(*segment);
  add(*segment, 50'000);
  const std::atomic<bool> stop{true};
  check.end(1e9, &stop, nullptr);
  CHECK(check.poses() == 50'000);
  CHECK(check.checked() < check.poses());
}

TEST_CASE("a check that nobody ends goes with its owner", "[check]") {
  const Scene scene = block_over_floor();
  RunCheck check(true, true);
  const auto segment = check.segment(scene, {});
  check.watch(*segment);
  add(*segment, 50'000);
  check.abandon();
  check.abandon();
  CHECK(check.checked() < 50'000);
}

TEST_CASE("a pair that was not free counts from when it has come free", "[check]") {
  const Scene scene = block_over_floor();
  InitialContactReport start;
  InitialContact pair;
  pair.part = 0;
  pair.state = InitialContactState::filtered;
  pair.freed = InitialContact::kNotYet;
  start.pairs = {pair};
  RunCheck check(true, false);
  const auto segment = check.segment(scene, start);
  check.watch(*segment);
  for (int i = 0; i < 100; ++i) segment->add(pose(10 * i), 0);  // in the floor, and not yet free of it
  start.pairs[0].freed = 1;
  segment->came_free(start);
  for (int i = 0; i < 50; ++i) segment->add(pose(10 * (i + 200)), 1);
  check.end(0, nullptr, nullptr);
  CHECK(check.checked() == 150);
  CHECK(check.intersecting() == 50);
}

TEST_CASE("a session tells how many poses were checked, and how many of all", "[check]") {
  Scene scene = block_over_floor();
  scene.contact.resolver = ResolverKind::penalty;  // which lets parts intersect
  const bool all = GENERATE(false, true);
  const SceneFile file{
      "", scene, {}, StylusScript({{0, scene.parts[1].pose}, {0.3, {Quat::Identity(), Vec3::Zero()}}})};
  RunSettings settings;
  settings.real_time = false;
  settings.seconds = 0.5;
  settings.check_all = all;
  const RunSummary summary = run_session(file, settings);
  CHECK(summary.poses > 100);
  CHECK(summary.poses <= summary.ticks);
  CHECK(summary.checked <= summary.poses);
  CHECK(summary.penetrating > 0);
  if (all) CHECK(summary.checked == summary.poses);
  // Stopped from the beginning: nothing is asked about in the time after.
  const std::atomic<bool> stop{true};
  settings.stop_check = &stop;
  CHECK(run_session(file, settings).ticks == 500);
}
