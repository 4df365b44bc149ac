#include <limits>
#include <random>

#include "catch.hpp"
#include "servo/safety_chain.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;

namespace {

constexpr std::int64_t kNow = 1'000'000'000'000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

SafetyInput good() {
  return {{Vec3(1, 2, 2), Vec3(0.01, 0.02, 0)}, DeviceStatus::enabled, ForceOff::none, true, kNow - 1'000'000, kNow};
}

void check_off(const SafetyInput& in, ForceOff reason) {
  SafetyChain chain({});
  const SafetyOutput out = chain.apply(in);
  CHECK(out.reason == reason);
  CHECK(out.wrench.force.norm() == 0);
  CHECK(out.wrench.torque.norm() == 0);
}

}  // namespace

TEST_CASE("a good wrench passes unchanged", "[servo]") {
  SafetyChain chain({});
  const SafetyOutput out = chain.apply(good());
  CHECK(out.reason == ForceOff::none);
  CHECK(out.wrench.force == Vec3(1, 2, 2));
  CHECK(out.wrench.torque == Vec3(0.01, 0.02, 0));
}

TEST_CASE("each link turns the force off and says why", "[servo]") {
  SafetyInput in = good();
  in.device_status = DeviceStatus::ready;
  in.device_reason = ForceOff::dead_man;
  check_off(in, ForceOff::dead_man);
  in.device_reason = ForceOff::none;  // a driver that gives no reason
  check_off(in, ForceOff::software);
  in = good();
  in.attached = false;
  check_off(in, ForceOff::software);
  for (double bad : {kNan, kInfinity, -kInfinity}) {
    in = good();
    in.wanted.force.y() = bad;
    check_off(in, ForceOff::not_finite);
    in = good();
    in.wanted.torque.z() = bad;
    check_off(in, ForceOff::not_finite);
  }
}

TEST_CASE("a heartbeat older than the time allowed means no force", "[servo]") {
  SafetyChain chain({{}, 0.005});
  SafetyInput in = good();
  for (std::int64_t age : {0, 4'999'999, 5'000'000, -5'000'000}) {
    in.heartbeat_ns = kNow - age;
    CHECK(chain.apply(in).reason == ForceOff::none);
  }
  using Limits = std::numeric_limits<std::int64_t>;
  for (std::int64_t heartbeat : {kNow - 5'000'001, kNow + 5'000'001, std::int64_t{0}, Limits::min(), Limits::max()}) {
    in.heartbeat_ns = heartbeat;
    const SafetyOutput out = chain.apply(in);
    CHECK(out.reason == ForceOff::watchdog);
    CHECK(out.wrench.force.norm() == 0);
  }
}

TEST_CASE("nothing that leaves exceeds the limits, and the direction stays", "[servo]") {
  SafetyChain chain({{4, 0.1}, 0.02});
  std::mt19937 rng(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10, 4 * normal(rng));
    SafetyInput in = good();
    in.wanted.force = size * Vec3(normal(rng), normal(rng), normal(rng));
    in.wanted.torque = 0.02 * size * Vec3(normal(rng), normal(rng), normal(rng));
    const SafetyOutput out = chain.apply(in);
    REQUIRE(out.wrench.force.norm() <= 4 * (1 + 1e-15));
    REQUIRE(out.wrench.torque.norm() <= 0.1 * (1 + 1e-15));
    Vec6 wanted;
    wanted << in.wanted.force, in.wanted.torque;
    Vec6 left;
    left << out.wrench.force, out.wrench.torque;
    REQUIRE((wanted.normalized() - left.normalized()).norm() < 1e-14);
  }
}

TEST_CASE("settings out of range are refused", "[servo]") {
  CHECK_THROWS_WITH(SafetyChain({{-1, 0.1}, 0.02}), Catch::Contains("force limit"));
  CHECK_THROWS_WITH(SafetyChain({{1, kNan}, 0.02}), Catch::Contains("torque limit"));
  CHECK_THROWS_WITH(SafetyChain({{1, 0.1}, 0}), Catch::Contains("heartbeat_timeout"));
  CHECK_THROWS_WITH(SafetyChain({{1, 0.1}, 60}), Catch::Contains("heartbeat_timeout"));
}
