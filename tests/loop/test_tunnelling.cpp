// Fast and jumping pens against thin things: the held part stays on its side, also between the committed poses. The
// sides are told by vertices and planes alone, intersections by FCL; nothing here asks the certificate.
#include <functional>

#include "bodies.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "path_oracle.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kTick = 1e-3;         // s
constexpr double kSheet = 1e-4;        // thickness, m
constexpr double kSheetSide = 0.4;     // m; no pen of these tests goes near its rim
constexpr double kSubPoseStep = 1e-4;  // m
constexpr int kMaxSubPoses = 12;
// Of 1230 ticks: a body that only spins in place meets programs that are violated by rounding alone.
constexpr int kMaxStalled = 25;

Pose at_height(double z) {
  return {Quat::Identity(), {0, 0, z}};
}

/// Two triangles in z = 0.
TriangleMesh flat_sheet() {
  TriangleMesh mesh;
  const double h = 0.5 * kSheetSide;
  mesh.vertices = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// The same plane as a soup: no two triangles share a vertex, and they are turned at random.
TriangleMesh soup_sheet() {
  constexpr int kParts = 24;
  TriangleMesh mesh;
  std::mt19937 rng(5);
  const double h = kSheetSide / kParts;
  for (int i = 0; i < kParts; ++i)
    for (int k = 0; k < kParts; ++k) {
      const Vec3 o(h * i - 0.5 * kSheetSide, h * k - 0.5 * kSheetSide, 0);
      const Vec3 p[4] = {o, o + Vec3(h, 0, 0), o + Vec3(h, h, 0), o + Vec3(0, h, 0)};
      for (const auto& t : {std::array<int, 3>{0, 1, 2}, std::array<int, 3>{0, 2, 3}}) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const int corner : t) mesh.vertices.push_back(p[corner]);
        if (rng() % 2 == 0)
          mesh.triangles.push_back({first, first + 1, first + 2});
        else
          mesh.triangles.push_back({first, first + 2, first + 1});
      }
    }
  return mesh;
}

TriangleMesh sheet(const std::string& kind) {
  if (kind == "box") return box({kSheetSide, kSheetSide, kSheet});
  return kind == "flat" ? flat_sheet() : soup_sheet();
}

TriangleMesh body(const std::string& kind) {
  if (kind == "plate") return box({0.03, 0.02, 0.001});
  if (kind == "pin") return shapes::cylinder(0.001, 0.02, 12);
  shapes::Peg peg;
  peg.diameter = 0.008;
  peg.length = 0.03;
  peg.segments = 32;
  return shapes::peg(peg);
}

Scene over_sheet(const std::string& sheet_kind, const TriangleMesh& held, const Pose& start,
                 const std::string& resolver) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"sheet", shared(sheet(sheet_kind)), Pose{}, false});
  scene.parts.push_back({"held", shared(held), start, true});
  return scene;
}

/// Steps a loop and looks at every committed piece and at poses inside it.
class Watched {
 public:
  using Check = std::function<void(const Pose&)>;

  Watched(const Scene& scene, Check check)
      : loop(scene), oracle_(scene), last_(loop.report().proxy.X), check_(std::move(check)) {
    for (const Part& p : scene.parts)
      if (p.held)
        for (const Vec3& v : p.mesh->vertices) radius_ = std::max(radius_, (v - loop.center()).norm());
  }

  const TickReport& step(const Pose& Y) {
    const TickReport& r = loop.step(Y, kTick);
    for (const Pose& X : r.substeps) {
      const double way = travel(last_, X, loop.center(), radius_);
      const int parts = std::clamp(static_cast<int>(std::ceil(way / kSubPoseStep)), 1, kMaxSubPoses);
      const auto look = [&](const Pose& P) {
        check_(P);
        REQUIRE(oracle_.intersecting(P).empty());
      };
      for (const PathKind path : {PathKind::center, PathKind::origin})
        for_poses_between(last_, X, loop.center(), parts, path, look);
      look(X);
      last_ = X;
    }
    REQUIRE(r.status != ResolveStatus::infeasible);
    stalled += r.status == ResolveStatus::stalled;
    return r;
  }

