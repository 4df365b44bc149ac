// The passivity controller is there for what is unstable. A hand that comes to rest on a part, or slides it slowly,
// must never meet it: counted over random scenes with default settings.
#include <array>
#include <cmath>
#include <iostream>

#include "catch.hpp"
#include "loop/pen_run.hpp"
#include "loop/pocket.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr int kScenes = 200;
constexpr double kRest = 0.5;  // s, after each motion

/// The simulated pen, of which nobody knows how much it damps: so are most real ones.
class UnknownDamping final : public Device {
 public:
  explicit UnknownDamping(SimulatedDevice& device) : device_(device) {}
  DeviceInfo info() const override {
    DeviceInfo info = device_.info();
    info.damping = info.torsional_damping = 0;
    return info;
  }
  void start() override { device_.start(); }
  void stop() override { device_.stop(); }
  DeviceState read() noexcept override { return device_.read(); }
  void write(const Wrench& wrench) noexcept override { device_.write(wrench); }
  DeviceStatus status() const noexcept override { return device_.status(); }
  ForceOff reason() const noexcept override { return device_.reason(); }
  Vec3 reference_point() const noexcept override { return device_.reference_point(); }
  void set_held_center(const Vec3& center) noexcept override { device_.set_held_center(center); }

 private:
  SimulatedDevice& device_;
};

std::unique_ptr<Device> of_unknown_damping(SimulatedDevice& device) {
  return std::make_unique<UnknownDamping>(device);
}

Scene random_scene(unsigned seed) {
  Scene scene = pocket(seed, std::array{0.005, 0.02, 0.06}[seed % 3], 2 + static_cast<int>(seed % 4));
  scene.max_torsional_stiffness = kMaxTorsional;
  return scene;
}

/// How far (m) the held part goes straight down before it touches; NaN when it does not.
double way_down(const Scene& scene, double most) {
  HapticLoop loop(scene);
  const Pose from = scene.parts.back().pose;
  for (double way = 0; way < most; way += 2e-4)
    if (loop.step({from.q, from.p - Vec3(0, 0, way)}, 1e-3).proxy.touching) return way;
  return NAN;
}

struct Count {
  std::int64_t ticks = 0, touching = 0, damped = 0, off = 0;
  double energy = 0, force = 0;  ///< J, least; N, largest
};

/// Presses by some millimeters, rests, slides and turns slowly, rests, and leaves.
StylusScript pen_script(const Pose& from, double way, std::mt19937& rng) {
  const Pose above{from.q, from.p - Vec3(0, 0, way - 1e-3)};
  const Vec3 press(0, 0, -2e-3 - std::abs(random_vector(rng, 4e-3).x()));
  const Pose pressed{from.q, above.p + press};
  Vec3 aside = random_vector(rng, 8e-3);
  aside.z() = 0;
  const Pose slid{rotation(random_vector(rng, 0.1)) * from.q, pressed.p + aside};
  return StylusScript({{0, above},
                       {0.4, above},
                       {0.9, pressed},
                       {0.9 + kRest, pressed},
                       {1.9 + kRest, slid},
                       {1.9 + 2 * kRest, slid},
                       {2.4 + 2 * kRest, above}});
}

void run(const Scene& scene, const StylusScript& script, bool damping_known, Count& count) {
  Scene placed = scene;
  placed.parts.back().pose = script.pose(0);
  PenRun hand(placed, script, {}, {}, damping_known ? nullptr : of_unknown_damping);
  for (int i = 0; 1e-3 * i < script.end() + 0.2; ++i) {
    const PenSample pen = hand.tick();
    ++count.ticks;
    count.touching += hand.loop.report().proxy.touching ? 1 : 0;
    count.damped += (pen.flags & TEGOTAE_SHM_FLAG_DAMPED) != 0 ? 1 : 0;
    count.off += pen.reason == ForceOff::energy ? 1 : 0;
    count.energy = std::min(count.energy, pen.energy);
    count.force = std::max(count.force, pen.wrench.force.norm());
  }
}

}  // namespace

TEST_CASE("at rest and in slow sliding the passivity controller does nothing", "[law]") {
  const bool damping_known = GENERATE(true, false);
  CAPTURE(damping_known);
  Count all;
  int scenes = 0, acted = 0;
  for (unsigned seed = 1; scenes < kScenes; ++seed) {
    REQUIRE(seed < 2 * kScenes);
    const Scene scene = random_scene(seed);
    const double way = way_down(scene, 2 * scene.parts.back().pose.p.z());
    if (std::isnan(way)) continue;
    std::mt19937 rng(seed);
    Count one;
    run(scene, pen_script(scene.parts.back().pose, way, rng), damping_known, one);
    ++scenes;
    acted += one.damped > 0 ? 1 : 0;
    if (one.damped > 0)
      std::cout << "seed " << seed << ": damped in " << one.damped << " ticks, " << one.energy << " J\n";
    all.ticks += one.ticks;
    all.touching += one.touching;
    all.damped += one.damped;
    all.off += one.off;
    all.energy = std::min(all.energy, one.energy);
    all.force = std::max(all.force, one.force);
  }
  std::cout << scenes << " scenes, " << all.ticks << " ticks, " << all.touching << " touching, up to " << all.force
            << " N: damped in " << all.damped << " ticks of " << acted << " scenes, least energy " << all.energy
            << " J\n";
  CHECK(all.touching > all.ticks / 3);
  CHECK(all.force > 1);
  CHECK(all.damped == 0);
  CHECK(all.off == 0);
}
