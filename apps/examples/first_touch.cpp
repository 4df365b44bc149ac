#include <cstdio>
#include <memory>

#include "tegotae/mesh/load.hpp"
#include "tegotae/sim/haptic_loop.hpp"

using namespace tegotae;

int main() {
  const auto load = [](const char* file) { return std::make_shared<TriangleMesh>(load_mesh(file, unit_length("mm"))); };
  Scene scene;
  scene.parts.push_back({"hole", load("models/hole_20.obj"), Pose{}, false});
  scene.parts.push_back({"peg", load("models/peg_0.94.obj"), Pose{Quat::Identity(), Vec3(0, 0, 0.03)}, true});  // held
  HapticLoop loop(scene);  // throws Error when the parts overlap

  for (int ms = 0; ms <= 500; ++ms) {
    const Pose pen{Quat::Identity(), Vec3(0.004, 0, 0.03 - 2e-5 * ms)};  // m: down, four millimeters off the axis
    const TickReport& tick = loop.step(pen, 1e-3);                       // as near to the pen as the parts allow
    const Wrench feel = coupling_wrench(scene.coupling, tick.proxy, pen, {Vec3(0, 0, -0.02)}, loop.center());
    if (ms % 100 == 0) std::printf("%3d ms: %2d contacts, %5.2f N up\n", ms, tick.contacts, feel.force.z());
  }
}
