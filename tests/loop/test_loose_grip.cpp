// A coupling far above the limits in a grip that damps little is unstable, and the passivity controller has to see it
// through the steps of a real pen: judged by the force that is rendered.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "bodies.hpp"
#include "catch.hpp"
#include "loop/pen_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

SimulatedDeviceSettings loose_grip() {
  SimulatedDeviceSettings settings;
  settings.hand.stiffness = 100;
  settings.hand.damping = 2;
  settings.hand.mass = 0.02;
  return settings;
}

struct Press {
  double low = 1e9, high = 0;  ///< N, of the second after the hand has come to rest
  bool off = false;            ///< the force went off as unstable
  double swing() const { return high - low; }
};

/// Presses a cube of 40 mm on a floor, the hand `depth` (m) below where they touch.
Press press(double stiffness, double depth, bool control) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.coupling.stiffness = stiffness;
  scene.max_torsional_stiffness = kMaxTorsional;
  const Vec3 above(0, 0, 0.022), below(0, 0, 0.02 - depth);
  scene.parts.push_back({"floor", shared(box({0.3, 0.3, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"cube", shared(box({0.04, 0.04, 0.04})), {Quat::Identity(), above}, true});
  const StylusScript script({{0, {Quat::Identity(), above}}, {0.4, {Quat::Identity(), below}}});
  ServoSettings servo;
  servo.safety.passivity_control = control;
  PenRun hand(scene, script, loose_grip(), servo);
  Press result;
  for (int i = 0; i < 2000; ++i) {
    const PenSample pen = hand.tick();
    result.off |= pen.reason == ForceOff::energy;
    if (i < 1000) continue;
    result.low = std::min(result.low, pen.wrench.force.z());
    result.high = std::max(result.high, pen.wrench.force.z());
  }
  return result;
}

}  // namespace

TEST_CASE("in a loose grip a stiff coupling swings by three steps of the pen's resolution at most", "[law]") {
  const double resolution = loose_grip().position_resolution;
  for (double stiffness : {6400.0, 9000.0, 12800.0, 16000.0}) {
    double worst = 0, free = 0;
    for (int i = 0; i < 9; ++i) {
      const double depth = 0.0125 + 7.3e-4 * i;  // 1.2 to 1.8 N
      const Press damped = press(stiffness, depth, true);
      CAPTURE(stiffness, depth, damped.low, damped.high);
      CHECK_FALSE(damped.off);
      CHECK(damped.low > 0.5);
      CHECK(damped.swing() < 3 * stiffness * resolution);
      worst = std::max(worst, damped.swing());
      free = std::max(free, press(stiffness, depth, false).swing());
    }
    std::cout << stiffness << " N/m: swings by up to " << worst << " N, without the controller " << free << " N\n";
    // There is something to damp: else this tests nothing.
    if (stiffness > 12000) CHECK(free > 4 * 3 * stiffness * resolution);
  }
}
