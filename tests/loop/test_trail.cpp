// The way by which the part came: back along it, and on where it came back from.
#include <algorithm>
#include <random>
#include <utility>

#include "bodies.hpp"
#include "catch.hpp"
#include "loop/contact_loop.hpp"
#include "loop/trail.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/mesh/mass.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

using Side = Trail::Side;

Pose at(double x, double y) {
  return {Quat::Identity(), Vec3(x, y, 0)};
}

/// The way of a part, as straight pieces. Whether it has passed a place.
class Pieces {
 public:
  void add(const Vec3& from, const Vec3& to) { all_.emplace_back(from, to); }
  bool have_passed(const Vec3& p) const {
    return std::any_of(all_.begin(), all_.end(), [&](const auto& piece) {
      const Vec3 way = piece.second - piece.first;
      const double share = std::clamp(way.dot(p - piece.first) / way.squaredNorm(), 0.0, 1.0);
      return (piece.first + share * way - p).norm() < 1e-11;
    });
  }

 private:
  std::vector<std::pair<Vec3, Vec3>> all_;
};

/// Both as one mesh, the second moved.
TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, const Vec3& by) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  for (const Vec3& v : b.vertices) a.vertices.push_back(v + by);
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

}  // namespace

TEST_CASE("a trail leads back by the poses that the part came by", "[trail]") {
  Trail trail(Vec3::Zero(), 0.1);
  std::mt19937 rng(61);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Pose> poses = {at(0, 0)};
  for (int i = 0; i < 1000; ++i) {
    const Pose to{Quat(Eigen::AngleAxisd(u(rng), Vec3(u(rng), u(rng), u(rng)).normalized())), Vec3(u(rng), u(rng), 0)};
    trail.went(poses.back(), to);
    poses.push_back(to);
  }
  REQUIRE(trail.count(Side::back) == Trail::kPoses - 1);
  CHECK(trail.count(Side::ahead) == 0);
  CHECK(trail.is_at(poses.back()));
  for (std::size_t i = 0; i < Trail::kPoses; ++i) CHECK(trail.pose(Side::back, i).p == poses[poses.size() - 1 - i].p);
  // Back by 100 of them, which are ahead from then on, and forth by 40.
  for (std::size_t i = 0; i < 100; ++i) trail.went(poses[poses.size() - 1 - i], poses[poses.size() - 2 - i]);
  CHECK(trail.count(Side::back) == Trail::kPoses - 101);
  CHECK(trail.count(Side::ahead) == 100);
  for (std::size_t i = poses.size() - 101; i < poses.size() - 61; ++i) trail.went(poses[i], poses[i + 1]);
  CHECK(trail.is_at(poses[poses.size() - 61]));
  CHECK(trail.count(Side::ahead) == 60);
  for (std::size_t i = 0; i <= 60; ++i) CHECK(trail.pose(Side::ahead, i).p == poses[poses.size() - 61 + i].p);
  CHECK(!trail.is_at(poses.front()));
}

TEST_CASE("a trail is left in the middle of a way, and none is left of a part that jumped", "[trail]") {
  Trail trail(Vec3::Zero(), 0.1);
  trail.went(at(0, 0), at(1, 0));
  trail.touches({{0, 1, 2}});
  trail.went(at(1, 0), at(1, 1));
  trail.went(at(1, 1), at(1, 3));
  CHECK(trail.count(Side::back) == 3);
  // Part of the last way, then over a pose.
  trail.went(at(1, 3), at(1, 2));
  CHECK(trail.count(Side::back) == 3);
  trail.went(at(1, 2), at(1, 0.5));
  REQUIRE(trail.count(Side::back) == 2);
  CHECK(trail.is_at(at(1, 0.5)));
  CHECK(trail.pose(Side::back, 1).p == Vec3(1, 0, 0));
  CHECK(trail.touched_at(Side::back, 1));
  CHECK(!trail.touched_at(Side::back, 0));
  trail.went(at(1, 0.5), at(1, 0));
  std::vector<FacePair> touched;
  trail.touched(touched);
  REQUIRE(touched.size() == 1);
  CHECK(touched[0].b == 2);
  // From elsewhere.
  trail.went(at(5, 5), at(6, 5));
  CHECK(trail.count(Side::back) == 1);
  CHECK(trail.count(Side::ahead) == 0);
  trail.forget();
  CHECK(trail.count(Side::back) == 0);
  CHECK(!trail.is_at(at(6, 5)));
}

TEST_CASE("a trail goes on from where the part touched something", "[trail]") {
  Trail trail(Vec3::Zero(), 0.1);
  trail.went(at(0, 3), at(0, 1));
  trail.went(at(0, 1), at(1, 0));
  const bool touches = GENERATE(false, true);
  if (touches) trail.touches({{0, 1, 2}});
  trail.went(at(1, 0), at(0, 1));
  trail.went(at(0, 1), at(5, 1));
  REQUIRE(trail.is_at(at(5, 1)));
  CHECK(trail.count(Side::ahead) == 0);
  REQUIRE(trail.count(Side::back) == 2);
  CHECK(trail.pose(Side::back, 1).p == Vec3(0, 1, 0));
  CHECK(trail.pose(Side::back, 2).p == (touches ? Vec3(1, 0, 0) : Vec3(0, 3, 0)));
  CHECK(trail.touched_at(Side::back, 2) == touches);
}