  HapticLoop loop;
  int stalled = 0;  ///< ticks whose program was given up for numerical reasons: X stays, and goes on later

 private:
  FclOracle oracle_;
  Pose last_;
  Check check_;
  double radius_ = 0;
};

}  // namespace

TEST_CASE("a 0.1 mm sheet stops a plate, a pin and a peg at 2 m/s and 20 rad/s", "[tunnelling]") {
  const std::string resolver = GENERATE("lp", "qp");
  const std::string sheet_kind = GENERATE("box", "flat", "soup");
  const std::string body_kind = GENERATE("plate", "pin", "peg");
  CAPTURE(resolver, sheet_kind, body_kind);
  const TriangleMesh held = body(body_kind);
  const double top = sheet_kind == "box" ? 0.5 * kSheet : 0;
  std::mt19937 rng(71);
  int touching = 0, stalled = 0;
  for (int round = 0; round < 6; ++round) {
    CAPTURE(round);
    // Along the axis, then with spins about random axes, and sideways across the sheet.
    const Vec3 spin = round == 0 ? Vec3(0, 0, 0) : Vec3(20 * random_direction(rng));
    const Vec3 across = round < 3 ? Vec3(0, 0, 0) : Vec3(1.2 * random_direction(rng));
    const Pose start{rotation(round == 0 ? Vec3(0, 0, 0) : Vec3(3 * random_direction(rng))), {0, 0, 0.03}};
    Watched watched(over_sheet(sheet_kind, held, start, resolver),
                    [&](const Pose& X) { REQUIRE(lowest(held, X) > top); });
    Pose Y = start;
    for (int tick = 0; tick < 60; ++tick) {
      Y = {(rotation(kTick * spin) * Y.q).normalized(),
           Y.p + kTick * Vec3(across.x(), across.y(), tick < 45 ? -2.0 : 0.0)};
      touching += watched.step(Y).proxy.touching;
    }
    // Through from below is not a way back: the pen turns to and fro under the sheet and comes up again.
    for (int tick = 0; tick < 45; ++tick) {
      Y.q = (rotation(kTick * -spin) * Y.q).normalized();
      Y.p.z() += 2.0 * kTick;
      touching += watched.step(Y).proxy.touching;
    }
    // Nothing holds the part any more: it is with its pen.
    for (int tick = 0; tick < 100; ++tick) {
      Y.p.z() += 3e-4;
      watched.step(Y);
    }
    REQUIRE((watched.loop.report().proxy.X.p - Y.p).norm() < 1e-6);
    stalled += watched.stalled;
  }
  REQUIRE(touching > 60);
  REQUIRE(stalled <= kMaxStalled);
}

TEST_CASE("a pen that jumps through a sheet leaves the part on its side", "[tunnelling]") {
  const std::string resolver = GENERATE("lp", "qp");
  const std::string sheet_kind = GENERATE("box", "flat", "soup");
  const std::string body_kind = GENERATE("plate", "pin", "peg");
  CAPTURE(resolver, sheet_kind, body_kind);
  const TriangleMesh held = body(body_kind);
  const double top = sheet_kind == "box" ? 0.5 * kSheet : 0;
  std::mt19937 rng(72);
  for (int round = 0; round < 4; ++round) {
    CAPTURE(round);
    const Pose start = at_height(0.02);
    Watched watched(over_sheet(sheet_kind, held, start, resolver),
                    [&](const Pose& X) { REQUIRE(lowest(held, X) > top); });
    // 50 mm at once, through the sheet, turned by 1 rad, then back up on the other side of the room, twice.
    for (int jump = 0; jump < 2; ++jump) {
      const Vec3 side = 0.04 * random_direction(rng);
      const Pose below{rotation(1.0 * random_direction(rng)), {side.x(), side.y(), -0.03}};
      for (int tick = 0; tick < 150; ++tick) watched.step(below);
      const Pose above{rotation(1.0 * random_direction(rng)), {-side.x(), -side.y(), 0.03}};
      for (int tick = 0; tick < 150; ++tick) watched.step(above);
      const Pose X = watched.loop.report().proxy.X;
      REQUIRE((X.p - above.p).norm() < 1e-9);
      REQUIRE(X.q.angularDistance(above.q) < 1e-7);
    }
  }
}

