// Ways that were proved: where a part may go on them, against closed forms on straight ways.
#include <cmath>

#include "catch.hpp"
#include "narrowphase/proved_way.hpp"

using namespace tegotae;

namespace {

const Vec3 kCenter(0.01, 0, 0);
constexpr double kRadius = 0.05;
const std::vector<std::uint32_t> kParts = {0};

Pose at(double x, double y = 0) {
  return {Quat::Identity(), Vec3(x, y, 0)};
}

Displacement by(double x, double y = 0) {
  return {Vec3(x, y, 0), Vec3::Zero()};
}

ProvedWays ways() {
  return ProvedWays(kCenter, kRadius, 2, 4);
}

}  // namespace

TEST_CASE("on a way, a part goes as near as it can to where it would, back to where it came to the way") {
  ProvedWay way(kCenter, kRadius, 2);
  way.set(at(0), by(0.1), kParts);
  CHECK(!way.toward(at(0.03, 0.001), by(0.01)));
  way.come_to(at(0.03));
  const auto aside = way.toward(at(0.03), by(0.02, 0.01));
  REQUIRE(aside);
  CHECK((aside->dp - Vec3(0.02, 0, 0)).norm() < 1e-12);
  // Not before the place where it came to it, nor past the end.
  way.come_to(at(0.06));
  CHECK((way.toward(at(0.06), by(-0.05))->dp - Vec3(-0.03, 0, 0)).norm() < 1e-12);
  CHECK((way.toward(at(0.06), by(0.05))->dp - Vec3(0.04, 0, 0)).norm() < 1e-12);
  CHECK(!way.done());
  way.come_to(way.end());
  CHECK(way.done());
}

TEST_CASE("a part turns off a way where the next one begins, and not where it cannot come there") {
  ProvedWays all = ways();
  all.add(at(0), by(0.1), kParts, {{0, 1, 2}});
  all.come_to(at(0));
  all.turn_off(at(0.02), at(0.05));
  REQUIRE(!all.empty());
  CHECK(all.first().met.empty());
  all.add(at(0.05), by(0, 0.1), kParts, {});
  REQUIRE(all.lead_on());
  // Along the first way it goes no farther than there, whatever it wants.
  const auto along = all.first().way.toward(at(0.02), by(0.06));
  REQUIRE(along);
  CHECK((along->dp - Vec3(0.03, 0, 0)).norm() < 1e-12);
  // And from there on along the next.
  all.come_to(displaced(at(0.02), kCenter, *along));
  CHECK(!all.lead_on());
  const auto next = all.first().way.toward(at(0.05), by(0, 0.02));
  REQUIRE(next);
  CHECK((next->dp - Vec3(0, 0.02, 0)).norm() < 1e-12);
}

TEST_CASE("a part that goes back along a way turns off it behind") {
  ProvedWays all = ways();
  all.add(at(0), by(0.1), kParts, {});
  all.come_to(at(0.01));
  all.come_to(at(0.09));
  all.turn_off(at(0.09), at(0.04));
  all.add(at(0.04), by(0, 0.1), kParts, {});
  REQUIRE(all.lead_on());
  const auto back = all.first().way.toward(at(0.09), by(-0.08));
  REQUIRE(back);
  CHECK((back->dp - Vec3(-0.05, 0, 0)).norm() < 1e-12);
}

TEST_CASE("off its way, a part turns off nowhere, and where it is it begins anew") {
  ProvedWays all = ways();
  all.add(at(0), by(0.1), kParts, {});
  all.come_to(at(0));
  all.turn_off(at(0.02, 0.001), at(0.05));
  CHECK(all.first().way.ends_at(at(0.1)));
  all.turn_off(at(0.02), at(0.05, 0.001));
  CHECK(all.first().way.ends_at(at(0.1)));
  // Where it is already, nothing is left of the first way.
  all.turn_off(at(0.02), at(0.02));
  all.add(at(0.02), by(0, 0.1), kParts, {});
  CHECK(!all.lead_on());
  CHECK(all.first().way.is_on(at(0.02)));
  CHECK(all.first().way.is_on(at(0.02, 0.07)));
}
