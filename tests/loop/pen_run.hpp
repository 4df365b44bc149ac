// The simulated pen at a contact loop, through servo and safety chain, in virtual time: for tests of what a hand feels.
#pragma once

#include <memory>

#include "catch.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae::test {

/// What a scene file that leaves the torsional stiffness open has with the simulated pen, N·m/rad.
inline constexpr double kMaxTorsional = 3.76;

class PenRun {
 public:
  /// What the servo has of the pen instead of the pen itself.
  using Mask = std::unique_ptr<Device> (*)(SimulatedDevice&);

  PenRun(const Scene& scene, const StylusScript& script, const SimulatedDeviceSettings& pen = {},
         const ServoSettings& servo = {}, Mask mask = nullptr)
      : loop(scene),
        device_(pen, script, loop.center()),
        seen_(mask ? mask(device_) : nullptr),
        servo_(seen_ ? *seen_ : device_, channel_, servo),
        link_(channel_, loop.coupling(), loop.center()) {
    device_.start();
  }

  /// A millisecond. The sample has the pen before it and the wrench that it renders; loop.report() is the tick's.
  PenSample tick() {
    constexpr std::int64_t kPeriodNs = 1'000'000;
    const auto now = static_cast<std::int64_t>(ticks_) * kPeriodNs;
    servo_.tick(now);
    PenSample pen;
    REQUIRE(link_.read(pen));
    const TickReport& report = loop.step(pen.state.pose, 1e-3);
    link_.publish(report.proxy, ticks_++, pen.state.sequence, now, report.planes);
    device_.advance(1e-3);
    return pen;
  }

  HapticLoop loop;

 private:
  SimulatedDevice device_;
  std::unique_ptr<Device> seen_;
  Channel channel_ = Channel::create();
  Servo servo_;
  ContactLink link_;
  std::uint64_t ticks_ = 0;
};

}  // namespace tegotae::test
