#include "tegotae/servo/servo.hpp"

#include <time.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <future>
#include <thread>

#include "servo/servo_tick.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "transport/shm_convert.hpp"

namespace tegotae {

namespace {

constexpr double kLowestRate = 10.0;      // Hz; slower is not a servo
constexpr double kHighestRate = 4000.0;   // Hz
constexpr double kStatisticsRate = 10.0;  // Hz, how often they are published

std::uint32_t granted(const RealtimeReport& realtime) {
  std::uint32_t bits = 0;
  if (realtime.fifo) bits |= TEGOTAE_SHM_REALTIME_FIFO;
  if (realtime.memory_locked) bits |= TEGOTAE_SHM_REALTIME_MEMORY;
  if (realtime.timer_slack) bits |= TEGOTAE_SHM_REALTIME_TIMER_SLACK;
  if (realtime.cpu >= 0) bits |= TEGOTAE_SHM_REALTIME_AFFINITY;
  return bits;
}

void sleep_until(std::int64_t ns) {
  const timespec wake = {ns / 1'000'000'000, ns % 1'000'000'000};
  // Only a signal ends it early; with an absolute time it is simply called again.
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
  }
}

}  // namespace

struct Servo::Impl {
  Impl(Device& device_in, Channel& channel_in, const ServoSettings& settings_in)
      : device(device_in), channel(channel_in), settings(settings_in), work(device_in, channel_in, settings_in) {}

  Device& device;
  Channel& channel;
  ServoSettings settings;
  ServoTick work;

  std::uint64_t missed = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  LatencyHistogram late;
  std::atomic<std::int64_t> newest_late_ns{0};
  LatencyHistogram compute;
  std::int64_t recent_late_ns = 0;  // the largest since it was published

  RealtimeReport realtime;
  std::atomic<bool> stopping{false};
  std::thread thread;

  void tick(std::int64_t now_ns) noexcept {
    if (work.ticks() == 0) first_ns = now_ns;
    last_ns = now_ns;
    work.run(now_ns);
  }

  ServoStatistics statistics() const noexcept {
    ServoStatistics s;
    s.ticks = work.ticks();
    s.missed = missed;
    if (last_ns > first_ns)
      s.rate_hz = 1e9 * static_cast<double>(s.ticks - 1) / static_cast<double>(last_ns - first_ns);
    s.late_us = summary(late);
    s.compute_us = summary(compute);
    s.recent_late_us = 1e-3 * static_cast<double>(recent_late_ns);
    s.force_off = work.force_off();
    return s;
  }

  void publish_statistics() noexcept TEGOTAE_NONBLOCKING {
    const ServoStatistics s = statistics();
    tegotae_shm_statistics out{};
    out.ticks = s.ticks;
    out.missed = s.missed;
    out.set_rate_hz = settings.rate_hz;
    out.rate_hz = s.rate_hz;
    store(s.late_us, out.late_us);
    store(s.compute_us, out.compute_us);
    out.recent_late_us = s.recent_late_us;
    recent_late_ns = 0;
    out.realtime = granted(realtime);
    out.cpu = realtime.cpu;
    std::copy(s.force_off.begin(), s.force_off.end(), out.force_off);
    channel.write(out);
  }

  void loop() noexcept {
    const std::int64_t period = std::llround(1e9 / settings.rate_hz);
    const std::uint64_t statistics_every = static_cast<std::uint64_t>(std::ceil(settings.rate_hz / kStatisticsRate));
    std::int64_t next = monotonic_ns() + period;
    while (!stopping.load(std::memory_order_acquire)) {
      sleep_until(next);
      const std::int64_t begin = monotonic_ns();
      late.add(begin - next);
      recent_late_ns = std::max(recent_late_ns, begin - next);
      newest_late_ns.store(begin - next, std::memory_order_relaxed);
      tick(begin);
      const std::int64_t end = monotonic_ns();
      compute.add(end - begin);
      if (work.ticks() % statistics_every == 0) publish_statistics();
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
    throw Error(ErrorKind::setting, "servo: the rate must be from 10 to 4000 Hz", {{}, 0, "rate_hz", {}});
}

Servo::~Servo() {
  stop();
}

void Servo::start() {
  if (impl_->thread.joinable()) throw Error("servo: it already runs");
  impl_->stopping.store(false, std::memory_order_release);
  std::promise<void> asked;
  std::future<void> answered = asked.get_future();
  impl_->thread = std::thread([impl = impl_.get(), promise = std::move(asked)]() mutable {
    impl->realtime = make_realtime(impl->settings.cpu);
    const bool run = impl->realtime.missing.empty() || impl->settings.realtime == RealtimeConfig::ignore;
    promise.set_value();
    if (run) impl->loop();
  });
  answered.wait();
  if (!impl_->realtime.missing.empty() && impl_->settings.realtime == RealtimeConfig::enforce) {
    impl_->thread.join();
    release_realtime(impl_->realtime);
    throw Error("servo: the system does not grant the required real time: " + impl_->realtime.missing);
  }
}

void Servo::stop() noexcept {
  if (!impl_->thread.joinable()) return;
  impl_->stopping.store(true, std::memory_order_release);
  impl_->thread.join();
  release_realtime(impl_->realtime);
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
  // The thread owns its counters while it runs.
  return impl_->thread.joinable() ? servo_statistics(impl_->channel) : impl_->statistics();
}

}  // namespace tegotae
