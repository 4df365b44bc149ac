// The puzzles are what they say: closed parts, and a way out by construction that FCL finds free.
#include "bodies.hpp"
#include "broadphase/bounding_spheres.hpp"
#include "catch.hpp"
#include "models/bricks.hpp"
#include "models/helical.hpp"
#include "models/puzzles.hpp"
#include "path_check.hpp"
#include "plan/exit.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

TEST_CASE("bricks make the solid that they cover") {
  using shapes::Brick;
  const TriangleMesh one = shapes::solid_of("one", {{{0, 0, 0}, {1, 2, 3}}});
  CHECK(one.triangles.size() == 12);
  CHECK(volume(one) == Approx(6));
  // A hole through it, and a plug in half of the hole.
  const TriangleMesh holed =
      shapes::solid_of("holed", {{{0, 0, 0}, {3, 3, 1}}, {{1, 1, 0}, {2, 2, 1}, false}, {{1, 1, 0}, {2, 2, 0.5}}});
  CHECK(report(holed).closed);
  CHECK(volume(holed) == Approx(9 - 0.5));
  CHECK_THROWS_AS(shapes::solid_of("none", {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 0}, {1, 1, 1}, false}}), Error);
  CHECK_THROWS_AS(shapes::solid_of("flat", {{{0, 0, 0}, {1, 1, 0}}}), Error);
}

TEST_CASE("threads and bent bars have the volume of their closed forms") {
  shapes::WavyThread t;
  t.segments = 256;
  t.low = -2 * t.pitch;
  // The mean of r² over whole turns is R² + depth² / 8.
  const double area = kPi * (t.radius * t.radius + t.depth * t.depth / 8);
  CHECK(volume(shapes::screw(t)) == Approx(area * 2 * t.pitch).epsilon(2e-3));
  CHECK(volume(shapes::nut(t, 0.02)) == Approx((kPi * 0.02 * 0.02 - area) * 2 * t.pitch).epsilon(2e-3));
  shapes::BentBar b;
  b.along = b.around = 128;
  // Pappus.
  const double bar = kPi * b.radius * b.radius * b.bend * (b.to - b.from);
  CHECK(volume(shapes::bent_bar(b)) == Approx(bar).epsilon(2e-3));
  const double outer = kPi * 0.007 * 0.007 * b.bend * (b.to - b.from);
  CHECK(volume(shapes::bent_pipe(b, 0.003)) == Approx(outer - bar).epsilon(2e-3));
}

TEST_CASE("puzzles are closed, start free, and their known ways lead out") {
  for (const shapes::Puzzle& p : shapes::puzzles()) {
    INFO(p.name);
    for (const TriangleMesh* mesh : {&p.held, &p.fixed}) {
      CHECK(report(*mesh).closed);
      CHECK(volume(*mesh) > 0);
    }
    const Scene scene = p.scene();
    const FclOracle oracle(scene);
    CHECK(oracle.intersecting(p.start).empty());
    const Vec3 center = mass_properties(p.held, true).center;
    const Exit exit(scene, center, radius_about(p.held, center));
    CHECK(!exit.is_out(p.start));
    if (p.known.empty()) continue;
    const PathCheck known = check_path(oracle, p.known, p.pivot, radius_about(p.held, p.pivot));
    CHECK(known.asked > 500);
    CHECK(known.intersecting == 0);
    CHECK(exit.is_out(p.known.back()));
    // The bounds that hold for every way hold for this one.
    CHECK(turn_of(p.known) >= p.least_turn);
    CHECK(way_of(p.known, center) >= p.least_way);
  }
}

TEST_CASE("the part that is locked in is larger than every hole") {
  // Behind the plate the bit reaches 9.5 mm from the shaft's axis. The shaft, 6 mm wide, fills a hole of 9.4 mm so that
  // its axis is at most 1.7 mm off; no point of the bit's end can then come into the hole, which ends 4.7 mm from the
  // middle.
  const shapes::Puzzle p = shapes::puzzle("locked-in");
  double bit = 0, hole = 0;
  for (const Vec3& v : p.held.vertices) bit = std::max(bit, v.y());
  for (const Vec3& v : p.fixed.vertices)
    if (std::abs(v.x()) < 6e-3) hole = std::max(hole, std::abs(v.x()));
  CHECK(hole == Approx(4.7e-3));
  CHECK(bit - (hole - 3e-3) > hole);
}
