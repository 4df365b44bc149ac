// Sessions whose scene changes while they run, seen by a program that runs one.
#include <atomic>
#include <optional>
#include <thread>

#include "alloc_guard.hpp"
#include "apps/run_program.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "loop/scene_parts.hpp"
#include "session/pen_port.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/write.hpp"
#include "tegotae/session/session.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

/// A block on its way down to a floor, by a wall; another block stands aside.
SceneFile scene_in(const TempFolder& folder) {
  write_ply(box(Vec3(0.02, 0.02, 0.02)), folder / "block.ply", 1);
  write_ply(box(Vec3(0.2, 0.2, 0.01)), folder / "board.ply", 1);
  folder.write("down.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.03,1,0,0,0\n0.3,0,0,0.009,1,0,0,0\n0.6,0,0,0.03,1,0,0,0\n");
  folder.write("scene.toml", R"(
[[part]]
name = "floor"
mesh = "board.ply"
position = [0, 0, -0.005]
[[part]]
name = "wall"
mesh = "board.ply"
position = [0.03, 0, 0.05]
rpy_deg = [0, 90, 0]
[[part]]
name = "block"
mesh = "block.ply"
held = true
position = [0, 0, 0.03]
[[part]]
name = "aside"
mesh = "block.ply"
position = [0.08, 0, 0.04]
[device]
script = "down.csv"
)");
  return load_scene(folder / "scene.toml");
}

/// Looks at every tick, and counts what its thread allocates or frees from the 100th on.
class Looker final : public RunObserver {
 public:
  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override {
    gaps += tick.tick == next ? 0 : 1;
    next = tick.tick + 1;
    if (tick.segment != segment) ++went_over;
    segment = tick.segment;
    if (tick.tick == 100) guard.emplace();
    if (guard && over) {
      allocations = guard->count();
      guard.reset();
      stop = true;
    }
    ticks = next;
  }
  std::uint64_t next = 0, segment = 0, went_over = 0, gaps = 0, allocations = 0;
  std::atomic<std::uint64_t> ticks{0};
  std::atomic<bool> over{false}, stop{false};
  std::optional<AllocGuard> guard;
};

}  // namespace

TEST_CASE("a session's scene is changed from another thread; its ticks allocate nothing", "[change]") {
  const TempFolder folder;
  const SceneFile file = scene_in(folder);
  Looker looker;
  RunEdits edits;
  RunSettings settings;
  settings.seconds = 60;
  settings.record = folder / "run.csv";
  settings.observer = &looker;
  settings.edits = &edits;
  settings.stop = &looker.stop;
  CHECK_THROWS_WITH(edits.change(file.scene.parts), Contains("has not begun"));

  constexpr int kChanges = 24;
  std::uint64_t told_wrong = 0, refused = 0;
  std::thread changer([&] {
    while (looker.ticks < 150) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::vector<Part> parts = file.scene.parts;
    for (int i = 1; i <= kChanges; ++i) {
      // Without the wall, with it and another one held, without it again, and so on.
      std::vector<Part> next = parts;
      if (i % 2 == 1) next.erase(next.begin() + 1);
      const std::string held = i % 4 < 2 ? "block" : "aside";
      for (Part& p : next) p.held = p.name == held;
      const std::vector<Part> now =
          edits.change(next, [&](std::uint64_t n) { told_wrong += n != std::uint64_t(i) ? 1 : 0; });
      for (const Part& p : now)
        for (Part& q : parts)
          if (p.name == q.name) q.pose = p.pose;
      std::vector<Part> nobody = next;
      for (Part& p : nobody) p.held = false;
      try {
        edits.change(nobody);
      } catch (const Error&) {
        ++refused;
      }
    }
    looker.over = true;
  });
  const RunSummary summary = run_session(file, settings);
  changer.join();
  CHECK(told_wrong == 0);
  CHECK(refused == kChanges);
  CHECK(looker.went_over == kChanges);
  CHECK(looker.gaps == 0);
  CHECK(looker.allocations == 0);
  CHECK(summary.penetrating == 0);
  CHECK(summary.record_dropped == 0);
  CHECK(summary.recordings.size() == kChanges + 1);
  // Where the run has ended there is nothing to change.
  CHECK_THROWS_WITH(edits.change(file.scene.parts), Contains("is over"));
}

TEST_CASE("a change that cannot be recorded changes nothing", "[change]") {
  const TempFolder folder;
  const SceneFile file = scene_in(folder);
  Looker looker;
  RunEdits edits;
  RunSettings settings;
  settings.seconds = 60;
  settings.record = folder / "run.csv";
  settings.edits = &edits;
  settings.observer = &looker;
  settings.stop = &looker.stop;
  std::string error, other_error;
  bool kept = false;
  std::thread changer([&] {
    while (looker.ticks < 150) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::vector<Part> parts = file.scene.parts;
    parts.pop_back();
    const auto error_of_change = [&] {
      try {
        edits.change(parts);
      } catch (const Error& e) {
        return std::string(e.what());
      }
      return std::string();
    };
    std::filesystem::create_directory(folder / "run.2.csv");  // in the way of the next recording
    error = error_of_change();
    kept = std::filesystem::exists(folder / "run.2.csv");
    std::filesystem::remove(folder / "run.2.csv");
    // The next scene's file would be the one that runs.
    std::filesystem::create_symlink(folder / "scene.toml", folder / "run.2.toml");
    other_error = error_of_change();
    std::filesystem::remove(folder / "run.2.toml");
    looker.over = true;
  });
  const RunSummary summary = run_session(file, settings);
  changer.join();
  CHECK_THAT(error, Contains("run.2.csv"));
  CHECK(kept);
  CHECK_THAT(other_error, Contains("run.2.toml: would be replaced, but is read"));
  CHECK(looker.went_over == 0);
  CHECK(summary.recordings == std::vector<std::string>{folder / "run.csv"});
  CHECK_FALSE(std::filesystem::exists(folder / "run.2.toml"));
}

// What the servo tells before it has heard of the new part is the old part's: followed, it would throw the new one.
TEST_CASE("a pen that takes another part tells nothing until its servo has heard of it", "[change]") {
  const TempFolder folder;
  const SceneFile file = scene_in(folder);
  const HapticLoop loop(file.scene);
  SimulatedDevice device(file.device, file.script, loop.center());
  const auto pen = make_local_pen(device, {}, false, file.scene.scale, loop);
  std::int64_t now = 0;
  PenSample sample;
  ProxyState proxy;
  proxy.X = held_part(file.scene).pose;
  const auto publish = [&] { pen->publish(proxy, {}, 1, sample.state.sequence, now); };
  const auto servo = [&] {
    pen->tick_servo(now);
    pen->advance(1e-3);
    now += 1'000'000;
  };
  pen->start();
  servo();
  REQUIRE(pen->read(sample, now));
  publish();
  servo();
  REQUIRE(pen->read(sample, now));
  CHECK(sample.state.pose.p.isApprox(proxy.X.p, 1e-2));

  proxy.X.p = Vec3(0.08, 0, 0.04);
  pen->grasp(loop.center(), loop.coupling(), proxy.X);
  CHECK(!pen->read(sample, now));
  servo();  // it has not heard yet
  CHECK(!pen->read(sample, now));
  publish();
  CHECK(!pen->read(sample, now));
  servo();
  REQUIRE(pen->read(sample, now));
  CHECK((sample.state.pose.p - proxy.X.p).norm() < 1e-3);
  pen->stop();
}
