// A device of one's own: six virtual functions between a vendor's driver and the servo. This one has no driver; its
// "hardware" is a mass on a rail along z that somebody pushes down with 2 N.
#include <cstdio>
#include <limits>
#include <memory>

#include "tegotae/mesh/load.hpp"
#include "tegotae/servo/contact_link.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/sim/haptic_loop.hpp"

using namespace tegotae;

class RailPen final : public Device {
 public:
  void start() override { on_ = true; }
  void stop() override { on_ = false; }
  DeviceState read() noexcept override {
    DeviceState state;
    state.pose.p = Vec3(0.004, 0, z_);
    state.velocity.v = Vec3(0, 0, v_);
    state.sequence = n_++;
    return state;
  }
  void write(const Wrench& wrench) noexcept override { force_ = wrench.force.z(); }
  DeviceStatus status() const noexcept override { return on_ ? DeviceStatus::enabled : DeviceStatus::uninitialized; }
  ForceOff reason() const noexcept override { return on_ ? ForceOff::none : ForceOff::software; }

  /// The rail's physics for `dt` seconds: a push, the rendered force, some friction; 0.3 kg.
  void move(double dt) {
    v_ += dt * (-2.0 + force_ - 8.0 * v_) / 0.3;
    z_ += dt * v_;
  }

 private:
  bool on_ = false;
  double z_ = 0.03, v_ = 0, force_ = 0;
  std::uint64_t n_ = 0;
};

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: custom_device FOLDER  (with hole_20.obj and peg_0.94.obj)\n");
    return 2;
  }
  const std::string folder = argv[1];
  const auto load = [&](const char* file) {
    return std::make_shared<TriangleMesh>(load_mesh(folder + "/" + file, unit_length("mm")));
  };
  Scene scene;
  scene.parts.push_back({"hole", load("hole_20.obj"), Pose{}, false});
  scene.parts.push_back({"peg", load("peg_0.94.obj"), Pose{Quat::Identity(), Vec3(0, 0, 0.03)}, true});
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();  // not bounded by the clock: repeatable
  HapticLoop loop(scene);
  RailPen pen;
  Channel channel = Channel::create();
  Servo servo(pen, channel);
  ContactLink link(channel, loop.coupling(), loop.center());

  pen.start();
  PenSample sample;
  for (std::uint64_t ms = 0; ms <= 1500; ++ms) {
    const auto now_ns = static_cast<std::int64_t>(ms) * 1'000'000;
    servo.tick(now_ns);
    if (!link.read(sample)) continue;
    const TickReport& tick = loop.step(sample.state.pose, 1e-3);
    link.publish(tick.proxy, ms, sample.state.sequence, now_ns);
    pen.move(1e-3);
  }
  pen.stop();
  std::printf("at rest: %.2f N up against a push of 2 N\n", sample.wrench.force.z());
}
