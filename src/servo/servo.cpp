#include "tegotae/servo/servo.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <future>
#include <thread>

#include "servo/safety_chain.hpp"
#include "servo/shm_convert.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

namespace {

constexpr double kLowestRate = 10.0;      // Hz; slower is no servo
constexpr double kHighestRate = 4000.0;   // Hz
constexpr double kStatisticsRate = 10.0;  // Hz, how often they are published

void sleep_until(std::int64_t ns) {
  const timespec wake = {ns / 1'000'000'000, ns % 1'000'000'000};
  // Only a signal ends it early; with an absolute time it is simply called again.
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
  }
}

}  // namespace

struct Servo::Impl {
  Impl(Device& device_in, Channel& channel_in, const ServoSettings& settings_in)
      : device(device_in), channel(channel_in), settings(settings_in), safety(settings_in.safety) {}

  Device& device;
  Channel& channel;
  ServoSettings settings;
  SafetyChain safety;

  tegotae_shm_application application{};
  bool attached = false;

  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  LatencyHistogram late;
  std::atomic<std::int64_t> newest_late_ns{0};
  LatencyHistogram compute;

  RealtimeReport realtime;
  std::atomic<bool> stopping{false};
  std::thread thread;

  /// Wrench that the coupling asks for at the pen's state `pen`.
  Wrench coupling(const DeviceState& pen) noexcept {
    if (!attached) return {};
    const Vec3 center = vector(application.center);
    const ProxyState proxy = {{quaternion(application.orientation), vector(application.position)},
                              {vector(application.velocity), vector(application.angular_velocity)},
                              application.touching != 0};
    const CouplingSettings constants = {application.stiffness, application.damping, application.torsional_stiffness,
                                        application.torsional_damping};
    return coupling_wrench(constants, proxy, pen.pose, pen.velocity, center);
  }

  void publish(std::int64_t now_ns, const DeviceState& pen, const SafetyOutput& rendered) noexcept {
    const bool on = rendered.reason == ForceOff::none;
    const DeviceStatus status = on ? DeviceStatus::enabled : std::min(device.status(), DeviceStatus::ready);
    tegotae_shm_device out{};
    out.heartbeat_ns = now_ns;
    out.tick = ticks;
    out.time_ns = pen.time_ns;
    out.sequence = pen.sequence;
    out.status = static_cast<std::uint32_t>(status);
    out.reason = static_cast<std::uint32_t>(rendered.reason);
    out.buttons = pen.buttons;
    store(pen.pose.p, out.position);
    store(pen.pose.q, out.orientation);
    store(pen.velocity.v, out.velocity);
    store(pen.velocity.w, out.angular_velocity);
    store(rendered.wrench.force, out.force);
    store(rendered.wrench.torque, out.torque);
    channel.write(out);
  }

  void tick(std::int64_t now_ns) noexcept {
    attached = channel.read(application) || attached;
    if (attached) {
      const Vec3 center = vector(application.center);
      if (center.allFinite() && center != device.center()) device.set_center(center);
    }
    const DeviceState pen = device.read();
    const SafetyOutput rendered =
        safety.apply({coupling(pen), device.status(), device.reason(), attached, application.heartbeat_ns, now_ns});
    device.write(rendered.wrench);
    publish(now_ns, pen, rendered);
    if (ticks == 0) first_ns = now_ns;
    last_ns = now_ns;
    ++ticks;
  }

  ServoStatistics statistics() const noexcept {
    ServoStatistics s;
    s.ticks = ticks;
    s.missed = missed;
    if (last_ns > first_ns) s.rate_hz = 1e9 * static_cast<double>(ticks - 1) / static_cast<double>(last_ns - first_ns);
    s.late_us = summary(late);
    s.compute_us = summary(compute);
    return s;
  }

  void publish_statistics() noexcept {
    const ServoStatistics s = statistics();
    channel.write(tegotae_shm_statistics{s.ticks,
                                         s.missed,
                                         s.rate_hz,
                                         {s.late_us.p50, s.late_us.p99, s.late_us.p999, s.late_us.max},
                                         {s.compute_us.p50, s.compute_us.p99, s.compute_us.p999, s.compute_us.max}});
  }

  void loop() noexcept {
    const std::int64_t period = std::llround(1e9 / settings.rate_hz);
    const std::uint64_t statistics_every = static_cast<std::uint64_t>(std::ceil(settings.rate_hz / kStatisticsRate));
    std::int64_t next = monotonic_ns() + period;
    while (!stopping.load(std::memory_order_acquire)) {
      sleep_until(next);
      const std::int64_t begin = monotonic_ns();
      late.add(begin - next);
      newest_late_ns.store(begin - next, std::memory_order_relaxed);
      tick(begin);
      const std::int64_t end = monotonic_ns();
      compute.add(end - begin);
      if (ticks % statistics_every == 0) publish_statistics();
      next += period;
      if (next <= end) {
        const std::int64_t skipped = (end - next) / period + 1;
        missed += static_cast<std::uint64_t>(skipped);
        next += skipped * period;
      }
    }
  }
};

Servo::Servo(Device& device, Channel& channel, const ServoSettings& settings)
    : impl_(std::make_unique<Impl>(device, channel, settings)) {
  if (!(settings.rate_hz >= kLowestRate && settings.rate_hz <= kHighestRate))
    throw Error("servo: the rate must be from 10 to 4000 Hz");
}

Servo::~Servo() {
  stop();
}

void Servo::start() {
  if (impl_->thread.joinable()) throw Error("servo: it runs already");
  impl_->stopping.store(false, std::memory_order_release);
  std::promise<RealtimeReport> granted;
  std::future<RealtimeReport> report = granted.get_future();
  impl_->thread = std::thread([impl = impl_.get(), promise = std::move(granted)]() mutable {
    RealtimeReport mine = make_realtime();
    const bool run = mine.missing.empty() || impl->settings.realtime == RealtimeConfig::ignore;
    promise.set_value(std::move(mine));
    if (run) impl->loop();
  });
  impl_->realtime = report.get();
  if (!impl_->realtime.missing.empty() && impl_->settings.realtime == RealtimeConfig::enforce) {
    impl_->thread.join();
    throw Error("servo: real time was asked for and not granted: " + impl_->realtime.missing);
  }
}

void Servo::stop() noexcept {
  if (!impl_->thread.joinable()) return;
  impl_->stopping.store(true, std::memory_order_release);
  impl_->thread.join();
  impl_->device.write({});
  impl_->publish_statistics();
}

void Servo::tick(std::int64_t now_ns) noexcept {
  impl_->tick(now_ns);
}

const RealtimeReport& Servo::realtime() const noexcept {
  return impl_->realtime;
}

std::int64_t Servo::newest_late_ns() const noexcept {
  return impl_->newest_late_ns.load(std::memory_order_relaxed);
}

ServoStatistics Servo::statistics() const noexcept {
  if (!impl_->thread.joinable()) return impl_->statistics();
  // The thread owns its counters while it runs; this is what it last published.
  tegotae_shm_statistics s;
  if (!impl_->channel.read(s)) return {};
  return {s.ticks,
          s.missed,
          s.rate_hz,
          {s.late_us[0], s.late_us[1], s.late_us[2], s.late_us[3]},
          {s.compute_us[0], s.compute_us[1], s.compute_us[2], s.compute_us[3]}};
}

}  // namespace tegotae
