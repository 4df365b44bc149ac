// The hole that grows: play of a part between two walls and of a peg in its hole, against closed forms.
#include "bodies.hpp"
#include "catch.hpp"
#include "experiments/clearance.hpp"
#include "models/shapes.hpp"

using namespace tegotae;
using namespace tegotae::test;
using experiments::Clearance;
using experiments::measure_clearance;

namespace {

constexpr double kForce = 4.0;  // N

/// A cube of 20 mm between two walls across x, `gap` (m) from it on both sides.
Scene slot(const std::string& resolver, double stiffness, double gap) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.penalty.stiffness = stiffness;
  const auto wall = shared(shapes::box({0.02, 0.1, 0.1}));
  for (const double side : {-1.0, 1.0})
    scene.parts.push_back({side < 0 ? "left" : "right", wall, {Quat::Identity(), {side * (0.02 + gap), 0, 0}}, false});
  scene.parts.push_back({"cube", shared(shapes::box({0.02, 0.02, 0.02})), Pose{}, true});
  return scene;
}

}  // namespace

TEST_CASE("between two walls the penalty method adds twice force / (4 stiffness) of play", "[clearance]") {
  const double stiffness = GENERATE(500.0, 5000.0, 50000.0), gap = 1e-4;
  CAPTURE(stiffness);
  const Clearance c = measure_clearance(slot("penalty", stiffness, gap), Pose{}, Vec3::UnitX(), kForce);
  REQUIRE(c.held);
  const double sunk = kForce / (4 * stiffness);
  CHECK(c.play - 2 * gap == Approx(2 * sunk).epsilon(0.01));
  CHECK(c.deepest == Approx(sunk).epsilon(0.01));
}

TEST_CASE("between two walls the programs and the impulses add none", "[clearance]") {
  const std::string resolver = GENERATE("qp", "lp", "impulse");
  CAPTURE(resolver);
  const double gap = 1e-4;
  const Clearance c = measure_clearance(slot(resolver, 1, gap), Pose{}, Vec3::UnitX(), kForce);
  REQUIRE(c.held);
  CHECK(c.play <= 2 * gap);
  CHECK(c.play >= 2 * gap - 2.5e-5);  // both sides keep up to 10 um
  CHECK(c.deepest == 0.0);
}

TEST_CASE("a hole of 10 um of clearance grows under penalty, not under qp", "[clearance]") {
  shapes::Block block;
  block.segments = 64;
  block.through = true;
  shapes::Peg peg;
  peg.segments = 64;
  peg.diameter = 0.9995 * block.hole_diameter;
  Scene scene;
  scene.parts.push_back({"hole", shared(shapes::block_with_hole(block)), Pose{}, false});
  scene.parts.push_back({"peg", shared(shapes::peg(peg)), Pose{}, true});
  const Pose inside{Quat::Identity(), {0, 0, -block.size.z() / 2}};
  const Vec3 side(1, 0, 0);  // corner on corner
  // The corners of both polygons lie on the x axis: the peg's on its circle, the hole's on the circle about it.
  const double geometric = block.hole_diameter / std::cos(M_PI / block.segments) - peg.diameter;
  const Clearance qp = measure_clearance(scene, inside, side, kForce);
  REQUIRE(qp.held);
  CHECK(qp.play <= geometric);
  CHECK(qp.deepest == 0.0);
  double last = INFINITY;
  scene.contact.resolver = ResolverKind::penalty;
  for (const double stiffness : {500.0, 5000.0, 50000.0}) {
    scene.contact.penalty.stiffness = stiffness;
    const Clearance c = measure_clearance(scene, inside, side, kForce);
    REQUIRE(c.held);
    const double more = c.play - geometric;
    CHECK(more > 0);
    CHECK(more < last);
    // No fewer than one vertex carries each side, and its way is across the wall.
    CHECK(more <= 2 * kForce / stiffness);
    last = more;
  }
}
