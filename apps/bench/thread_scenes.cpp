#include "bench/thread_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "models/gear.hpp"
#include "models/threaded.hpp"

namespace tegotae::bench {
namespace {

constexpr double kTurnsPerSecond = 0.5;  // turns of a nut a second
constexpr int kFclPoses = 100;
constexpr double kRamp = 0.1;  // s, in which a pen begins to press
const char* const kNut = "nut16";
const char* const kPressed = "nut16-pressed";
const char* const kHand = "nut16-hand";
const char* const kGears = "gears";

/// Where a nut is on its thread: `turns` from where it starts.
Pose on_thread(const Vec3& start, double pitch, double turns) {
  return {rotation(Vec3(0, 0, 2 * kPi * turns)), start + Vec3(0, 0, pitch * turns)};
}

/// An M16 nut on a bolt, 28 k and 13 k triangles, that the pen turns down.
BenchScene make_nut(const std::string& name) {
  BenchScene bench;
  shapes::Bolt bolt;
  bolt.thread.rows = 4;
  shapes::Nut nut;
  nut.thread = bolt.thread;
  const double pitch = bolt.thread.pitch;
  const Vec3 start(0, 0, 0.012);
  add_part(bench, "bolt", shared(shapes::bolt(bolt)), {}, false);
  add_part(bench, "nut", shared(shapes::nut(nut)), {Quat::Identity(), start}, true);
  bench.pen_seconds = 5;
  bench.all_ticks = true;
  // FCL is asked where the nut is pressed into a flank.
  for (int i = 0; i < kFclPoses; ++i) {
    const double overlap = bench.overlap * (i + 0.5) / kFclPoses;
    Pose X = on_thread(start, pitch, -2.5 * i / kFclPoses);
    X.p.z() += (i % 2 == 0 ? 1 : -1) * (nut.play + overlap);
    bench.jam_poses.push_back(X);
  }
  // Down, 2.5 turns.
  const auto free = [=](double t) { return on_thread(start, pitch, -kTurnsPerSecond * t); };
  if (name == kNut) {
    bench.targets = {30, 300, 150};
    bench.pen = free;
  } else if (name == kPressed) {
    bench.targets = {250, 900, 20};
    bench.pen = [=](double t) {
      Pose Y = free(t);
      Y.p.z() += 1e-3 * std::min(1.0, t / kRamp);
      return Y;
    };
  } else {
    bench.targets = {400, 900, 10};
    // 1 mm and 30 mrad at 1 to 2 Hz.
    bench.pen = [=](double t) {
      const Pose Y = free(t);
      const double w = 2 * kPi * std::min(1.0, t / kRamp);
      const Vec3 way = 1e-3 * Vec3(std::sin(w * t), std::sin(1.3 * w * t), std::sin(0.7 * w * t));
      const Vec3 lean = 0.03 * Vec3(std::sin(1.7 * w * t), std::sin(1.9 * w * t), std::sin(1.1 * w * t));
      return Pose{rotation(lean) * Y.q, Y.p + way};
    };
  }
  return bench;
}

/// A gear of 20 teeth between two of 30, which stand still: the pen puts it in along its axis, presses its flanks one
/// way and the other, and takes it out.
BenchScene make_gears() {
  BenchScene bench;
  shapes::Gear small;
  small.teeth = 20;
  small.flank = 10;
  small.layers = 8;
  shapes::Gear large = small;
  large.teeth = 30;
  const auto mesh = shared(shapes::gear(large));
  const double apart = small.module * (small.teeth + large.teeth) / 2.0;
  const Quat half_tooth = rotation(Vec3(0, 0, kPi / large.teeth));
  add_part(bench, "left gear", mesh, {half_tooth, Vec3(-apart, 0, 0)}, false);
  add_part(bench, "right gear", mesh, {half_tooth, Vec3(apart, 0, 0)}, false);
  const double above = 1.2 * small.width, seconds = 5;
  bench.pen_seconds = seconds;
  bench.pen = [=](double t) {
    const double in = std::min({1.0, t, seconds - t});  // a second each way
    const double turn = 0.06 * std::max(0.0, in) * std::sin(2 * kPi * t / 1.5);
    return Pose{rotation(Vec3(0, 0, turn)), Vec3(2e-4 * std::sin(2 * kPi * t), 0, above * (1 - std::max(0.0, in)))};
  };
  add_part(bench, "small gear", shared(shapes::gear(small)), bench.pen(0), true);
  bench.targets = {150, 900, 20};
  return bench;
}

}  // namespace

const std::vector<std::string>& thread_scene_names() {
  static const std::vector<std::string> names = {kNut, kPressed, kHand, kGears};
  return names;
}

BenchScene make_thread_scene(const std::string& name) {
  return name == kGears ? make_gears() : make_nut(name);
}

}  // namespace tegotae::bench
