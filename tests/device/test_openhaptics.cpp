// Against a stand-in for the vendor's library, which checks the order of calls.
#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "catch.hpp"
#include "device/fake_hd/fake_hd.h"
#include "tegotae/core/error.hpp"
#include "tegotae/device/openhaptics_device.hpp"

using namespace tegotae;

namespace {

const std::string kLibrary = TEGOTAE_FAKE_HD;

/// The stand-in's controls; the same library as the device loads.
struct FakeHd {
  void* library = dlopen(kLibrary.c_str(), RTLD_NOW);
  fake_hd_state* state = find<fake_hd_state_function>("fake_hd_reset")();
  fake_hd_run_function* run = find<fake_hd_run_function>("fake_hd_run");
  fake_hd_error_function* error = find<fake_hd_error_function>("fake_hd_error");
  fake_hd_error_function* fail_init = find<fake_hd_error_function>("fake_hd_fail_init");
  template <class Function>
  Function* find(const char* name) {
    return reinterpret_cast<Function*>(dlsym(library, name));
  }
};

OpenHapticsSettings settings() {
  OpenHapticsSettings s;
  s.library = kLibrary;
  return s;
}

Vec3 vec(const double (&v)[3]) {
  return Vec3(v);
}

}  // namespace

TEST_CASE("HDAPI is called in its order and left in its order", "[openhaptics]") {
  const FakeHd fake;
  {
    OpenHapticsDevice pen(settings());
    CHECK(pen.status() == DeviceStatus::uninitialized);
    pen.start();
    CHECK(std::string(fake.state->calls) == "init enable schedule start ");
    fake.run(3);
    CHECK(fake.state->frames == 3);
    pen.stop();
    CHECK(std::string(fake.state->calls) == "init enable schedule start stop unschedule disable ");
    pen.start();
    fake.run(1);
    CHECK(std::string(fake.state->violations).empty());
  }  // a device that goes without stop() is shut down too
  OpenHapticsDevice again(settings());
  again.start();
  fake.run(1);
  CHECK(std::string(fake.state->violations).empty());
}

TEST_CASE("the pen's pose comes in meters and in the world's axes", "[openhaptics]") {
  const FakeHd fake;
  OpenHapticsDevice pen(settings());
  pen.start();
  // A quarter turn about the device's y (up): x goes to -z, z to x. Column by column, millimeters.
  const double transform[16] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 12, 34, 56, 1};
  std::memcpy(fake.state->transform, transform, sizeof transform);
  fake.state->buttons = 3;
  fake.run(1);
  const DeviceState s = pen.read();
  // Right stays x, up is z, toward the user is -y.
  CHECK((s.pose.p - Vec3(0.012, -0.056, 0.034)).norm() < 1e-15);
  CHECK((s.pose.q * Vec3::UnitX() - Vec3::UnitY()).norm() < 1e-12);  // device x -> -z, away from the user: world y
  CHECK((s.pose.q * Vec3::UnitZ() - Vec3::UnitZ()).norm() < 1e-12);
  CHECK(s.buttons == 3);
  CHECK(pen.status() == DeviceStatus::enabled);
  CHECK(pen.reason() == ForceOff::none);
  const std::uint64_t sequence = s.sequence;
  fake.run(2);
  CHECK(pen.read().sequence == sequence + 2);
  CHECK(std::string(fake.state->violations).empty());
}

TEST_CASE("the pen's velocity is that of its motion", "[openhaptics]") {
  const FakeHd fake;
  OpenHapticsDevice pen(settings());
  pen.start();
  // Up at 100 mm/s and turning at 1 rad/s about up, as long as the filter of 50 Hz takes to follow; by the clock. The
  // middle of what is told later counts: where this thread is stopped, the pen seems to stop, and then to jump.
  const auto begin = std::chrono::steady_clock::now();
  double t = 0;
  std::vector<double> wrong, wrong_turn;
  while (t < 0.2) {
    t = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double c = std::cos(t), s = std::sin(t);
    const double transform[16] = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 100 * t, 0, 1};
    std::memcpy(fake.state->transform, transform, sizeof transform);
    fake.run(1);
    if (t < 0.1) continue;
    const Twist velocity = pen.read().velocity;
    wrong.push_back((velocity.v - Vec3(0, 0, 0.1)).norm());
    wrong_turn.push_back((velocity.w - Vec3(0, 0, 1)).norm());
  }
  const auto middle = [](std::vector<double>& of) {
    std::nth_element(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2), of.end());
    return of[of.size() / 2];
  };
  CHECK(middle(wrong) < 0.02);
  CHECK(middle(wrong_turn) < 0.2);
}

