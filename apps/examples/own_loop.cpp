// An application that owns its loop, here a drawing loop of 60 Hz: it reads the pen once, moves the part once, and
// publishes once a frame. The servo renders at 1 kHz in a thread of its own. Frames are slower than the servo's
// watchdog allows by default (20 ms without news turn the force off), so that is widened, and stays a safety net.
#include <cstdio>
#include <memory>
#include <thread>

#include "tegotae/core/clock.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/mesh/load.hpp"
#include "tegotae/servo/contact_link.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/sim/haptic_loop.hpp"

using namespace tegotae;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: own_loop FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const std::string folder = argv[1];
  const auto load = [&](const char* file) {
    return std::make_shared<TriangleMesh>(load_mesh(folder + "/" + file, unit_length("mm")));
  };
  Scene scene;
  scene.parts.push_back({"hole", load("hole_20.obj"), Pose{}, false});
  scene.parts.push_back({"peg", load("peg_0.94.obj"), Pose{Quat::Identity(), Vec3(0, 0, 0.03)}, true});
  HapticLoop loop(scene);

  SimulatedDeviceSettings device;
  device.wall_clock = true;  // the hand moves on with the clock
  SimulatedDevice pen(device,
                      StylusScript({{0.0, Pose{Quat::Identity(), Vec3(0.004, 0, 0.03)}},
                                    {0.5, Pose{Quat::Identity(), Vec3(0.004, 0, 0.02)}}}),
                      loop.center());
  Channel channel = Channel::create();
  ServoSettings settings;
  settings.safety.heartbeat_timeout = 0.2;  // s
  Servo servo(pen, channel, settings);
  ContactLink link(channel, loop.coupling(), loop.center());

  pen.start();
  servo.start();
  constexpr double kFrame = 1.0 / 60;  // s
  for (std::uint64_t frame = 0; frame <= 60; ++frame) {
    PenSample sample;
    if (link.read(sample)) {
      const TickReport& tick = loop.step(sample.state.pose, kFrame);           // read once, move once
      link.publish(tick.proxy, frame, sample.state.sequence, monotonic_ns());  // write once
      if (frame % 10 == 0)
        std::printf("frame %2d: %2d contacts, %5.2f N up\n", static_cast<int>(frame), tick.contacts,
                    sample.wrench.force.z());
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(kFrame));  // draw here
  }
  servo.stop();
  pen.stop();
  std::printf("%d servo ticks\n", static_cast<int>(servo.statistics().ticks));
}
