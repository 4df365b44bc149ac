#include "servo/puppet_device.hpp"
#include "servo/safety_chain.hpp"

#include <limits>
#include <random>

#include "catch.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr std::int64_t kNow = 1'000'000'000'000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

SafetyInput good(std::int64_t now = kNow) {
  SafetyInput in;
  in.wanted = {Vec3(1, 2, 2), Vec3(0.01, 0.02, 0)};
  in.device_status = DeviceStatus::enabled;
  in.pen_valid = in.attached = in.force_asked = in.valid = true;
  in.heartbeat_ns = now - kMs;
  in.now_ns = now;
  in.dt = kTick;
  return in;
}

/// A chain that is engaged and fully ramped in, with no force wanted.
SafetyChain engaged(const SafetySettings& settings = {}) {
  SafetyChain chain(settings);
  SafetyInput in = good();
  in.wanted = {};
  for (int i = 0; i < 300; ++i) chain.apply(in);
  return chain;
}

/// The same, rendering the wrench of good().
SafetyChain rendering(const SafetySettings& settings = {}) {
  SafetyChain chain = engaged(settings);
  for (int i = 0; i < 10; ++i) chain.apply(good());
  return chain;
}

/// The force goes off with `reason`: at once, or in steps of at most the slew limit within `fade_ticks`.
void check_off(const SafetyInput& in, ForceOff reason, int fade_ticks = 0) {
  SafetyChain chain = rendering();
  SafetyOutput out = chain.apply(in);
  CHECK(out.reason == reason);
  double last = 3;
  for (int i = 1; i < fade_ticks; ++i) {
    CHECK(out.wrench.force.norm() > 0);
    CHECK(out.wrench.force.norm() < last);
    last = out.wrench.force.norm();
    out = chain.apply(in);
    CHECK(out.reason == reason);
  }
  CHECK(out.wrench.force.norm() == 0);
  CHECK(out.wrench.torque.norm() == 0);
}

}  // namespace

TEST_CASE("a good wrench passes unchanged", "[servo]") {
  SafetyChain chain = rendering();
  const SafetyOutput out = chain.apply(good());
  CHECK(out.reason == ForceOff::none);
  CHECK(out.flags == 0);
  CHECK(out.unmodified);
  CHECK(out.wrench.force == Vec3(1, 2, 2));
  CHECK(out.wrench.torque == Vec3(0.01, 0.02, 0));
}

TEST_CASE("emergencies turn the force off at once and say why", "[servo]") {
  SafetyInput in = good();
  in.device_status = DeviceStatus::ready;
  in.device_reason = ForceOff::device_fault;
  check_off(in, ForceOff::device_fault);
  in.device_reason = ForceOff::none;  // a driver that gives no reason
  check_off(in, ForceOff::software);
  in = good();
  in.pen_valid = false;
  check_off(in, ForceOff::not_finite);
  in = good();
  in.valid = false;
  check_off(in, ForceOff::not_finite);
  for (double bad : {kNan, kInfinity, -kInfinity}) {
    in = good();
    in.wanted.force.y() = bad;
    check_off(in, ForceOff::not_finite);
    in = good();
    in.wanted.torque.z() = bad;
    check_off(in, ForceOff::not_finite);
  }
}

TEST_CASE("every other link fades the force out and says why", "[servo]") {
  const auto off = [](ForceOff reason, auto change) {
    INFO(to_string(reason));
    SafetyInput in = good();
    change(in);
    check_off(in, reason, 3);
  };
  off(ForceOff::no_force, [](SafetyInput& in) { in.force_freedom = 0; });
  off(ForceOff::silent, [](SafetyInput& in) { in.pen_silent = true; });
  off(ForceOff::software, [](SafetyInput& in) { in.attached = false; });
  off(ForceOff::software, [](SafetyInput& in) { in.force_asked = false; });
  off(ForceOff::watchdog, [](SafetyInput& in) { in.heartbeat_ns = in.now_ns - 20 * kMs - 1; });
  off(ForceOff::watchdog, [](SafetyInput& in) { in.heartbeat_ns = in.now_ns + 20 * kMs + 1; });
  off(ForceOff::watchdog, [](SafetyInput& in) { in.heartbeat_ns = std::numeric_limits<std::int64_t>::min(); });
  off(ForceOff::clutched, [](SafetyInput& in) { in.clutched = true; });
  off(ForceOff::engage, [](SafetyInput& in) { in.remapped = true; });
  off(ForceOff::velocity, [](SafetyInput& in) { in.pen_fast = true; });
  off(ForceOff::energy, [](SafetyInput& in) { in.energy = -0.0101; });
}

