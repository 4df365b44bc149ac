// Garbage in the segment and from the pen, at full speed through Servo::tick in virtual time.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>

#include "catch.hpp"
#include "device/press_scene.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

using namespace tegotae;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::size_t kWords = sizeof(tegotae_shm_segment) / sizeof(std::uint64_t);

/// A pen that says what it is told to, and judges what it is asked to render.
class Pen final : public Device {
 public:
  DeviceState state;
  Wrench rendered;
  std::uint64_t bad = 0;  ///< wrenches that are not finite or beyond the limits
  double most = 0;        ///< N
  DeviceInfo info() const override { return {}; }
  void start() override {}
  void stop() override {}
  DeviceState read() noexcept override { return state; }
  void write(const Wrench& w) noexcept override {
    rendered = w;
    const DeviceInfo limits;
    const bool good = w.force.allFinite() && w.torque.allFinite() &&
                      w.force.norm() <= limits.limits.force * (1 + 1e-12) &&
                      w.torque.norm() <= limits.limits.torque * (1 + 1e-12);
    bad += !good;
    if (good) most = std::max(most, w.force.norm());
  }
  DeviceStatus status() const noexcept override { return DeviceStatus::enabled; }
  ForceOff reason() const noexcept override { return ForceOff::none; }
};

/// A number as they go wrong: bits at random, special values, or a plausible one.
std::uint64_t garbage(std::mt19937_64& rng) {
  static const double special[] = {0.0,
                                   -0.0,
                                   1.0,
                                   -1.0,
                                   1e-320,
                                   1e300,
                                   -1e300,
                                   std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN()};
  std::uint64_t word = rng();
  switch (rng() % 4) {
    case 0:
      return word;
    case 1:
      return word % 5;  // small integers: counters, flags
    case 2: {
      const double value = special[word % (sizeof special / sizeof *special)];
      std::memcpy(&word, &value, sizeof word);
      return word;
    }
    default: {
      const double value = std::uniform_real_distribution<double>(-1, 1)(rng);
      std::memcpy(&word, &value, sizeof word);
      return word;
    }
  }
}

/// The words of a segment, past the library.
struct RawSegment {
  int fd;
  std::uint64_t* words;
  explicit RawSegment(const std::string& name) : fd(shm_open(name.c_str(), O_RDWR, 0)) {
    words = static_cast<std::uint64_t*>(
        mmap(nullptr, sizeof(tegotae_shm_segment), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
  }
  ~RawSegment() {
    munmap(words, sizeof(tegotae_shm_segment));
    close(fd);
  }
};

ProxyState pressed() {
  ProxyState x;
  x.X.p = Vec3(0.002, 0, 0);
  x.touching = true;
  return x;
}
ProxyState free_part() {
  ProxyState x = pressed();
  x.touching = false;
  return x;
}

/// A servo with an application that behaves: some ticks out of contact, in which the force engages, then in contact.
struct Bench {
  Pen pen;
  Channel channel = Channel::create();
  Servo servo{pen, channel};
  std::optional<ContactLink> link;

  Bench() { attach(); }
  /// A new application: the pen, where it is, means the part at the origin.
  void attach() {
    link.emplace(channel, CouplingSettings{}, Vec3::Zero());
    link->home(Pose{});
  }

  std::int64_t now = 0;
  std::uint64_t tick = 0;

  void step(const ProxyState* proxy) {
    now += kMs;
    if (proxy != nullptr) link->publish(*proxy, tick++, pen.state.sequence, now);
    ++pen.state.sequence;
    pen.state.time_ns = now;
    servo.tick(now);
  }
  /// Behaves for so long that the force is on and full. Gives it (N).
  double recover() {
    pen.state.pose = {};
    pen.state.velocity = {};
    attach();
    for (int i = 0; i < 500; ++i) {
      const ProxyState x = i < 200 ? free_part() : pressed();
      step(&x);
    }
    return pen.rendered.force.norm();
  }
};

}  // namespace

TEST_CASE("garbage in every field of the segment, a hundred thousand times", "[fault]") {
  Bench bench;
  const RawSegment raw(bench.channel.name());
  const double sound = bench.recover();
  REQUIRE(sound == Approx(1.6));  // 800 N/m, 2 mm
  std::mt19937_64 rng(2024);
  std::uint64_t hit[kWords] = {};
  std::uint64_t with_force = 0;
  for (int i = 0; i < 100'000; ++i) {
    // Words of all slots, their counters and the header; mostly few, sometimes all.
    const std::size_t count = rng() % 16 == 0 ? kWords : 1 + rng() % 4;
    const ProxyState x = rng() % 2 == 0 ? free_part() : pressed();
    bench.link->publish(x, bench.tick++, 0, bench.now + kMs);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = count == kWords ? k : rng() % kWords;
      // From the second half on the counters stay whole, so that the servo takes the garbage in.
      const std::size_t counter = offsetof(tegotae_shm_segment, application_counter) / sizeof(std::uint64_t);
      if (i % 2 == 1 && at == counter) continue;
      __atomic_store_n(raw.words + at, garbage(rng), __ATOMIC_RELAXED);
      ++hit[at];
    }
    bench.step(nullptr);
    with_force += bench.pen.rendered.force.norm() > 0;
    if (i % 1000 == 999) REQUIRE(bench.recover() == Approx(sound));
  }
  CHECK(bench.pen.bad == 0);
  CHECK(*std::min_element(hit, hit + kWords) > 1000);  // no field was spared
  CHECK(with_force > 100);                             // and the chain was not just off
}

