// A pen without hardware whose hand follows a script; servo and contact loop take turns in simulated time. The same
// program always prints the same numbers. In real time it is the same without RigClock::simulated (see own_loop.cpp).
#include <cstdio>
#include <string>
#include <tegotae/tegotae.hpp>

using namespace tegotae;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: scripted_pen FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const std::string folder = argv[1];
  const Pose start{Quat::Identity(), Vec3(0, 0, 0.03)};
  Scene scene;
  scene.add_fixed("hole", load_mesh(folder + "/hole_20.obj", unit_length("mm")));
  scene.add_held("peg", load_mesh(folder + "/peg_0.94.obj", unit_length("mm")), start);

  // Down onto the rim, four millimeters off the axis, in half a second.
  SimulatedDevice pen({}, StylusScript({{0.0, Pose{Quat::Identity(), Vec3(0.004, 0, 0.03)}},
                                        {0.5, Pose{Quat::Identity(), Vec3(0.004, 0, 0.02)}}}));
  Rig rig(scene, pen, {RigClock::simulated});
  rig.start();
  rig.run(0.601, [](const Rig& r) {
    if (r.steps() % 100 == 1)
      std::printf("%3.0f ms: pen %6.2f mm, peg %6.2f mm, %2zu contacts, %5.2f N up\n", 1e3 * r.time(),
                  1e3 * r.pen().state.pose.p.z(), 1e3 * r.part().p.z(), r.contacts().size(), r.pen().wrench.force.z());
  });
  rig.stop();
}