TEST_CASE("the dead-man switch and the workspace are links that settings ask for", "[servo]") {
  SafetySettings settings;
  settings.dead_man_buttons = 6;
  SafetyInput held = good();
  held.buttons = 4;
  held.wanted = {};
  SafetyChain chain(settings);
  for (int i = 0; i < 300; ++i) chain.apply(held);
  CHECK(chain.apply(held).reason == ForceOff::none);
  held.buttons = 1;
  CHECK(chain.apply(held).reason == ForceOff::dead_man);

  settings = {};
  settings.workspace_half = Vec3::Constant(0.1);
  chain = rendering(settings);
  SafetyInput in = good();
  in.pen = Vec3(0.11, 0, 0);  // half of the margin of 20 mm
  SafetyOutput out = chain.apply(in);
  CHECK(out.reason == ForceOff::none);
  CHECK((out.flags & TEGOTAE_SHM_FLAG_WORKSPACE) != 0);
  CHECK(out.wrench.force.norm() == Approx(1.5));
  in.pen = Vec3(0.13, 0, 0);
  CHECK(chain.apply(in).reason == ForceOff::workspace);
}

TEST_CASE("from the last heartbeat to no force takes less than 25 ms at full force", "[servo]") {
  for (double rate : {1000.0, 2000.0, 4000.0}) {
    SafetyChain chain = engaged();
    SafetyInput in = good();
    in.dt = 1 / rate;
    in.wanted = {Vec3(0, -8.5, 0), Vec3(0.188, 0, 0)};
    for (int i = 0; i < 100; ++i) chain.apply(in);
    CHECK(chain.apply(in).wrench.force.norm() > 7);
    in.heartbeat_ns = in.now_ns;
    const std::int64_t died = in.now_ns;
    SafetyOutput out;
    do {
      in.now_ns += static_cast<std::int64_t>(1e9 / rate);
      out = chain.apply(in);
    } while (out.wrench.force.norm() > 0 || out.wrench.torque.norm() > 0);
    CHECK(in.now_ns - died <= 24 * kMs);
    CHECK(out.reason == ForceOff::watchdog);
  }
}

TEST_CASE("a force of over the continuous figure is taken back to it", "[servo]") {
  SafetySettings settings;
  settings.thermal_time = 1;
  SafetyChain chain = engaged(settings);
  SafetyInput in = good();
  in.wanted = {Vec3(0, 0, 5), Vec3(0, 0.05, 0)};
  SafetyOutput out;
  for (int i = 0; i < 20'000; ++i) out = chain.apply(in);
  CHECK(out.reason == ForceOff::none);
  CHECK((out.flags & TEGOTAE_SHM_FLAG_THERMAL) != 0);
  CHECK(out.wrench.force.z() == Approx(1.4).epsilon(1e-3));
  CHECK(out.wrench.torque.y() == Approx(0.05 * 1.4 / 5).epsilon(1e-3));
  CHECK(chain.thermal_load() == Approx(1).epsilon(1e-3));
}

TEST_CASE("saturation keeps the direction of force and torque together", "[servo]") {
  SafetySettings settings;
  settings.limits = {4, 0.1};
  settings.slew = {1e9, 1e9};
  settings.continuous_force = 0;
  SafetyChain chain = engaged(settings);
  std::mt19937 rng(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10, 2 * normal(rng));
    SafetyInput in = good();
    in.wanted.force = size * Vec3(normal(rng), normal(rng), normal(rng));
    in.wanted.torque = 0.02 * size * Vec3(normal(rng), normal(rng), normal(rng));
    const SafetyOutput out = chain.apply(in);
    REQUIRE(out.wrench.force.norm() <= 4 * (1 + 1e-12));
    REQUIRE(out.wrench.torque.norm() <= 0.1 * (1 + 1e-12));
    Vec6 wanted;
    wanted << in.wanted.force, in.wanted.torque;
    Vec6 left;
    left << out.wrench.force, out.wrench.torque;
    REQUIRE((wanted.normalized() - left.normalized()).norm() < 1e-9);
  }
}

