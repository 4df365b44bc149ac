#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies.hpp"
#include "catch.hpp"
#include "contact/contact_set.hpp"
#include "models/shapes.hpp"
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
  REQUIRE(set.constraints().empty());
  REQUIRE(set.seed(all_pairs(*A, *B), X, kNoDeadline) >= 4);
  int corners_found = 0;
  for (double sx : {-0.02, 0.02})
    for (double sy : {-0.02, 0.02}) {
      const Vec3 r = X.q * Vec3(sx, sy, -0.02);
      for (const Contact& c : set.constraints())
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
  const std::size_t n = set.constraints().size();
  REQUIRE(n >= 4);
  for (int tick = 1; tick <= 10; ++tick) {
    X.p.x() += 0.001;
    REQUIRE(set.track(X, 0.001, kNoDeadline));
    REQUIRE(set.constraints().size() == n);
    for (const Contact& c : set.constraints()) REQUIRE(c.age == tick);
    REQUIRE(set.seed(all_pairs(*A, *B), X, kNoDeadline) == 0);  // nothing new: the followed pairs are these
  }
  X.p.z() += 0.002;
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  REQUIRE(set.constraints().empty());
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
  for (const Contact& c : set.constraints()) {
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
  REQUIRE(set.constraints().size() == 2);
  REQUIRE(set.overflow() > 0);
}

TEST_CASE("of too many pairs those that hold the part to all sides are followed, and dropped ones come back",
          "[contact]") {
  // A cylinder stands upright on a floor: 400 corners of its rim are at the same height.
  constexpr int n = 400;
  constexpr std::size_t most = 48;
  const auto A = surface(shapes::cylinder(0.04, 0.02, n)), B = surface(box({0.4, 0.4, 0.02}));
  ContactSet set(A, {{B, {Quat::Identity(), {0, 0, -0.01}}}}, Vec3::Zero(), 4096, most);
  const Pose X{Quat::Identity(), {0.01, 0.02, 0.01 + 5e-6}};
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  const std::vector<FacePair> triangles = all_pairs(*A, *B);
  int found = 0;
  while (const int fresh = set.seed(triangles, X, kNoDeadline)) found += fresh;
  REQUIRE(found >= n);
  const int overflow_before = set.overflow();
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  CHECK(set.followed() == most);
  CHECK(set.overflow() - overflow_before == found - static_cast<int>(most));
  // In every direction there is a corner that stands farther out than 0.95 of the radius.
  for (int k = 0; k < 64; ++k) {
    const Vec3 out(std::cos(2 * M_PI * k / 64), std::sin(2 * M_PI * k / 64), 0);
    double farthest = 0;
    for (const Contact& c : set.constraints()) farthest = std::max(farthest, c.r.dot(out));
    CHECK(farthest > 0.95 * 0.02);
  }
  // Chosen once more from the same pairs, nothing changes; what was dropped can be started again.
  const std::vector<Contact> constraints = set.constraints();
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  REQUIRE(set.constraints().size() == constraints.size());
  for (std::size_t i = 0; i < constraints.size(); ++i) CHECK(set.constraints()[i].r == constraints[i].r);
  CHECK(set.overflow() == 0);
  CHECK(set.seed(triangles, X, kNoDeadline) > 0);
}

TEST_CASE("pairs that carry force are followed however many are nearer", "[contact]") {
  constexpr std::size_t most = 16;
  const auto A = surface(shapes::cylinder(0.04, 0.02, 200)), B = surface(box({0.4, 0.4, 0.02}));
  ContactSet set(A, {{B, {Quat::Identity(), {0, 0, -0.01}}}}, Vec3::Zero(), 4096, most);
  // Leaning by a milliradian: the rim is up to 40 µm higher on one side.
  const Pose X{rotation({0.001, 0, 0}), {0, 0, 0.01 + 3e-5}};
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  while (set.seed(all_pairs(*A, *B), X, kNoDeadline) > 0) {
  }
  std::vector<Vec3> farthest;
  for (int i = 0; i < 5; ++i) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < set.constraints().size(); ++k) {
      const Vec3& r = set.constraints()[k].r;
      const bool taken = std::any_of(farthest.begin(), farthest.end(), [&r](const Vec3& q) { return q == r; });
      if (!taken && (at == 0 || set.constraints()[k].gap > set.constraints()[at].gap)) at = k;
    }
    set.carries(at);
    farthest.push_back(set.constraints()[at].r);
  }
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  CHECK(set.followed() == most);
  for (const Vec3& r : farthest)
    CHECK(std::any_of(set.constraints().begin(), set.constraints().end(), [&r](const Contact& c) { return c.r == r; }));
}

