// Processes that die: the application in contact, and the device. Everything is judged by the time stamps in the
// segment and by the clock readings that the application says, not by when this test was woken.
#include <signal.h>
#include <sys/mman.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <sstream>
#include <thread>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "spawn.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/transport/channel.hpp"

using namespace tegotae;
using test::Program;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kZeroWithin = 25 * kMs;
constexpr double kForceLimit = 8.5, kTorqueLimit = 0.188;  // of the simulated device

const std::string kName = "tegotae-fault-" + std::to_string(getpid());

/// The last device of a test is killed and leaves its name.
struct Tidy {
  ~Tidy() { shm_unlink(("/" + kName).c_str()); }
} const tidy;

/// A hand that goes 4 mm down and up four times a second and sways, for ten minutes.
void write_press_script(const std::string& path) {
  std::ofstream out(path);
  out << "t,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i <= 4800; ++i)
    out << 0.125 * i << "," << 1e-3 * (i % 3) << ",0," << (i % 2 == 0 ? 0.01 : 0.006) << ",1,0,0,0\n";
}

std::unique_ptr<Program> start_device(const test::TempFolder& folder) {
  write_press_script(folder / "press.csv");
  auto device = std::make_unique<Program>(std::vector<std::string>{
      TEGOTAE_BIN_DIR "/tegotae-device", "--type", "simulated", "--script", folder / "press.csv", "--name", kName});
  REQUIRE(device->line().find("/" + kName) == 0);
  return device;
}

std::unique_ptr<Program> start_application() {
  return std::make_unique<Program>(std::vector<std::string>{TEGOTAE_BIN_DIR "/fault_application", "shm:" + kName});
}

double norm(const double (&v)[3]) {
  return Vec3(v).norm();
}

/// Looks at every servo tick that it catches.
class Observer {
 public:
  Observer() : channel_(ChannelReader::open(kName)) {}