TEST_CASE("a pen that is not a number, jumps, or is silent for ten seconds", "[fault]") {
  Bench bench;
  const double sound = bench.recover();
  std::mt19937_64 rng(77);
  const auto number = [&] {
    const std::uint64_t word = garbage(rng);
    double value;
    std::memcpy(&value, &word, sizeof value);
    return value;
  };
  const ProxyState x = pressed();
  SECTION("garbage in every field of its state") {
    for (int i = 0; i < 100'000; ++i) {
      DeviceState& s = bench.pen.state;
      if (rng() % 4 == 0) s = DeviceState{};
      if (rng() % 2 == 0) s.pose.p[static_cast<int>(rng() % 3)] = number();
      if (rng() % 2 == 0) s.pose.q.coeffs()[static_cast<int>(rng() % 4)] = number();
      if (rng() % 2 == 0) s.velocity.v[static_cast<int>(rng() % 3)] = number();
      if (rng() % 2 == 0) s.velocity.w[static_cast<int>(rng() % 3)] = number();
      if (rng() % 4 == 0) s.sequence = garbage(rng);
      if (rng() % 4 == 0) s.buttons = static_cast<std::uint32_t>(garbage(rng));
      bench.step(&x);
      if (!s.pose.p.allFinite() || !s.velocity.v.allFinite()) REQUIRE(bench.pen.rendered.force.norm() == 0);
      if (i % 1000 == 999) REQUIRE(bench.recover() == Approx(sound));
    }
  }
  SECTION("jumps of up to a meter") {
    std::uniform_real_distribution<double> u(-1, 1);
    for (int i = 0; i < 20'000; ++i) {
      if (rng() % 20 == 0) {
        bench.pen.state.pose.p = Vec3(u(rng), u(rng), u(rng));
        bench.pen.state.pose.q = rotation(3 * Vec3(u(rng), u(rng), u(rng)));
      }
      bench.step(&x);
    }
    REQUIRE(bench.recover() == Approx(sound));
  }
  SECTION("silence") {
    for (int i = 0; i < 10'000; ++i) {
      bench.now += kMs;
      bench.link->publish(x, bench.tick++, bench.pen.state.sequence, bench.now);
      bench.servo.tick(bench.now);  // the same sample again
      if (i >= 25) REQUIRE(bench.pen.rendered.force.norm() == 0);
    }
    PenSample seen;
    REQUIRE(bench.link->read(seen));
    CHECK(seen.reason == ForceOff::silent);
    REQUIRE(bench.recover() == Approx(sound));
  }
  CHECK(bench.pen.bad == 0);
}

TEST_CASE("garbage in the pen's slot moves no part through another", "[fault]") {
  const Scene scene = test::press_scene();
  HapticLoop loop(scene);
  Channel channel = Channel::create();
  ContactLink link(channel, {}, loop.center());
  std::mt19937_64 rng(3);
  double lowest = 1;
  for (int i = 0; i < 3000; ++i) {
    std::uint64_t words[sizeof(tegotae_shm_device) / 8];
    for (std::uint64_t& word : words) word = garbage(rng);
    tegotae_shm_device pen;
    std::memcpy(&pen, words, sizeof pen);
    if (i % 2 == 0) {  // a pen that can be, above and below the floor
      for (double& p : pen.position) p = std::uniform_real_distribution<double>(-0.05, 0.05)(rng);
      double length = 0;
      for (double& q : pen.orientation) {
        q = std::uniform_real_distribution<double>(-1, 1)(rng);
        length = std::hypot(length, q);
      }
      for (double& q : pen.orientation) q /= length;
    }
    channel.write(pen);
    PenSample seen;
    REQUIRE(link.read(seen));
    CHECK(std::strlen(to_string(seen.reason)) > 0);
    CHECK(std::strlen(to_string(seen.status)) > 0);
    for (const Pose& X : loop.step(seen.state.pose, 1e-3).substeps) {
      REQUIRE((X.p.allFinite() && X.q.coeffs().allFinite()));
      for (const Vec3& v : scene.parts[1].mesh->vertices) {
        const Vec3 corner = X * v;
        // Beyond the floor's edge it may be below; over it, it stays above.
        if (std::abs(corner.x()) < 0.45 && std::abs(corner.y()) < 0.45) lowest = std::min(lowest, corner.z());
      }
    }
  }
  CHECK(lowest > 0);
  CHECK(lowest < 1e-3);  // it was pressed on
}
