// What the observer counts of a pen that is read in steps, against the work of the pen's true motion.
#include <cmath>
#include <functional>

#include "catch.hpp"
#include "coupling/passivity.hpp"
#include "coupling/pen_steps.hpp"

using namespace tegotae;

namespace {

constexpr double kStiffness = 12800, kResolution = 3e-5, kTick = 1e-3;

struct Energy {
  double counted = 0;  ///< J, what the observer calls generated
  double made = 0;     ///< J, that the sampled spring gave the pen: work of the held force on the true way
};

/// A spring without a damper, held over each tick, on a pen at `x` (m) of the time in ticks, for so many of them. Its
/// true way takes the force of the reading before.
Energy watch(const std::function<double(double)>& x, int ticks) {
  const CouplingSettings coupling{kStiffness, 0, 0, 0};
  const auto read = [&](int tick) { return kResolution * std::round(x(tick) / kResolution); };
  PassivitySettings settings;
  settings.credit = 0;
  Passivity passivity(settings);
  PenSteps steps;
  Energy energy;
  double at = read(0), stored = 0.5 * kStiffness * at * at;
  passivity.observe({}, {}, stored, false, kTick);
  for (int i = 1; i <= ticks; ++i) {
    const Displacement moved{Vec3(read(i) - at, 0, 0), Vec3::Zero()};
    const Wrench held{Vec3(-kStiffness * at, 0, 0), Vec3::Zero()};
    energy.made += held.force.x() * (x(i) - x(i - 1));
    at = read(i);
    stored = 0.5 * kStiffness * at * at;
    passivity.observe(moved, held, stored, true, kTick, steps.energy(moved, coupling, kResolution, kTick));
  }
  energy.made += 0.5 * kStiffness * (x(ticks) * x(ticks) - x(0) * x(0));
  energy.counted = -passivity.energy();
  return energy;
}

}  // namespace

TEST_CASE("of a slow pen each step counts the Nth part of 1/2 k res^2", "[coupling]") {
  const double step = 0.5 * kStiffness * kResolution * kResolution;
  for (int n : {1, 2, 5, 20}) {
    // The true places lie evenly on both sides of their readings, so that rounding by itself does no work.
    const double from = n % 2 == 0 ? 0.5 / n : 0;
    const Energy energy = watch([=](double tick) { return kResolution * (tick / n + from); }, 100 * n);
    CAPTURE(n);
    // 1/2 k (res / N)^2 in each tick; the first step may be the way back of an earlier one.
    CHECK(energy.made == Approx(100 * step / n));
    CHECK(energy.counted == Approx(99 * step / n));
  }
}

TEST_CASE("a pen that rests between two steps makes nothing", "[coupling]") {
  for (int period : {2, 3, 7, 40}) {
    const auto rattle = [period](double tick) {
      return kResolution * (10.5 + 1e-3 * std::cos(2 * M_PI * tick / period));
    };
    const Energy energy = watch(rattle, 1000);
    CAPTURE(period);
    CHECK(std::abs(energy.counted) < 1e-15);
  }
}

TEST_CASE("a swing over some steps counts as what it makes", "[coupling]") {
  for (double amplitude : {2.0, 3.3, 9.0})
    for (double hz : {35.0, 68.0, 110.0}) {
      const auto swing = [=](double tick) {
        return kResolution * (15 + amplitude * std::sin(2 * M_PI * hz * kTick * tick));
      };
      const Energy energy = watch(swing, 5000);
      CAPTURE(amplitude, hz, energy.counted, energy.made);
      CHECK(energy.made > 100 * 0.5 * kStiffness * kResolution * kResolution);
      CHECK(energy.counted > 0.5 * energy.made);
      CHECK(energy.counted < 1.5 * energy.made);
    }
}

TEST_CASE("a pen that moves by two steps in a tick, or has no steps, gets nothing", "[coupling]") {
  const CouplingSettings coupling;
  const double turn = 2 * kResolution / coupling_radius(coupling);
  PenSteps steps;
  for (int i = 0; i < 10; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    CHECK(steps.energy({Vec3(0, sign * 2 * kResolution, 0), Vec3(turn, 0, 0)}, coupling, kResolution, kTick) == 0);
    CHECK(steps.energy({Vec3(0, sign * kResolution, 0), Vec3::Zero()}, coupling, 0, kTick) == 0);
  }
  // Each axis by itself, and a turn at the coupling's radius: half k res^2 and d res^2 / T of the one that turns back.
  const double step = 0.5 * kResolution;
  CHECK(steps.energy({Vec3(0, step, 0), Vec3::Zero()}, coupling, kResolution, kTick) ==
        Approx((0.5 * coupling.stiffness + coupling.damping / kTick) * step * step));
  CHECK(steps.energy({Vec3::Zero(), Vec3(-turn / 4, 0, 0)}, coupling, kResolution, kTick) ==
        Approx((0.5 * coupling.torsional_stiffness + coupling.torsional_damping / kTick) * turn * turn / 16));
}
