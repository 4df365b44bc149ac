// What the judge spares itself changes nothing: every pose, asked of FCL one by one.
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "models/puzzles.hpp"
#include "plan/path_judge.hpp"
#include "tegotae/mesh/mass.hpp"

using namespace tegotae;
using namespace tegotae::test;

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
    const Displacement d = displacement(from, to, center);
    std::int64_t found = oracle.intersecting(from).empty() ? 0 : 1;
    const std::int64_t steps = verdict.poses - 1;
    for (std::int64_t k = 1; k <= steps; ++k)
      found +=
          oracle.intersecting(displaced(from, center, static_cast<double>(k) / static_cast<double>(steps) * d)).empty()
              ? 0
              : 1;
    CHECK(verdict.intersecting == found);
    bad += found;
    // No point goes more than 20 µm in a step.
    for (const Vec3& v : p.held.vertices)
      CHECK(((displaced(from, center, 1.0 / static_cast<double>(steps) * d) * v) - from * v).norm() < 20.001e-6);
    CHECK(judge.ask({from, to}).intersecting == found);
  }
  CHECK(bad > 20);
}
