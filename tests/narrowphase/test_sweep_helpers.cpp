// Threads that help where all faces of a part are looked at: the same answers as without, by exact tests of triangles.
#include <algorithm>
#include <atomic>
#include <thread>

#include "alloc_guard.hpp"
#include "catch.hpp"
#include "core/numbers.hpp"
#include "narrowphase/surface_sweep.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"
#include "tegotae/core/clock.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kClearance = 1.1e-6;
/// As in test_surface_sweep.cpp.
constexpr double kEndsBefore = 14e-6;

/// A sheet above its die, both of so many faces that there are many pieces.
struct Sheets {
  MeshPtr sheet = wave(0.1, 0.01, 0.05, 90), die = wave(0.1, 0.01, 0.05, 127);
  Oracle oracle{sheet, die};

  SurfaceSweep sweep(int helpers, std::size_t dies = 1) const {
    const auto b = std::make_shared<const PatchTree>(die);
    std::vector<CellFront::FixedPart> fixed(dies, {b, Pose{}});
    return SurfaceSweep(std::make_shared<const PatchTree>(sheet), Vec3::Zero(), fixed, nullptr, nullptr, 24, helpers);
  }
};

Pose above(std::mt19937& rng, double turn = 0.003) {
  return {rotation(random_in_ball(rng, turn)), Vec3(0, 0, uniform(rng, 1e-3, 0.01)) + random_in_ball(rng, 2e-4)};
}

Displacement down(std::mt19937& rng) {
  return {Vec3(0, 0, uniform(rng, -0.015, -1e-4)) + random_in_ball(rng, 1e-3), random_in_ball(rng, 0.01)};
}

SweepTask::Question with_pieces(std::uint32_t pieces) {
  SweepTask::Question question;
  question.pieces = pieces;
  return question;
}

}  // namespace

