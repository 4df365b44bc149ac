// The servo's own thread: its schedule, what it is granted, and settings that it refuses.
#include <chrono>
#include <limits>
#include <thread>

#include "catch.hpp"
#include "puppet_device.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

using namespace tegotae;
using test::engage;
using test::kMs;
using test::PuppetDevice;
using test::touching_at;

TEST_CASE("the thread ticks on its schedule, counts, and leaves no force", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  ContactLink link(channel, {}, Vec3::Zero());
  ServoSettings settings;
  settings.rate_hz = 2000;
  Servo servo(device, channel, settings);
  const std::int64_t begin = monotonic_ns();
  servo.start();
  CHECK_THROWS_WITH(servo.start(), Catch::Contains("already runs"));
  PenSample pen;
  std::uint64_t rendered = 0;
  // A machine that holds this loop up for 20 ms turns the force off: then it lets go and presses again.
  const std::int64_t give_up = begin + 60'000 * kMs;
  while (rendered < 300 && monotonic_ns() < give_up) {
    const bool off = !link.read(pen) || pen.reason != ForceOff::none || (pen.flags & TEGOTAE_SHM_FLAG_RAMP) != 0;
    link.publish(off ? ProxyState() : touching_at(Vec3(0.001, 0, 0)), rendered, 0, monotonic_ns());
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    if (link.read(pen) && pen.reason == ForceOff::none && pen.wrench.force.x() > 0.7) ++rendered;
  }
  servo.stop();
  const double elapsed = 1e-9 * static_cast<double>(monotonic_ns() - begin);
  CHECK(device.rendered.force.norm() == 0);
  const ServoStatistics s = servo.statistics();
  // Every period of the schedule is a tick or a counted miss.
  const double periods = static_cast<double>(s.ticks + s.missed);
  CHECK(periods <= elapsed * 2000 + 2);
  CHECK(periods >= elapsed * 2000 * 0.5);
  CHECK(s.ticks > 0);
  CHECK(s.rate_hz > 0);
  CHECK(s.rate_hz < 2100);
  CHECK(s.late_us.p50 <= s.late_us.p99);
  CHECK(s.late_us.p99 <= s.late_us.p999);
  CHECK(s.late_us.p999 <= s.late_us.max);
  tegotae_shm_statistics published;
  REQUIRE(channel.read(published));
  CHECK(published.ticks == s.ticks);
  CHECK(published.missed == s.missed);
  CHECK(published.late_us[3] == s.late_us.max);
  CHECK_NOTHROW(servo.start());
}

TEST_CASE("what is missing of real time is told, and refused when enforced", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  ServoSettings settings;
  Servo servo(device, channel, settings);
  servo.start();
  servo.stop();
  const RealtimeReport report = servo.realtime();
  CHECK(report.missing.empty() == (report.fifo && report.memory_locked && report.timer_slack));
  CHECK(report.fifo == (report.missing.find("SCHED_FIFO") == std::string::npos));
  settings.realtime = RealtimeConfig::enforce;
  Servo strict(device, channel, settings);
  if (report.missing.empty()) {
    CHECK_NOTHROW(strict.start());
  } else {
    CHECK_THROWS_WITH(strict.start(), Catch::Contains(report.missing));
  }
}

TEST_CASE("servo settings out of range are refused", "[servo]") {
  PuppetDevice device;
  Channel channel = Channel::create();
  ServoSettings settings;
  settings.rate_hz = 4001;
  CHECK_THROWS_WITH(Servo(device, channel, settings), Catch::Contains("rate"));
  settings.rate_hz = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(Servo(device, channel, settings), Catch::Contains("rate"));
}
