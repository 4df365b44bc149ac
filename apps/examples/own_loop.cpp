// An application that owns its loop, here a drawing loop of 60 Hz: one step of the rig a frame. The servo renders at
// 1 kHz in a thread of its own. Frames are slower than the servo's watchdog allows by default (20 ms without news turn
// the force off), so that is widened, and stays a safety net.
#include <chrono>
#include <cstdio>
#include <string>
#include <tegotae/tegotae.hpp>
#include <thread>

using namespace tegotae;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: own_loop FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const std::string folder = argv[1];
  Scene scene;
  scene.add_fixed("hole", load_mesh(folder + "/hole_20.obj", unit_length("mm")));
  scene.add_held("peg", load_mesh(folder + "/peg_0.94.obj", unit_length("mm")), {Quat::Identity(), Vec3(0, 0, 0.03)});

  SimulatedDevice pen({}, StylusScript({{0.0, Pose{Quat::Identity(), Vec3(0.004, 0, 0.03)}},
                                        {0.5, Pose{Quat::Identity(), Vec3(0.004, 0, 0.02)}}}));
  RigSettings settings;
  settings.servo.safety.heartbeat_timeout = 0.2;  // s
  Rig rig(scene, pen, settings);
  rig.start();
  for (int frame = 0; frame <= 60; ++frame) {
    rig.step();  // reads the pen, moves the part, publishes both to the servo
    if (frame % 10 == 0)
      std::printf("frame %2d: %2zu contacts, %5.2f N up\n", frame, rig.contacts().size(), rig.pen().wrench.force.z());
    std::this_thread::sleep_for(std::chrono::duration<double>(1.0 / 60));  // draw here
  }
  rig.stop();
  std::printf("%d servo ticks\n", static_cast<int>(rig.servo_statistics().ticks));
}
