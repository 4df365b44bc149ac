// A pen without hardware whose hand follows a script; servo and contact loop take turns in virtual time. The same
// program always prints the same numbers. Real time is one call: servo.start() (see own_loop.cpp).
#include <cstdio>
#include <limits>
#include <memory>

#include "tegotae/device/simulated_device.hpp"
#include "tegotae/mesh/load.hpp"
#include "tegotae/servo/contact_link.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/sim/haptic_loop.hpp"

using namespace tegotae;

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: scripted_pen FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const std::string folder = argv[1];
  const auto load = [&](const char* file) {
    return std::make_shared<TriangleMesh>(load_mesh(folder + "/" + file, unit_length("mm")));
  };
  Scene scene;
  scene.parts.push_back({"hole", load("hole_20.obj"), Pose{}, false});
  scene.parts.push_back({"peg", load("peg_0.94.obj"), Pose{Quat::Identity(), Vec3(0, 0, 0.03)}, true});
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();  // work alone decides: repeatable
  HapticLoop loop(scene);

  // Down onto the rim, four millimeters off the axis, in half a second.
  const StylusScript script(
      {{0.0, Pose{Quat::Identity(), Vec3(0.004, 0, 0.03)}}, {0.5, Pose{Quat::Identity(), Vec3(0.004, 0, 0.02)}}});
  SimulatedDevice pen({}, script, loop.center());
  Channel channel = Channel::create();
  Servo servo(pen, channel);
  ContactLink link(channel, loop.coupling(), loop.center());

  pen.start();
  for (std::uint64_t ms = 0; ms <= 600; ++ms) {
    const auto now_ns = static_cast<std::int64_t>(ms) * 1'000'000;
    servo.tick(now_ns);
    PenSample sample;
    if (link.read(sample)) {
      const TickReport& tick = loop.step(sample.state.pose, 1e-3);
      link.publish(tick.proxy, ms, sample.state.sequence, now_ns);
      if (ms % 100 == 0)
        std::printf("%3d ms: pen %6.2f mm, peg %6.2f mm, %2d contacts, %5.2f N up\n", static_cast<int>(ms),
                    1e3 * sample.state.pose.p.z(), 1e3 * tick.proxy.X.p.z(), tick.contacts, sample.wrench.force.z());
    }
    pen.advance(1e-3);
  }
  pen.stop();
}