TEST_CASE("whatever comes in, nothing leaves that is too much or too sudden", "[servo]") {
  // Random inputs that stay for a while, with garbage now and then: the chain goes through all its states.
  std::mt19937_64 rng(19);
  std::normal_distribution<double> normal;
  SafetySettings settings;
  settings.workspace_half = Vec3::Constant(0.1);
  settings.dead_man_buttons = 1;
  settings.thermal_time = 0.5;
  settings.ramp_time = 0.02;
  SafetyChain chain(settings);
  SafetyInput in = good();
  in.buttons = 1;
  std::uint64_t on = 0;
  std::uint64_t seen = 0;  // bit i: reason i
  Wrench last;
  double mean2 = 0;
  const double garbage[] = {kNan, kInfinity, -kInfinity, 1e308, -1e308};
  const auto sometimes = [&](unsigned one_in) { return rng() % one_in == 0; };
  for (int i = 0; i < 300'000; ++i) {
    in.now_ns += kMs;
    if (!sometimes(400)) in.heartbeat_ns = in.now_ns;
    if (sometimes(50)) {
      const double size = sometimes(3) ? 0 : std::pow(10, normal(rng));
      in.wanted = {size * Vec3(normal(rng), normal(rng), normal(rng)), 0.02 * size * Vec3::Constant(normal(rng))};
    }
    if (sometimes(50)) in.pen = Vec3::Constant(0.07 * normal(rng));
    SafetyInput now = in;
    if (sometimes(1000)) now.wanted.force[static_cast<int>(rng() % 3)] = garbage[rng() % 5];
    if (sometimes(1000)) now.wanted.torque[static_cast<int>(rng() % 3)] = garbage[rng() % 5];
    if (sometimes(2000)) now.pen[static_cast<int>(rng() % 3)] = garbage[rng() % 5];
    if (sometimes(2000)) now.energy = garbage[rng() % 5];
    if (sometimes(2000)) now.device_status = DeviceStatus::ready;
    if (sometimes(2000)) now.pen_valid = false;
    if (sometimes(2000)) now.valid = false;
    if (sometimes(2000)) now.buttons = 0;
    if (sometimes(2000)) now.pen_fast = true;
    if (sometimes(2000)) now.pen_silent = true;
    if (sometimes(2000)) now.clutched = true;
    if (sometimes(2000)) now.remapped = true;
    if (sometimes(2000)) now.force_asked = false;
    if (sometimes(2000)) now.heartbeat_ns = static_cast<std::int64_t>(rng());
    const bool emergency = now.device_status != DeviceStatus::enabled || !now.pen_valid || !now.valid ||
                           !now.wanted.force.allFinite() || !now.wanted.torque.allFinite();
    const SafetyOutput out = chain.apply(now);
    REQUIRE(out.wrench.force.allFinite());
    REQUIRE(out.wrench.torque.allFinite());
    REQUIRE(out.wrench.force.norm() <= 8.5 * (1 + 1e-12));
    REQUIRE(out.wrench.torque.norm() <= 0.188 * (1 + 1e-12));
    const double step = (out.wrench.force - last.force).norm();
    const double torque_step = (out.wrench.torque - last.torque).norm();
    if (emergency) {
      REQUIRE(out.wrench.force.norm() == 0);
      REQUIRE(out.wrench.torque.norm() == 0);
      REQUIRE(out.reason != ForceOff::none);
    } else {
      REQUIRE(step <= 3 * (1 + 1e-9));
      REQUIRE(torque_step <= 0.07 * (1 + 1e-9));
    }
    mean2 += (out.wrench.force.squaredNorm() - mean2) * -std::expm1(-kTick / 0.5);
    // Slewing may come down from the thermal peak a few ticks late.
    REQUIRE(std::sqrt(mean2) <= 1.4 * 1.05);
    last = out.wrench;
    on += out.reason == ForceOff::none ? 1 : 0;
    seen |= std::uint64_t{1} << static_cast<int>(out.reason);
    REQUIRE(std::string(to_string(out.reason)) != "unknown reason");
  }
  CHECK(on > 30'000);
  for (ForceOff reason : {ForceOff::none, ForceOff::velocity, ForceOff::watchdog, ForceOff::software,
                          ForceOff::dead_man, ForceOff::not_finite, ForceOff::workspace, ForceOff::energy,
                          ForceOff::engage, ForceOff::clutched, ForceOff::silent}) {
    INFO(to_string(reason));
    CHECK((seen >> static_cast<int>(reason) & 1) == 1);
  }
}

TEST_CASE("settings out of range are refused by name", "[servo]") {
  const auto refused = [](const char* name, auto change) {
    SafetySettings s;
    change(s);
    CHECK_THROWS_WITH(SafetyChain(s), Catch::Contains(name));
  };
  refused("force limit", [](SafetySettings& s) { s.limits.force = -1; });
  refused("torque limit", [](SafetySettings& s) { s.limits.torque = kNan; });
  refused("heartbeat_timeout", [](SafetySettings& s) { s.heartbeat_timeout = 0; });
  refused("heartbeat_timeout", [](SafetySettings& s) { s.heartbeat_timeout = 60; });
  refused("silence_timeout", [](SafetySettings& s) { s.silence_timeout = kNan; });
  refused("fade_time", [](SafetySettings& s) { s.fade_time = 0; });
  refused("ramp_time", [](SafetySettings& s) { s.ramp_time = kInfinity; });
  refused("engage force", [](SafetySettings& s) { s.engage.force = 0; });
  refused("slew limit of the force", [](SafetySettings& s) { s.slew.force = 0; });
  refused("slew limit of the torque", [](SafetySettings& s) { s.slew.torque = -1; });
  refused("velocity_limit", [](SafetySettings& s) { s.velocity_limit = kNan; });
  refused("continuous_force", [](SafetySettings& s) { s.continuous_force = -1; });
  refused("thermal_time", [](SafetySettings& s) { s.thermal_time = 0; });
  refused("workspace_half", [](SafetySettings& s) { s.workspace_half.x() = 0; });
  refused("energy_bound", [](SafetySettings& s) { s.energy_bound = kNan; });
}
