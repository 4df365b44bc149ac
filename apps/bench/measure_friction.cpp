#include "bench/measure_friction.hpp"

#include <cmath>

#include "bench/contact_programs.hpp"
#include "bench/timing.hpp"
#include "lp/friction_solver.hpp"
#include "lp/tangents.hpp"

namespace tegotae::bench {
namespace {

using namespace tegotae::programs;

// sqrt(k_t / k) of the coupling's defaults, m.
constexpr double kRadius = 0.0194;
// How far the part is pulled into its contacts: m, rad.
constexpr double kPull = 2e-3, kPullTurn = 0.1;
constexpr int kCases = 10000, kQuickCases = 200;

struct Case {
  explicit Case(int contacts) : normals(contacts) {}
  LowRankMatrix normals;
  std::vector<TangentRows> tangents;
  std::vector<double> bounds, mu;
  Vec6 wanted;
};

Vec6 row(const Vec3& arm, const Vec3& e) {
  return (Vec6() << e, arm.cross(e) / kRadius).finished();
}

/// A part of 5 mm to 0.1 m between contacts that leave it one way out; most touch, the others are some 20 µm away.
Case wedged(Random& random, int contacts) {
  Case c(contacts);
  const double size = std::exp(random.uniform(std::log(0.005), std::log(0.1))), mu = random.uniform(0.15, 0.8);
  const Vec6 out = random.vec6();
  for (int i = 0; i < contacts; ++i) {
    const Vec3 arm = size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    Vec3 n = random.direction();
    if (row(arm, n).dot(out) < 0) n = -n;
    c.normals.push_row(row(arm, n));
    const Tangents tangents(n);
    c.tangents.push_back({{row(arm, tangents.direction[0]), row(arm, tangents.direction[1])}});
    const bool touches = random.uniform(0, 1) < 0.6;
    const double gap = -20e-6 * std::log(random.uniform(1e-9, 1));
    c.bounds.push_back(touches ? 0 : -gap);
    c.mu.push_back(mu);
  }
  const Vec6 pull = random.vec6();
  c.wanted << kPull * pull.head<3>(), kRadius * kPullTurn * pull.tail<3>();
  return c;
}

FrictionSolveFigures measure(int contacts, double target_us, int cases) {
  Random random(9);
  FrictionSolver solver(contacts);
  std::vector<std::int64_t> cpu;
  int exact = 0;
  for (int i = 0; i < cases; ++i) {
    const Case c = wedged(random, contacts);
    const FrictionProblem problem{c.normals, c.bounds.data(), c.tangents.data(), c.mu.data(), c.wanted};
    const std::int64_t start = thread_cpu_ns();
    const FrictionResult& r = solver.solve(problem);
    cpu.push_back(thread_cpu_ns() - start);
    exact += r.exact;
  }
  return {contacts, target_us, percentiles(cpu), static_cast<double>(exact) / cases};
}

}  // namespace

std::vector<FrictionSolveFigures> measure_friction_solves(bool quick) {
  constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();
  const int cases = quick ? kQuickCases : kCases;
  return {measure(2, kNoTarget, cases), measure(8, kNoTarget, cases), measure(20, 15, cases), measure(64, 30, cases)};
}

}  // namespace tegotae::bench
