// A device of one's own: seven virtual functions between a vendor's driver and the servo. This one has no driver; its
// "hardware" is a mass on a rail along z that somebody pushes down with 2 N.
#include <cstdio>
#include <string>
#include <tegotae/tegotae.hpp>

using namespace tegotae;

class RailPen final : public Device {
 public:
  DeviceInfo info() const override {
    DeviceInfo rail;
    rail.name = "rail";
    rail.motion_freedom = rail.force_freedom = 3;
    rail.limits.force = 10;      // N
    rail.continuous_force = 10;  // N
    rail.damping = 8;            // N·s/m
    return rail;
  }
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

  /// The rail's physics for `dt` seconds: a push, the rendered force, some friction; 0.3 kg. Hardware has its own.
  void advance(double dt) noexcept override {
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
  Scene scene;
  scene.add_fixed("hole", load_mesh(folder + "/hole_20.obj", unit_length("mm")));
  scene.add_held("peg", load_mesh(folder + "/peg_0.94.obj", unit_length("mm")), {Quat::Identity(), Vec3(0, 0, 0.03)});
  RailPen pen;
  Rig rig(scene, pen, {RigClock::simulated});
  rig.start();
  rig.run(1.5, [](const Rig&) {});
  rig.stop();
  std::printf("at rest: %.2f N up against a push of 2 N\n", rig.pen().wrench.force.z());
}
