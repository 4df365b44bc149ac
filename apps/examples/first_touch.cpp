#include <cstdio>
#include <tegotae/tegotae.hpp>

using namespace tegotae;

int main() try {
  Scene scene;
  scene.add_fixed("hole", load_mesh("models/hole_20.obj", unit_length("mm")));
  scene.add_held("peg", load_mesh("models/peg_0.94.obj", unit_length("mm")), {Quat::Identity(), Vec3(0, 0, 0.03)});

  const Pose above{Quat::Identity(), Vec3(0.004, 0, 0.03)}, below{Quat::Identity(), Vec3(0.004, 0, 0.02)};  // m
  SimulatedDevice pen({}, StylusScript({{0.0, above}, {0.5, below}}));  // a hand that goes down, off the axis
  Rig rig(scene, pen, {RigClock::simulated});                           // throws Error when the parts overlap

  rig.start();
  rig.run(0.6, [](const Rig& r) {  // s
    if (r.steps() % 100 != 1) return;
    std::printf("%3.0f ms: %2zu contacts, %5.2f N up\n", 1e3 * r.time(), r.contacts().size(), r.pen().wrench.force.z());
  });
  rig.stop();
} catch (const Error& e) {
  return std::fprintf(stderr, "first_touch: %s\n", e.what()), 2;
}