TEST_CASE("wherever a trail leads, the part has been", "[trail]") {
  Trail trail(Vec3::Zero(), 0.1);
  std::mt19937 rng(62);
  std::uniform_real_distribution<double> u(0, 1);
  Pieces way;
  Pose X = at(0, 0);
  std::size_t longest = 0, split = 0;
  for (int i = 0; i < 4000; ++i) {
    const Side side = u(rng) < 0.6 ? Side::back : Side::ahead;
    const double kind = u(rng);
    Pose to;
    if (kind < 0.5 && trail.count(side) > 0) {
      const Vec3 next = trail.pose(side, 1).p;
      to = kind < 0.25 ? trail.pose(side, 1) : Pose{X.q, X.p + u(rng) * (next - X.p)};
      split += kind >= 0.25;
    } else {
      to = {X.q, X.p + Vec3(u(rng) - 0.5, u(rng) - 0.5, u(rng) - 0.5)};
    }
    if (kind >= 0.25 || trail.count(side) == 0) way.add(X.p, to.p);
    trail.went(X, to);
    X = to;
    if (u(rng) < 0.1) trail.touches({{0, 1, 2}});
    REQUIRE(trail.is_at(X));
    const std::size_t back = trail.count(Side::back), ahead = trail.count(Side::ahead);
    REQUIRE(back + ahead + 1 <= Trail::kPoses);
    longest = std::max(longest, back + ahead + 1);
    if (i % 50 != 0) continue;
    bool passed = true;
    for (const Side s : {Side::back, Side::ahead})
      for (std::size_t k = 1; k <= trail.count(s); ++k)
        for (const double share : {0.0, 0.31, 0.77, 1.0}) {
          const Vec3 from = trail.pose(s, k - 1).p, end = trail.pose(s, k).p;
          passed = passed && way.have_passed(from + share * (end - from));
        }
    CHECK(passed);
  }
  CHECK(split > 300);
  CHECK(longest > 100);
}

TEST_CASE("out of time, a part comes back to where it touched beside the way of the pen", "[trail]") {
  // A block on a plate, beside a post that keeps the plate near. It is lifted aside, then no tick has time for
  // anything, and the pen comes straight down.
  Scene scene;
  scene.parts = {{"plate",
                  shared(joined(box({0.2, 0.2, 0.02}), box({0.02, 0.2, 0.08}), {0.08, 0, 0.05})),
                  {Quat::Identity(), {0, 0, -0.01}}},
                 {"block", shared(box({0.04, 0.04, 0.02})), {Quat::Identity(), {0, 0, 0.02}}, true}};
  scene.contact.l_min = 2e-5;
  scene.contact.l_0 = 2e-4;
  scene.contact.tick_budget = 0.1;  // a share of it is for what was touched, after the tick's time
  ContactLoop loop(scene, scene.contact, mass_properties(*scene.parts[1].mesh, true));
  TickReport report;
  Pieces way;
  const auto step = [&](const Pose& Y, std::int64_t deadline_ns) {
    Vec3 from = loop.pose().p;
    report = {};
    loop.step(Y, 1e-3, deadline_ns, report);
    REQUIRE(report.candidate_parts == 1);
    for (const Pose& X : report.substeps) {
      if (deadline_ns == kNoDeadline && X.p != from) way.add(from, X.p);
      if (deadline_ns != kNoDeadline) CHECK(way.have_passed(X.p));
      from = X.p;
    }
  };
  for (int i = 1; i <= 40; ++i) step({Quat::Identity(), {0, 0, 0.02 - 3e-4 * i}}, kNoDeadline);
  REQUIRE(report.contacts > 0);
  const double aside = 4e-4;
  for (int i = 40; i >= 0; --i) step({Quat::Identity(), {aside / 40 * (40 - i), 0, 0.02 - 3e-4 * i}}, kNoDeadline);
  REQUIRE(report.contacts == 0);
  REQUIRE(loop.pose().p.z() > 0.0199);
  for (int i = 0; i <= 40; ++i) {
    const Pose Y = {Quat::Identity(), {aside, 0, 0.02 - 3e-4 * i}};
    step(Y, monotonic_ns());
    // As near as that way comes, up to a motion of the pen, or as the surface lets it.
    CHECK((loop.pose().p - Y.p).norm() < aside + 4e-4 + std::max(0.0, 0.01 - Y.p.z()));
  }
  CHECK(report.contacts > 0);
  CHECK(report.proxy.touching);
}

TEST_CASE("no way that a part has gone around a wall brings it through the wall", "[trail]") {
  // Over a wall of 0.2 mm, and down on its other side. Then the pen is back behind the wall.
  Scene scene;
  scene.parts = {{"wall", shared(box({0.0002, 0.2, 0.02})), Pose()},
                 {"block", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {-0.0055, 0, 0}}, true}};
  scene.contact.l_min = 2e-5;
  scene.contact.l_0 = 2e-4;
  ContactLoop loop(scene, scene.contact, mass_properties(*scene.parts[1].mesh, true));
  TickReport report;
  const auto step = [&](const Vec3& to, bool timed) {
    report = {};
    loop.step({Quat::Identity(), to}, 1e-3, timed ? monotonic_ns() : kNoDeadline, report);
  };
  const auto go = [&](const Vec3& to) {
    const Vec3 from = loop.pose().p;
    for (int i = 1; i <= 40; ++i) step(from + i / 40.0 * (to - from), false);
  };
  go({-0.0055, 0, 0.016});
  go({0.0055, 0, 0.016});
  go({0.0055, 0, 0});
  REQUIRE(loop.pose().p.x() > 0.005);
  // No tick has time, or every other one, or every fiftieth.
  const int late = GENERATE(1, 2, 50);
  for (int i = 0; i < 50; ++i) {
    step({-0.0055, 0, 0}, i % late != late - 1 || late == 1);
    REQUIRE(loop.pose().p.x() > 0.005);
  }
  for (int i = 0; i < 20; ++i) step({-0.0055, 0, 0}, false);
  CHECK(loop.pose().p.x() > 0.005);
  CHECK(report.contacts > 0);
}
