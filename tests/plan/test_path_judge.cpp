// What the judge spares itself changes nothing: every pose, asked of FCL one by one.
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "models/puzzles.hpp"
#include "plan/path_judge.hpp"
#include "tegotae/mesh/mass.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Poses of a motion in contact, each of them asked about; the first pose too.
std::int64_t intersecting(const FclOracle& oracle, const Pose& from, const Pose& to, const Vec3& center,
                          std::int64_t steps) {
  const Displacement d = displacement(from, to, center);
  std::int64_t found = oracle.intersecting(from).empty() ? 0 : 1;
  for (std::int64_t k = 1; k <= steps; ++k) {
    const Pose X = displaced(from, center, static_cast<double>(k) / static_cast<double>(steps) * d);
    found += oracle.intersecting(X).empty() ? 0 : 1;
  }
  return found;
}

}  // namespace

TEST_CASE("the judge finds as many poses in contact as FCL at each of them") {
  const shapes::Puzzle p = shapes::puzzle("straight");
  const Scene scene = p.scene();
  const FclOracle oracle(scene);
  const Vec3 center = mass_properties(p.held, true).center;
  plan::PathJudge judge(scene, center);
  Pose up = p.start, aside = p.start, out = p.start;
  up.p.z() += 0.004;
  aside.p += Vec3(0.4e-3, 0, 0.001);
  out.p += Vec3(0, 0, 0.08);
  Pose turned = out;
  turned.q = Quat(Eigen::AngleAxisd(1, Vec3::UnitX()));
  const Pose across{turned.q, p.start.p + Vec3(0, 0, 0.01)};
  std::int64_t bad = 0;
  for (const auto& [from, to] :
       {std::pair{p.start, up}, {p.start, aside}, {p.start, out}, {out, turned}, {turned, across}}) {
    const plan::PathVerdict verdict = judge.ask({from, to});
    REQUIRE(verdict.poses > 2);
    const std::int64_t steps = verdict.poses - 1;
    const Displacement d = displacement(from, to, center);
    const std::int64_t found = intersecting(oracle, from, to, center, steps);
    CHECK(verdict.intersecting == found);
    bad += found;
    // No point goes more than 20 µm in a step.
    for (const Vec3& v : p.held.vertices)
      CHECK(((displaced(from, center, 1.0 / static_cast<double>(steps) * d) * v) - from * v).norm() < 20.001e-6);
    CHECK(judge.ask({from, to}).intersecting == found);
  }
  CHECK(bad > 20);
}

// The peg has 0.1 mm of play on each side.
TEST_CASE("what FCL said of one path spares the poses near to it, and those alone") {
  const shapes::Puzzle p = shapes::puzzle("straight");
  const Scene scene = p.scene();
  const FclOracle oracle(scene);
  const Vec3 center = mass_properties(p.held, true).center;
  plan::PathJudge judge(scene, center);
  const auto beside = [&](double x, double turn) {
    Pose from = p.start;
    from.p.x() += x;
    from.q = Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    Pose to = from;
    to.p.z() += 0.03;
    return std::vector<Pose>{from, to};
  };
  CHECK(judge.ask(beside(0, 0)).intersecting == 0);
  const std::int64_t first = judge.asked();
  REQUIRE(first > 100);
  CHECK(judge.ask(beside(20e-6, 0)).intersecting == 0);
  CHECK(judge.ask(beside(-10e-6, 1e-3)).intersecting == 0);
  CHECK(judge.asked() - first < first / 2);
  for (const double x : {60e-6, 95e-6, 105e-6, 0.2e-3})
    for (const double turn : {0.0, 3e-3}) {
      const std::vector<Pose> path = beside(x, turn);
      const plan::PathVerdict verdict = judge.ask(path);
      CHECK(verdict.intersecting == intersecting(oracle, path[0], path[1], center, verdict.poses - 1));
      CHECK((verdict.intersecting > 0) == (x + 0.01 * turn > 0.1e-3));  // the peg's faces are 10 mm off its axis
    }
}
