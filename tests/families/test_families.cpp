// The families' parts are what they claim to be, and each judge finds the fault that it is there for.
#include "catch.hpp"
#include "families/judges.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

FamilyParameters small(const std::string& family, unsigned seed) {
  FamilyParameters p;
  p.family = family;
  p.seed = seed;
  p.clearance = 0.1e-3;
  p.near = 4;
  return p;
}

/// How a part goes that is rigid and quasi-static, or one with a fault.
struct Part1d {
  double stops = 0;  ///< m beyond the seat
  bool felt = true;  ///< while it is held back
  double lags = 0;   ///< m behind the pen in free space
  int late = 0;      ///< ticks it stays where it was after the pen was lifted off
  double gap = 0;    ///< m that its contacts are off
};

/// What the judges find on the case's own pen.
std::vector<Finding> judged(const Part1d& part, const CaseOptions& options = {}) {
  const FamilyCase c = make_family(small("flat", 1));
  Truth truth;
  truth.margin = truth.slack = 21e-6;
  truth.follows = 1e-9;
  truth.lag = 1e-4;
  const CasePen pen(c, 100);
  Judges judges(c, options, truth);
  int late = part.late;
  for (int tick = 0; tick < pen.ticks(); ++tick) {
    const Phase phase = pen.phase(tick);
    const double y = (pen.pose(tick).p - c.seat.p).dot(c.approach);
    double x = std::min(y, part.stops);
    if (phase == Phase::approach) x = std::min(x, y - part.lags);
    const bool lifted = phase == Phase::lift || phase == Phase::away;
    if (lifted && y < -truth.margin && late-- > 0) x = part.stops;
    const double off = std::abs(y - x);
    const bool contact = part.felt && x >= part.stops;
    judges.look(
        {phase, pen.last(tick), y, x, off, contact ? c.scene.coupling.stiffness * off : 0, contact ? 1 : 0, part.gap});
  }
  return judges.findings(0);
}

bool found(const std::vector<Finding>& findings, const std::string& what) {
  for (const Finding& f : findings)
    if (f.what.find(what) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("parts of the families start free, and FCL finds touching where the closed form puts the seat",
          "[families]") {
  for (const std::string& family : family_names()) {
    for (const unsigned seed : {1U, 2U}) {
      const FamilyCase c = make_family(small(family, seed));
      CAPTURE(family, seed);
      const TouchLine line(c.scene);
      REQUIRE(line.distance(c.scene.parts.back().pose) > 0);
      const double touch = find_truth(c, line).touch;
      REQUIRE(c.rest);
      const double slack = 4 * c.sagitta + 2e-6 * c.gain;
      CHECK(touch >= c.rest->low - slack);
      CHECK(touch <= c.rest->high + slack);
      CHECK(touch < c.press);
    }
  }
}

TEST_CASE("parts of the families have about the triangles asked for, and no flaw but open sheets' rims", "[families]") {
  for (const std::string& family : family_names()) {
    // The bits of a seed choose between open sheets and solids, among others.
    for (const unsigned seed : {1U, 3U}) {
      const FamilyCase c = make_family(small(family, seed));
      CAPTURE(family, seed);
      std::size_t triangles = 0;
      for (const Part& part : c.scene.parts) {
        const MeshReport r = report(*part.mesh);
        CAPTURE(part.name);
        CHECK(r.degenerate_faces == 0);
        CHECK(r.duplicate_faces == 0);
        CHECK(r.components == 1);
        CHECK((r.closed || (seed == 1 && !r.closed)));
        triangles += part.mesh->triangles.size();
      }
      const int asked = c.parameters.triangles;
      CHECK(triangles > static_cast<std::size_t>(asked) / 2);
      CHECK(triangles < static_cast<std::size_t>(asked) * 8);
      CHECK(c.scene.parts.size() == static_cast<std::size_t>(c.parameters.near) + 1);
    }
  }
}

TEST_CASE("the same numbers give the same case, an unknown family is refused", "[families]") {
  const FamilyCase a = make_family(small("text", 5)), b = make_family(small("text", 5));
  REQUIRE(a.scene.parts[0].mesh->vertices == b.scene.parts[0].mesh->vertices);
  REQUIRE(make_family(small("text", 6)).scene.parts[0].mesh->vertices != a.scene.parts[0].mesh->vertices);
  REQUIRE_THROWS_AS(make_family(small("hat", 1)), Error);
}

TEST_CASE("judges find nothing where a part behaves, and each fault where it does not", "[families]") {
  CHECK(judged({}).empty());
  CHECK(judged({}, {true, {}}).empty());
  CHECK(judged({-15e-6, true, 0, 0, 0}).empty());  // a gap is kept

  const auto wall = judged({-0.3e-3, false, 0, 0, 0});  // what the issue is about
  CHECK(found(wall, "rests short"));
  CHECK(found(wall, "force at rest"));
  CHECK(found(wall, "held back without a contact"));
  CHECK(found(wall, "off the pen in free space"));
  CHECK(found(wall, "sliding on a plane seat"));

  CHECK(found(judged({0, true, 0, 0, 1.1e-4}), "held back without a contact"));
  CHECK(judged({0, true, 0, 0, 0.9e-4}).empty());

  const auto through = judged({0.4e-3, true, 0, 0, 0});
  CHECK(found(through, "rests beyond its seat"));
  CHECK_FALSE(found(through, "rests short"));

  const auto mute = judged({0, false, 0, 0, 0});
  CHECK(found(mute, "force at rest"));
  CHECK_FALSE(found(mute, "rests short"));

  CHECK(found(judged({0, true, 2e-9, 0, 0}), "off the pen in free space"));
  CHECK(judged({0, true, 0, 49, 0}).empty());
  CHECK(found(judged({0, true, 0, 60, 0}), "lifted, the part follows after"));
  CHECK(found(judged({0, true, 0, 100000, 0}), "lifted, the part does not follow"));
}

TEST_CASE("FCL sees where small parts intersect", "[families]") {
  FamilyParameters p = small("ball", 2);
  p.size = 0.002;
  p.triangles = 20000;
  const FamilyCase c = make_family(p);
  const TouchLine line(c.scene);
  CHECK_FALSE(line.intersects(c.scene.parts.back().pose));
  CHECK(line.intersects({c.seat.q, c.seat.p + c.press * c.approach}));
}

TEST_CASE("FCL's line stops at an open sheet that it would cross, and at a seat that fits to the last bit",
          "[families]") {
  FamilyParameters p = small("wave", 1);
  p.clearance = 0;
  p.near = 1;
  const FamilyCase c = make_family(p);
  const TouchLine line(c.scene);
  const Pose from = c.scene.parts.back().pose;
  CHECK(line.travel(from, c.approach, 2 * c.start, 1e-8) == Approx(c.start).margin(2e-8));
  // Small triangles too: of 2 mm parts they have edges of 60 um.
  p.size = 0.002;
  const FamilyCase tiny = make_family(p);
  const TouchLine tiny_line(tiny.scene);
  CHECK(tiny_line.travel(tiny.scene.parts.back().pose, tiny.approach, 2 * tiny.start, 1e-8) ==
        Approx(tiny.start).margin(2e-8));
  // Up and away nothing stops it.
  CHECK(line.travel(from, -c.approach, 0.1, 1e-8) == 0.1);
}