TEST_CASE("a face in the middle of a large flat region leads to the corners of the region", "[contact]") {
  // The one pair that was in the way lies in the middle of both: no corner, no rim.
  const auto A = surface(shapes::box({0.04, 0.04, 0.04}, {20, 20, 1})),
             B = surface(shapes::box({0.4, 0.4, 0.02}, {40, 40, 1}));
  ContactSet set(A, {{B, {Quat::Identity(), {0, 0, -0.01}}}}, Vec3::Zero(), 256);
  const Pose X{Quat::Identity(), {0.003, 0.002, 0.02001}};
  const auto in_the_middle = [](const Surface& s, const Pose& pose, double z) {
    for (std::uint32_t f = 0; f < s.mesh->triangles.size(); ++f) {
      Vec3 sum = Vec3::Zero();
      for (const std::uint32_t v : s.mesh->triangles[f]) sum += pose * s.mesh->vertices[v] / 3;
      if (std::abs(sum.z() - z) < 1e-9 && (sum - Vec3(0.003, 0.002, z)).norm() < 0.008) return f;
    }
    return kNone;
  };
  const FacePair t{0, in_the_middle(*A, X, 1e-5), in_the_middle(*B, {Quat::Identity(), {0, 0, -0.01}}, 0)};
  REQUIRE(t.a != kNone);
  REQUIRE(t.b != kNone);
  REQUIRE(set.track(X, 0.001, kNoDeadline));
  REQUIRE(set.seed({t}, X, kNoDeadline) == 4);
  REQUIRE(set.constraints().size() == 4);
  for (const Contact& c : set.constraints()) {
    CHECK(std::abs(c.r.x()) == Approx(0.02));
    CHECK(std::abs(c.r.y()) == Approx(0.02));
    CHECK(c.gap == Approx(1e-5));
  }
}

TEST_CASE("a cutting plane knows how far apart its triangles are", "[contact]") {
  const auto triangle = [](const Vec3& at) {
    TriangleMesh mesh;
    mesh.vertices = {at, at + Vec3(0.01, 0, 0), at + Vec3(0, 0.01, 0)};
    mesh.triangles = {{0, 1, 2}};
    return surface(std::move(mesh));
  };
  // Over the other by `height`, or beside it: then the corner at its own origin is nearest to the other's second one.
  const auto B = triangle(Vec3::Zero());
  for (const double beside : {0.0, 0.02}) {
    const double height = 1e-5;
    const double apart = beside > 0 ? std::hypot(beside - 0.01, height) : height;
    ContactSet set(triangle(Vec3(beside, 0, height)), {{B, Pose{}}}, Vec3::Zero(), 64);
    REQUIRE(set.track(Pose{}, 0.03, kNoDeadline));
    const Displacement d{Vec3(-0.02, 0, -2e-5), Vec3::Zero()};
    REQUIRE(set.add_cutting_planes({{0, 0, 0}}, d, 1e-6, kNoDeadline) == 1);
    REQUIRE(set.constraints().size() == 1);
    CHECK(set.touches(0, 1.001 * apart));
    CHECK_FALSE(set.touches(0, 0.999 * apart));
  }
}

TEST_CASE("a cutting plane's triangle may have collapsed in welding", "[contact]") {
  // Two of its corners are one vertex: it has no edges to walk over, and is the way between the other two.
  TriangleMesh flat;
  flat.vertices = {Vec3::Zero(), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0)};
  flat.triangles = {{0, 1, 2}, {0, 1, 1}};
  TriangleMesh over = flat;
  const double height = 1e-5;
  for (Vec3& v : over.vertices) v.z() += height;
  ContactSet set(surface(over), {{surface(flat), Pose{}}}, Vec3::Zero(), 64);
  REQUIRE(set.track(Pose{}, 0.03, kNoDeadline));
  const Displacement d{Vec3(0, 0, -2e-5), Vec3::Zero()};
  REQUIRE(set.add_cutting_planes({{0, 1, 0}, {0, 0, 1}, {0, 1, 1}}, d, 1e-6, kNoDeadline) > 0);
  for (std::size_t i = 0; i < set.constraints().size(); ++i) {
    CHECK(set.touches(i, 1.001 * height));
    CHECK_FALSE(set.touches(i, 0.999 * height));
  }
}

TEST_CASE("a pair of triangles with hundreds of places to look at is left when time ends", "[contact]") {
  // A disk of 512 corners and facets of its rim over a fine floor; the reach is many facets of the floor wide.
  const auto A = surface(shapes::cylinder(0.04, 0.01, 512)), B = surface(shapes::box({0.1, 0.1, 0.02}, {150, 150, 1}));
  const Pose X{Quat::Identity(), {0.001, 0.002, 0.0155}};
  const std::vector<FacePair> pair = [&] {
    // A face of the disk's lower cap, and the one of the floor under it.
    const auto lowest = [](const TriangleMesh& m, double side) {
      std::uint32_t best = 0;
      double most = -INFINITY;
      for (std::uint32_t f = 0; f < m.triangles.size(); ++f) {
        double z = 0;
        for (const std::uint32_t v : m.triangles[f]) z += side * m.vertices[v].z();
        if (z > most + 1e-9) best = f, most = z;
      }
      return best;
    };
    return std::vector<FacePair>{{0, lowest(*A->mesh, -1), lowest(*B->mesh, 1)}};
  }();
  // Least of several: other work on the machine only adds. What a call has no time for comes with the next.
  int later = 0;
  const auto seed = [&](std::int64_t time_ns, int& fresh) {
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (int i = 0; i < 5; ++i) {
      ContactSet set(A, {{B, {Quat::Identity(), {0, 0, 0}}}}, Vec3::Zero(), 1024);
      REQUIRE(set.track(X, 0.008, kNoDeadline));
      const std::int64_t start = monotonic_ns();
      fresh = set.seed(pair, X, time_ns < 0 ? kNoDeadline : start + time_ns);
      least = std::min(least, monotonic_ns() - start);
      later = set.seed(pair, X, kNoDeadline);
    }
    return least;
  };
  int all = 0, some = 0;
  const std::int64_t whole = seed(-1, all), part = seed(whole / 8, some);
  CAPTURE(whole, part, all, some, later);
  CHECK(all >= 16);
  CHECK(some < all);
  CHECK(some + later == all);
  CHECK(part < 2 * whole / 3);
}
