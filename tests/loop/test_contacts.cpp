// HapticLoop::contacts() and contact_events(), judged by the meshes themselves, closed forms, and the wrench.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const auto kBlock = shared(box(Vec3(0.02, 0.02, 0.02)));
const auto kBoard = shared(box(Vec3(0.2, 0.2, 0.01)));

enum PartIndex : std::uint32_t { kWall, kHeld, kFloor };

/// A block between a floor at z = 0 and a wall at x = 0.03; the held part is neither the first nor the last.
Scene corner_scene(const std::string& resolver) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  scene.parts = {{"wall", kBoard, {rotation(Vec3(0, M_PI / 2, 0)), Vec3(0.035, 0, 0)}},
                 {"block", kBlock, {Quat::Identity(), Vec3(0, 0, 0.012)}, true},
                 {"floor", kBoard, {Quat::Identity(), Vec3(0, 0, -0.005)}}};
  return scene;
}

/// Down onto the floor, along it to the wall and back, and up again.
Pose pen(int tick) {
  const double t = 1e-3 * tick;
  const double down = std::clamp(t / 0.2, 0.0, 1.0) - std::clamp((t - 0.8) / 0.1, 0.0, 1.0);
  const double along = std::clamp((t - 0.3) / 0.4, 0.0, 1.0) - std::clamp((t - 0.75) / 0.1, 0.0, 1.0);
  return {Quat::Identity(), Vec3(0.022 * along, 0, 0.012 - 0.003 * down)};
}
constexpr int kTicks = 1000;

/// Distance (m) of a point in the world from a feature of a part at `X`; an edge's number means nothing here.
double distance(const TriangleMesh& mesh, const Pose& X, const Feature& f, const Vec3& p_W) {
  const Vec3 p = X.inverse() * p_W;
  if (f.kind == FeatureKind::vertex) return (mesh.vertices.at(f.index) - p).norm();
  if (f.kind == FeatureKind::edge) return 0;
  const auto& t = mesh.triangles.at(f.index);
  const Vec3 a = mesh.vertices[t[0]];
  const Vec3 n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
  return std::abs(n.dot(p - a));
}

using Identity = std::tuple<std::uint32_t, FeatureKind, std::uint32_t, FeatureKind, std::uint32_t>;
Identity identity(const ContactPoint& c) {
  return {c.part.index, c.feature_a.kind, c.feature_a.index, c.feature_b.kind, c.feature_b.index};
}

}  // namespace

TEST_CASE("contacts name part, features and points of both surfaces", "[contacts]") {
  const std::string resolver = GENERATE("qp", "lp", "impulse", "penalty");
  CAPTURE(resolver);
  const Scene scene = corner_scene(resolver);
  HapticLoop loop(scene);
  CHECK(loop.contacts().empty());
  std::map<std::uint32_t, int> seen;
  double off = 0, gap_off = 0, plane = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    const TickReport& r = loop.step(pen(tick), 1e-3);
    CHECK(loop.contacts().empty() == (r.contacts == 0));
    for (const ContactPoint& c : loop.contacts()) {
      REQUIRE((c.part.index == kWall || c.part.index == kFloor));
      ++seen[c.part.index];
      const Part& part = scene.parts[c.part.index];
      off = std::max(off, distance(*kBlock, r.proxy.X, c.feature_a, c.point_a));
      off = std::max(off, distance(*part.mesh, part.pose, c.feature_b, c.point_b));
      gap_off = std::max(gap_off, (c.point_a - c.point_b - c.gap * c.normal).norm());
      CHECK(c.gap <= r.contact_gap);
      // The floor's upper face is z = 0 and faces up; the wall's is x = 0.03 and faces towards -x.
      const bool on_floor = c.part.index == kFloor;
      const bool of_corner = c.feature_a.kind == FeatureKind::vertex || c.feature_b.kind == FeatureKind::face;
      if (!of_corner) continue;
      plane = std::max(plane, on_floor ? std::abs(c.point_b.z()) : std::abs(c.point_b.x() - 0.03));
      CHECK(c.normal.dot(on_floor ? Vec3(0, 0, 1) : Vec3(-1, 0, 0)) == Approx(1).margin(1e-6));
    }
  }
  // Impulses know the constraints of the pose before the last piece, of up to a fraction of the contact gap.
  CHECK(off < (resolver == "impulse" ? 2e-5 : 1e-9));
  CHECK(gap_off < 1e-12);
  CHECK(plane < (resolver == "impulse" ? 2e-5 : 1e-9));
  CHECK(seen[kFloor] > 200);
  CHECK(seen[kWall] > 50);
}

