#pragma once

#include "tegotae/device/device.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae::test {

inline constexpr std::int64_t kMs = 1'000'000;
inline constexpr double kTick = 1e-3;  // s

/// A pen that says what the test tells it to, and remembers what it was asked to render. Its body is the held part.
class PuppetDevice : public Device {
 public:
  DeviceState state;
  DeviceStatus now = DeviceStatus::enabled;
  DeviceInfo facts;
  Wrench rendered;
  Vec3 center = Vec3::Zero();
  Vec3 reference_point() const noexcept override { return center; }
  void set_held_center(const Vec3& held) noexcept override { center = held; }
  DeviceInfo info() const override { return facts; }
  void start() override {}
  void stop() override {}
  DeviceState read() noexcept override {
    ++state.sequence;
    return state;
  }
  void write(const Wrench& wrench) noexcept override { rendered = wrench; }
  DeviceStatus status() const noexcept override { return now; }
  ForceOff reason() const noexcept override {
    return now == DeviceStatus::enabled ? ForceOff::none : ForceOff::disconnected;
  }
};

/// Ticks without contact until the force is engaged and ramped in; returns the time of the last tick.
inline std::int64_t engage(Servo& servo, ContactLink& link, std::int64_t from_ns = 0) {
  std::int64_t now = from_ns;
  for (int i = 0; i < 250; ++i) {
    now += kMs;
    link.publish({}, 0, 0, now);
    servo.tick(now);
  }
  return now;
}

inline ProxyState touching_at(const Vec3& p) {
  ProxyState x;
  x.X.p = p;
  x.touching = true;
  return x;
}

}  // namespace tegotae::test