TEST_CASE("after a jump to a place behind the sheet the part goes there as far as it can", "[tunnelling]") {
  const std::string resolver = GENERATE("lp", "qp");
  const std::string sheet_kind = GENERATE("box", "flat", "soup");
  const std::string body_kind = GENERATE("plate", "pin", "peg");
  CAPTURE(resolver, sheet_kind, body_kind);
  const TriangleMesh held = body(body_kind);
  const double top = sheet_kind == "box" ? 0.5 * kSheet : 0;
  Watched watched(over_sheet(sheet_kind, held, at_height(0.02), resolver),
                  [&](const Pose& X) { REQUIRE(lowest(held, X) > top); });
  const Pose behind{Quat::Identity(), {0.04, -0.03, -0.03}};
  for (int tick = 0; tick < 200; ++tick) watched.step(behind);
  const ProxyState pressed = watched.loop.report().proxy;
  // Beside the pen it is above it, and on the sheet. A soup's edges do not know that they lie inside a plane and hold
  // the last of the way up.
  const double beside = std::hypot(pressed.X.p.x() - behind.p.x(), pressed.X.p.y() - behind.p.y());
  CHECK(beside < (sheet_kind == "soup" ? 1e-4 : 1e-6));
  CHECK(pressed.touching);
  CHECK(lowest(held, pressed.X) - top <= *watched.loop.contact().l_min);
}

TEST_CASE("a spinning rod does not pass the pins at its two ends", "[tunnelling]") {
  const std::string resolver = GENERATE("lp", "qp");
  const bool thin = GENERATE(false, true);
  CAPTURE(resolver, thin);
  constexpr double kHalf = 0.05;  // half the rod's length, m
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  const double diameter = thin ? 0.0005 : 0.004;
  TriangleMesh rod = shapes::cylinder(diameter, 2 * kHalf, 12, 4);
  for (Vec3& v : rod.vertices) v = Vec3(v.z(), v.x(), v.y());  // along x
  const auto pin = shared(shapes::cylinder(thin ? 0.0002 : 0.002, 0.04, 12));
  const Vec3 pins[] = {{0.03, 0.006, 0}, {-0.03, -0.006, 0}};
  for (const Vec3& p : pins)
    scene.parts.push_back({"pin" + std::to_string(scene.parts.size()), pin, {Quat::Identity(), p}, false});
  scene.parts.push_back({"rod", shared(rod), Pose{}, true});
  // On which side of the rod each pin is may change only while the rod does not reach it.
  double side[2] = {0, 0};
  Watched watched(scene, [&](const Pose& X) {
    for (int k = 0; k < 2; ++k) {
      const Vec3 u = X.q * Vec3::UnitX();
      // The point of the rod's line that is nearest to the pin's line, along z.
      const Vec3 d = X.p - pins[k];
      const double s = -(d.x() * u.x() + d.y() * u.y()) / (u.x() * u.x() + u.y() * u.y());
      const Vec3 nearest = d + s * u;
      const double across = u.x() * nearest.y() - u.y() * nearest.x();
      const bool reaches = std::abs(s) < kHalf && std::abs(X.p.z() + s * u.z()) < 0.02;
      if (reaches && side[k] != 0) REQUIRE(across * side[k] > 0);
      side[k] = reaches ? across : 0;
    }
  });
  double angle = 0, stopped = 0;
  // One way, the other way (the pins stop that too), then with the pen off its center.
  for (const double rate : {20.0, -20.0, 20.0}) {
    for (int tick = 0; tick < 140; ++tick) {
      angle += kTick * rate;
      const double off = rate > 0 && angle > 1 ? 0.004 : 0.0;
      const TickReport& r = watched.step({rotation({0, 0, angle}), {0, off, 0}});
      stopped += r.proxy.touching;
    }
  }
  REQUIRE(stopped > 100);
}