TEST_CASE("wrenches go out in newtons and millinewton meters, in the device's axes", "[openhaptics]") {
  const FakeHd fake;
  OpenHapticsDevice pen(settings());
  pen.start();
  pen.set_held_center(Vec3(1, 2, 3));
  CHECK(pen.reference_point() == Vec3::Zero());  // wrenches stay at the gimbal
  pen.write({Vec3(1, 2, 3), Vec3(0.01, 0.02, 0.03)});
  fake.run(1);
  CHECK((vec(fake.state->force) - Vec3(1, 3, -2)).norm() < 1e-12);
  CHECK((vec(fake.state->torque) - Vec3(10, 30, -20)).norm() < 1e-12);
  SECTION("within what the device may render") {
    pen.write({Vec3(0, 0, 100), Vec3(0, 0, 0.1)});
    fake.run(1);
    CHECK((vec(fake.state->force) - Vec3(0, 8.5, 0)).norm() < 1e-12);
    pen.write({Vec3(0, 0, std::numeric_limits<double>::quiet_NaN()), Vec3::Zero()});
    fake.run(1);
    CHECK(vec(fake.state->force).norm() == 0);
  }
  SECTION("not for longer than the servo lives") {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    fake.run(1);
    CHECK(vec(fake.state->force).norm() == 0);
    CHECK(vec(fake.state->torque).norm() == 0);
  }
  SECTION("zero after a stop") {
    pen.stop();
    pen.start();
    fake.run(1);
    CHECK(vec(fake.state->force).norm() == 0);
  }
  CHECK(std::string(fake.state->violations).empty());
}

TEST_CASE("a device of three degrees of freedom gets no torque", "[openhaptics]") {
  const FakeHd fake;
  fake.state->output_freedom = GENERATE(3, 6);
  OpenHapticsDevice pen(settings());
  pen.start();
  const DeviceInfo info = pen.info();
  CHECK(info.name == "Stand-in Premium");
  CHECK(info.limits.force == 8.5);
  CHECK(info.continuous_force == 1.4);
  CHECK(info.force_freedom == fake.state->output_freedom);
  CHECK(info.motion_freedom == 6);
  fake.run(1);
  CHECK(fake.state->torque_was_set == (info.force_freedom == 6 ? 1 : 0));
}

TEST_CASE("errors of the device turn the force off with a reason, for a while", "[openhaptics]") {
  const FakeHd fake;
  OpenHapticsDevice pen(settings());
  pen.start();
  struct Case {
    unsigned int code;
    ForceOff reason;
  };
  const Case cases[] = {{0x200, ForceOff::thermal},        {0x201, ForceOff::force_exceeded},
                        {0x202, ForceOff::force_exceeded}, {0x203, ForceOff::velocity},
                        {0x204, ForceOff::force_exceeded}, {0x300, ForceOff::device_fault},
                        {0x302, ForceOff::disconnected},   {0x304, ForceOff::device_fault}};
  for (const Case& c : cases) {
    INFO(c.code);
    fake.error(c.code);
    fake.run(1);
    pen.write({Vec3(1, 0, 0), Vec3::Zero()});
    fake.run(1);
    pen.read();
    CHECK(pen.reason() == c.reason);
    CHECK(pen.status() == DeviceStatus::ready);
    CHECK(vec(fake.state->force).norm() == 0);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(510));
  pen.write({Vec3(1, 0, 0), Vec3::Zero()});
  fake.run(1);
  pen.read();
  CHECK(pen.reason() == ForceOff::none);
  CHECK(vec(fake.state->force).norm() == Approx(1));
}

TEST_CASE("a device whose scheduler stops calling is disconnected, its last pose stays", "[openhaptics]") {
  const FakeHd fake;
  OpenHapticsDevice pen(settings());
  pen.start();
  fake.state->transform[12] = 50;
  fake.run(1);
  CHECK(pen.read().pose.p.x() == Approx(0.05));
  std::this_thread::sleep_for(std::chrono::milliseconds(25));
  CHECK(pen.read().pose.p.x() == Approx(0.05));
  CHECK(pen.reason() == ForceOff::disconnected);
  CHECK(pen.status() == DeviceStatus::ready);
}

TEST_CASE("what is missing is said: the library, a function of it, the device", "[openhaptics]") {
  OpenHapticsSettings s;
  s.library = "libHD-not-here.so";
  CHECK_THROWS_WITH(OpenHapticsDevice(s).start(),
                    Catch::Contains("libHD-not-here.so") && Catch::Contains("OpenHaptics runtime"));
  s.library = TEGOTAE_FAKE_HD_INCOMPLETE;  // without one
  CHECK_THROWS_WITH(OpenHapticsDevice(s).start(), Catch::Contains("has no function hdGetErrorString"));

  const FakeHd fake;
  fake.fail_init(0x300);
  CHECK_THROWS_WITH(OpenHapticsDevice(settings()).start(),
                    Catch::Contains("cannot be initialized: device fault (code 768)"));
  fake.fail_init(0);
  s = settings();
  s.device = "Right";
  CHECK_THROWS_WITH(OpenHapticsDevice(s).start(), Catch::Contains("Right"));
  s.device = "Left";
  CHECK_NOTHROW(OpenHapticsDevice(s).start());
  CHECK(std::string(fake.state->violations).empty());
}