TEST_CASE("a limit that several threads lower ends at the least of all, with what made it so") {
  SharedLimit limit;
  limit.set({1, false});
  CHECK(limit.value().share == 1);
  CHECK(!limit.value().early);
  limit.lower({0.5, true});
  limit.lower({0.75, false});
  CHECK(limit.value().share == Approx(0.5).epsilon(1e-15));
  CHECK(limit.value().share <= 0.5);
  CHECK(limit.value().early);
  limit.lower({0, false});
  CHECK(limit.value().share == 0);
  limit.set({1, false});
  std::vector<std::thread> threads;
  for (unsigned seed = 0; seed < 3; ++seed) {
    threads.emplace_back([&limit, seed] {
      std::mt19937 rng(seed);
      for (int i = 0; i < 100000; ++i) limit.lower({uniform(rng, 0.1, 1), true});
      limit.lower({0.05 + 0.01 * seed, seed == 0});
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(limit.value().share == Approx(0.05));
  CHECK(limit.value().early);
}

TEST_CASE("each piece is taken once, and again by those who have none left while it is not finished") {
  SweepTask task(100);
  task.open(with_pieces(100), {1, false}, {1, false}, 0);
  std::vector<std::uint32_t> taken;
  for (int i = 0; i < 100; ++i) taken.push_back(task.take().value());
  std::sort(taken.begin(), taken.end());
  for (std::uint32_t i = 0; i < 100; ++i) CHECK(taken[i] == i);
  for (std::uint32_t i = 0; i < 100; ++i)
    if (i != 17 && i != 80) task.finish(i);
  CHECK(task.take() == 17u);
  CHECK(task.take() == 17u);
  task.finish(17);
  task.finish(17);  // by both
  CHECK(task.take() == 80u);
  task.finish(80);
  CHECK(!task.take());
  // As new with another question.
  task.open(with_pieces(3), {0.5, true}, {1, false}, 7);
  CHECK(task.take() == 0u);
  CHECK(!task.is_over());
  CHECK(task.searched == 7);
  task.close();
  CHECK(task.is_over());
}

TEST_CASE("what is met is told once, the nearest first, however much and in whatever order") {
  SweepTask task(1);
  std::array<SweepTask::Met, SweepTask::kMostMet> met;
  task.open(with_pieces(1), {1, false}, {1, false}, 0);
  CHECK(task.met(met) == 0);
  for (const double share : {0.7, 0.3, 0.5, 0.3}) task.add_met({share, static_cast<std::uint32_t>(10 * share), 2});
  REQUIRE(task.met(met) == 3);
  CHECK(met[0].share == 0.3);
  CHECK(met[1].share == 0.5);
  CHECK(met[2].share == 0.7);
  CHECK(met[0].a == 3);
  CHECK(met[0].b == 2);
  // Of more than there is room for the last ones are kept.
  for (std::uint32_t i = 0; i < 3 * SweepTask::kMostMet; ++i) task.add_met({1.0 / (i + 1), i, i});
  REQUIRE(task.met(met) == SweepTask::kMostMet);
  for (std::size_t i = 0; i < met.size(); ++i) CHECK(met[i].a == 3 * SweepTask::kMostMet - 1 - i);
}

TEST_CASE("with helpers, the first part of a motion is free as far as without, and what ends it is told") {
  const Sheets sheets;
  SurfaceSweep alone = sheets.sweep(0), helped = sheets.sweep(3);
  std::mt19937 rng(41);
  int cut = 0, whole = 0, early = 0;
  for (int n = 0; n < 40; ++n) {
    const Pose X = above(rng);
    if (sheets.oracle.meet(X)) continue;
    const Displacement d = down(rng);
    SweepAim aim;
    aim.clearance = kClearance;
    if (n % 2 == 1) aim.worth = uniform(rng, 0, 0.5) * d.dp.norm();
    const std::vector<std::uint32_t> near = {0};
    const std::vector<bool> outside = {false};
    double share[2];
    for (SurfaceSweep* sweep : {&alone, &helped}) {
      const AllocGuard guard;
      sweep->begin(X, d, near, outside, aim);
      sweep->go_on(kNoDeadline);
      CHECK(guard.count() == 0);
      share[sweep == &helped] = sweep->share();
      CHECK(sweep->blocking().empty() == (sweep->share() == 1 || sweep->ended_early()));
    }
    CHECK(sheets.oracle.hits(X, Vec3::Zero(), share[1] * d, 10) == 0);
    if (helped.ended_early()) {
      // Blocks end it a seventh before faces would at most, or where it was worth it.
      const double size = d.dp.norm() + 0.08 * d.dr.norm();
      if (!alone.ended_early()) CHECK(share[1] * size > std::min(aim.worth, 0.84 * share[0] * size) * (1 - 1e-9));
      ++early;
    } else if (!alone.ended_early() && share[0] != share[1]) {
      // Each ends a little before something is touched. What ended the shorter one is as near, and apart, where the
      // longer one ends: along a slope that is farther than it is near.
      const FacePair met = (share[0] < share[1] ? alone : helped).blocking().front();
      const Pose end = displaced(X, Vec3::Zero(), std::max(share[0], share[1]) * d);
      const double gap = Oracle(single(*sheets.sheet, met.a), single(*sheets.die, met.b)).distance(end);
      CHECK(gap > 0.9 * kClearance);
      CHECK(gap < kEndsBefore);
    }
    if (share[1] == 1) {
      ++whole;
    } else if (!helped.ended_early()) {
      const FacePair met = helped.blocking().front();
      const Pose end = displaced(X, Vec3::Zero(), share[1] * d);
      CHECK(met.part == 0);
      CHECK(Oracle(single(*sheets.sheet, met.a), single(*sheets.die, met.b)).distance(end) < kEndsBefore);
      ++cut;
    }
  }
  CHECK(cut > 10);
  CHECK(whole > 2);
  CHECK(early > 2);
}

TEST_CASE("a look is dropped for another one at any time, with helpers inside") {
  const Sheets sheets;
  SurfaceSweep alone = sheets.sweep(0), helped = sheets.sweep(3);
  std::mt19937 rng(42);
  int finished = 0;
  for (int n = 0; n < 300; ++n) {
    const Pose X = above(rng);
    const Displacement d = down(rng);
    helped.begin(X, d, {0}, {false}, {kClearance});
    if (n % 15 != 0) {
      helped.go_on(monotonic_ns() + static_cast<std::int64_t>(uniform(rng, 0, 1e6)));
      continue;
    }
    while (!helped.go_on(monotonic_ns() + 200000)) std::this_thread::yield();
    alone.begin(X, d, {0}, {false}, {kClearance});
    alone.go_on(kNoDeadline);
    CHECK(helped.share() == Approx(alone.share()).margin(kEndsBefore / d.dp.norm()));
    ++finished;
  }
  CHECK(finished == 20);
}

TEST_CASE("past many parts each is looked at, with helpers") {
  const Sheets sheets;
  SurfaceSweep one = sheets.sweep(0), many = sheets.sweep(2, 5);
  std::mt19937 rng(43);
  for (int n = 0; n < 6; ++n) {
    const Pose X = above(rng);
    const Displacement d = down(rng);
    one.begin(X, d, {0}, {false}, {kClearance});
    one.go_on(kNoDeadline);
    many.begin(X, d, {4, 2, 0}, {false, false, false}, {kClearance});
    many.go_on(kNoDeadline);
    CHECK(many.share() == Approx(one.share()).margin(kEndsBefore / d.dp.norm()));
    for (const FacePair& met : many.blocking()) CHECK((met.part == 4 || met.part == 2 || met.part == 0));
  }
}

TEST_CASE("a helper that never comes back does not keep a look from its end") {
  const Sheets sheets;
  const auto model = std::make_shared<const SweepModel>(
      std::make_shared<const PatchTree>(sheets.sheet), Vec3::Zero(),
      std::vector<CellFront::FixedPart>{{std::make_shared<const PatchTree>(sheets.die), Pose{}}}, nullptr, nullptr);
  SweepTask::Question question;
  question.X = {Quat::Identity(), Vec3(0, 0, 0.005)};
  question.d = {Vec3(0, 0, -0.004), Vec3::Zero()};
  question.clearance = question.kept = kClearance;
  question.look = SweepTask::Look::faces;
  question.pieces = SweepWorker::pieces(*model, question);
  SweepTask task(SweepWorker::most_pieces(*model));
  task.open(question, {1, false}, {1, false}, 0);
  REQUIRE(question.pieces > 8);
  for (int i = 0; i < 3; ++i) CHECK(task.take().has_value());
  SweepWorker worker(model);
  CHECK(worker.begin(task));
  CHECK(worker.work(task, kNoDeadline));
  CHECK(!task.take());
  CHECK(task.end.value().share == 1);
}