TEST_CASE("events tell of every contact when it begins and when it ends", "[contacts]") {
  const std::string resolver = GENERATE("qp", "lp", "impulse", "penalty");
  CAPTURE(resolver);
  HapticLoop loop(corner_scene(resolver));
  std::map<Identity, std::int64_t> alive;  // the tick in which each began, by events alone
  int began = 0, ended = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    loop.step(pen(tick), 1e-3);
    for (const ContactEvent& e : loop.contact_events()) {
      if (e.kind == ContactEvent::Kind::began) {
        ++began;
        REQUIRE(alive.emplace(identity(e.contact), tick).second);
      } else {
        ++ended;
        REQUIRE(alive.erase(identity(e.contact)) == 1);
      }
    }
    REQUIRE(alive.size() == loop.contacts().size());
    for (const ContactPoint& c : loop.contacts()) REQUIRE(alive.at(identity(c)) + c.ticks == tick);
  }
  CHECK(alive.empty());  // up in the air
  CHECK(began == ended);
  CHECK(began > 4);
}

TEST_CASE("the forces of the contacts are the wrench of the springs", "[contacts]") {
  const Scene scene = corner_scene("qp");
  HapticLoop loop(scene);
  for (int tick = 0; tick < 250; ++tick) loop.step(pen(tick), 1e-3);
  const TickReport& r = loop.step(pen(250), 1e-3);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (const ContactPoint& c : loop.contacts()) {
    REQUIRE(c.force);
    CHECK(*c.force >= 0);
    force += *c.force * c.normal;
    torque += (c.point_a - r.proxy.X * loop.center()).cross(*c.force * c.normal);
  }
  const Wrench springs = coupling_wrench(loop.coupling(), {r.proxy.X, {}, true}, pen(250), {}, loop.center());
  // The pen is 1 mm in the floor, less the gap that is kept: 0.8 N.
  CHECK(springs.force.z() == Approx(0.8).epsilon(0.02));
  CHECK((force - springs.force).norm() < 0.01 * springs.force.norm());
  CHECK((torque - springs.torque).norm() < 1e-4 * springs.force.norm());
}

TEST_CASE("resolvers without contact forces say so", "[contacts]") {
  const std::string resolver = GENERATE("lp", "impulse", "penalty");
  HapticLoop loop(corner_scene(resolver));
  for (int tick = 0; tick < 250; ++tick) loop.step(pen(tick), 1e-3);
  REQUIRE(!loop.contacts().empty());
  for (const ContactPoint& c : loop.contacts()) CHECK(!c.force);
}

TEST_CASE("after a change of the scene contacts are the new scene's", "[contacts]") {
  Scene scene = corner_scene("qp");
  HapticLoop loop(scene);
  for (int tick = 0; tick < 250; ++tick) loop.step(pen(tick), 1e-3);
  REQUIRE(!loop.contacts().empty());
  // Without the wall the floor has another number.
  scene.parts.erase(scene.parts.begin());
  scene.parts[0].pose = loop.latest();
  loop.change(scene);
  loop.step(pen(250), 1e-3);
  REQUIRE(loop.change_in_force() == 1);
  for (int tick = 0; tick < 20; ++tick) {
    for (const ContactEvent& e : loop.contact_events()) CHECK(e.contact.part == PartId{1});
    for (const ContactPoint& c : loop.contacts()) CHECK(c.part == PartId{1});
    loop.step(pen(250), 1e-3);
  }
  CHECK(!loop.contacts().empty());
}
