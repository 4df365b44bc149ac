#include "bodies.hpp"
#include "catch.hpp"
#include "contact/contact_set.hpp"
#include "tegotae/core/clock.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

std::shared_ptr<const Surface> surface(TriangleMesh mesh) {
  return std::make_shared<Surface>(shared(std::move(mesh)));
}

std::vector<FacePair> all_pairs(const Surface& a, const Surface& b) {
  std::vector<FacePair> pairs;
  for (std::uint32_t i = 0; i < a.mesh->triangles.size(); ++i)
    for (std::uint32_t j = 0; j < b.mesh->triangles.size(); ++j) pairs.push_back({0, i, j});
  return pairs;
}

}  // namespace

TEST_CASE("a box over a floor has its four corners as contacts, also when it hovers a little tilted", "[contact]") {
  const double tilt = GENERATE(0.0, 0.001, 0.005);
  const auto A = surface(box({0.04, 0.04, 0.04})), B = surface(box({0.4, 0.4, 0.02}));
  ContactSet set(A, {{B, {Quat::Identity(), {0, 0, -0.01}}}}, Vec3::Zero(), 256);
  const Pose X{rotation({0.7 * tilt, tilt, 0}), {0.01, 0.02, 0.0202}};
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  REQUIRE(set.limits().empty());
  REQUIRE(set.seed(all_pairs(*A, *B), X, kNoDeadline) >= 4);
  int corners_found = 0;
  for (double sx : {-0.02, 0.02})
    for (double sy : {-0.02, 0.02}) {
      const Vec3 r = X.q * Vec3(sx, sy, -0.02);
      for (const Contact& c : set.limits())
        if ((c.r - r).norm() < 1e-12) {
          ++corners_found;
          REQUIRE(c.n.z() == Approx(1.0));
          REQUIRE(c.gap == Approx((X.p + r).z()).margin(1e-12));
          break;
        }
    }
  REQUIRE(corners_found == 4);
}

TEST_CASE("pairs keep their identity and age while followed, and are dropped past the reach", "[contact]") {
  const auto A = surface(box({0.04, 0.04, 0.04})), B = surface(box({0.4, 0.4, 0.02}));
  ContactSet set(A, {{B, {Quat::Identity(), {0, 0, -0.01}}}}, Vec3::Zero(), 256);
  Pose X{Quat::Identity(), {0, 0, 0.0201}};
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  set.seed(all_pairs(*A, *B), X, kNoDeadline);
  const std::size_t n = set.limits().size();
  REQUIRE(n >= 4);
  for (int tick = 1; tick <= 10; ++tick) {
    X.p.x() += 0.001;
    REQUIRE(set.track(X, 0.001, kNoDeadline));
    REQUIRE(set.limits().size() == n);
    for (const Contact& c : set.limits()) REQUIRE(c.age == tick);
    REQUIRE(set.seed(all_pairs(*A, *B), X, kNoDeadline) == 0);  // nothing new: the followed pairs are these
  }
  X.p.z() += 0.002;
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  REQUIRE(set.limits().empty());
}

TEST_CASE("a corner in a concave corner is limited by both faces", "[contact]") {
  // An L: floor and wall that meet in a concave edge along y, made of one connected surface.
  TriangleMesh L;
  L.vertices = {{0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}, {-0.2, 1, 1}, {-0.2, -1, 1}};
  L.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  const auto B = surface(L), A = surface(box({0.04, 0.04, 0.04}));
  ContactSet set(A, {{B, Pose{}}}, Vec3::Zero(), 256);
  const Pose X{Quat::Identity(), {0.0205, 0, 0.0203}};
  REQUIRE(set.track(X, 0.002, kNoDeadline));
  set.seed(all_pairs(*A, *B), X, kNoDeadline);
  bool floor = false, wall = false;
  const Vec3 wall_normal = Vec3(1, 0, 0.2).normalized();
  for (const Contact& c : set.limits()) {
    floor |= c.n.z() > 0.999;
    wall |= c.n.dot(wall_normal) > 0.999;
  }
  REQUIRE(floor);
  REQUIRE(wall);
}

TEST_CASE("capacity is kept and its overflow counted", "[contact]") {
  const auto A = surface(box({0.04, 0.04, 0.04})), B = surface(box({0.4, 0.4, 0.02}));
  ContactSet set(A, {{B, {Quat::Identity(), {0, 0, -0.01}}}}, Vec3::Zero(), 2);
  const Pose X{Quat::Identity(), {0, 0, 0.0201}};
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  set.seed(all_pairs(*A, *B), X, kNoDeadline);
  REQUIRE(set.limits().size() == 2);
  REQUIRE(set.overflow() > 0);
}