  /// The newest tick; false when it has been seen.
  bool look() {
    tegotae_shm_device pen;
    if (!channel_.read(pen) || (seen_ > 0 && pen.tick == pen_.tick)) return false;
    pen_ = pen;
    ++seen_;
    over_limits_ += norm(pen.force) > kForceLimit * (1 + 1e-12) || norm(pen.torque) > kTorqueLimit * (1 + 1e-12);
    return true;
  }
  bool zero() const { return norm(pen_.force) == 0 && norm(pen_.torque) == 0; }
  const tegotae_shm_device& pen() const { return pen_; }
  std::uint64_t seen() const { return seen_; }
  std::uint64_t over_limits() const { return over_limits_; }
  /// The application's last heartbeat.
  std::int64_t heartbeat() const {
    tegotae_shm_application application{};
    return channel_.read(application) ? application.heartbeat_ns : 0;
  }
  /// Looks until `wanted` is true, for `seconds` at most.
  template <class Condition>
  bool wait(double seconds, Condition wanted) {
    const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (monotonic_ns() < end) {
      if (look() && wanted()) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

 private:
  ChannelReader channel_;
  tegotae_shm_device pen_{};
  std::uint64_t seen_ = 0;
  std::uint64_t over_limits_ = 0;
};

bool in_contact(const Observer& observer) {
  return norm(observer.pen().force) > 0.3;
}

struct Event {
  std::string what;
  std::int64_t now = 0, before = 0, heartbeat = 0;
  std::string place;
};

Event next_event(Program& application) {
  Event e;
  std::istringstream line(application.line());
  line >> e.what >> e.now >> e.before >> e.heartbeat;
  std::getline(line, e.place);
  return e;
}

}  // namespace

TEST_CASE("an application killed in contact leaves no force, a hundred times", "[fault]") {
  const test::TempFolder folder;
  const std::unique_ptr<Program> device = start_device(folder);
  Observer observer;
  std::mt19937 rng(5);
  std::uniform_int_distribution<int> random_us(0, 60'000);
  constexpr int kKills = TEGOTAE_FAULT_KILLS;
  int kills = 0;
  std::int64_t latest_force = 0, latest_zero = 0;
  // An application that happens to attach where the pen is lowest never touches; it is let go.
  for (int attempt = 0; kills < kKills && attempt < 3 * kKills; ++attempt) {
    const std::unique_ptr<Program> application = start_application();
    if (!observer.wait(5, [&] { return in_contact(observer); })) continue;
    const int delay_us = random_us(rng);
    observer.wait(1e-6 * delay_us, [] { return false; });
    if (!observer.wait(2, [&] { return in_contact(observer); })) continue;
    application->end(SIGKILL);
    const std::int64_t heartbeat = observer.heartbeat();
    std::int64_t zero_ns = 0;
    const auto watch = [&] {
      if (!observer.zero()) latest_force = std::max(latest_force, observer.pen().heartbeat_ns - heartbeat);
      if (observer.zero() && zero_ns == 0) zero_ns = observer.pen().heartbeat_ns;
      return zero_ns > 0;
    };
    // The first tick with zero comes when the machine lets it; then nothing may come any more.
    observer.wait(60, watch);
    observer.wait(0.1, [&] { return watch(), false; });
    REQUIRE(zero_ns > 0);
    REQUIRE(observer.zero());
    CHECK(observer.pen().reason == TEGOTAE_SHM_REASON_WATCHDOG);
    latest_zero = std::max(latest_zero, zero_ns - heartbeat);
    ++kills;
  }
  CHECK(kills == kKills);
  CHECK(observer.over_limits() == 0);
  // No tick later than this rendered anything. (The first tick with zero may itself have come late.)
  CHECK(latest_force <= kZeroWithin);
  CHECK(observer.seen() > 100);
  std::cout << kills << " kills: last force at most " << 1e-6 * static_cast<double>(latest_force)
            << " ms after the last heartbeat, first zero tick at most " << 1e-6 * static_cast<double>(latest_zero)
            << " ms, " << observer.seen() << " of " << observer.pen().tick << " ticks seen\n";
  // And a new application is served.
  const std::unique_ptr<Program> application = start_application();
  CHECK(observer.wait(10, [&] { return in_contact(observer); }));
  application->end(SIGKILL);
  CHECK(device->end(SIGTERM) == 0);
  CHECK_THROWS_AS(ChannelReader::open(kName), Error);
}

TEST_CASE("an application notices that its device died, keeps the part, and takes the next one", "[fault]") {
  const test::TempFolder folder;
  std::unique_ptr<Program> device = start_device(folder);
  const std::unique_ptr<Program> application = start_application();
  REQUIRE(next_event(*application).what == "back");
  std::mt19937 rng(7);
  std::uniform_int_distribution<int> random_us(0, 60'000);
  std::int64_t latest = 0;
  for (int i = 0; i < TEGOTAE_FAULT_DEVICE_KILLS; ++i) {
    Observer observer;
    observer.wait(3, [&] { return in_contact(observer); });
    std::this_thread::sleep_for(std::chrono::microseconds(random_us(rng)));
    device->end(SIGKILL);
    // A servo that was held up by the machine is lost and back, too; what counts is what follows the last heartbeat.
    Event lost = next_event(*application);
    while (lost.what == "back") lost = next_event(*application);
    REQUIRE(lost.what == "lost");
    // Its own loop's lateness apart: the tick before last was less than 20 ms after the heartbeat.
    const std::int64_t late = std::max<std::int64_t>(0, lost.now - lost.before - 2 * kMs);
    CHECK(lost.now - lost.heartbeat - late <= kZeroWithin);
    latest = std::max(latest, lost.now - lost.heartbeat - late);
    device = start_device(folder);  // takes the dead one's name
    const Event back = next_event(*application);
    REQUIRE(back.what == "back");
    CHECK(back.place == lost.place);
    Observer next;
    CHECK(next.wait(10, [&] { return next.pen().attachment != 0; }));
  }
  std::cout << TEGOTAE_FAULT_DEVICE_KILLS << " devices killed: noticed at most " << 1e-6 * static_cast<double>(latest)
            << " ms after the last heartbeat\n";
}

TEST_CASE("a device that was only held up is the same device afterwards", "[fault]") {
  const test::TempFolder folder;
  const std::unique_ptr<Program> device = start_device(folder);
  const std::unique_ptr<Program> application = start_application();
  REQUIRE(next_event(*application).what == "back");
  kill(device->pid(), SIGSTOP);
  const Event lost = next_event(*application);
  REQUIRE(lost.what == "lost");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  // It lives: nobody takes its name.
  CHECK_THROWS_WITH(Channel::create(kName), Catch::Contains("alive"));
  kill(device->pid(), SIGCONT);
  const Event back = next_event(*application);
  REQUIRE(back.what == "back");
  CHECK(back.place == lost.place);
  Observer observer;
  CHECK(observer.wait(10, [&] { return in_contact(observer); }));
}
