#include "lp/least_distance.hpp"

#include <Eigen/LU>
#include <limits>

#include "catch.hpp"
#include "lp/programs.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// The KKT conditions of min ½|z - z0|², G z >= b from the raw data; with them z is the minimizer (convex).
void require_optimal(const Program& p, const Vec6& z0, const QpResult& r, double tolerance) {
  REQUIRE(r.status == LpStatus::optimal);
  REQUIRE(r.multipliers.count <= 6);
  const Eigen::VectorXd lambda = dense(r.multipliers, p.d.size());
  const Vec6 x = r.z - z0;
  const Eigen::VectorXd lengths = p.g.rowwise().norm();
  const Eigen::VectorXd slack = p.g * r.z - p.d;
  double size = x.norm() + 1e-6 * z0.norm();
  for (int i = 0; i < p.d.size(); ++i) {
    size = std::max(size, lengths[i] > 0 ? (p.d[i] - p.g.row(i).dot(z0)) / lengths[i] : 0);
  }
  const double terms = lambda.dot(lengths);
  REQUIRE((lambda.array() >= 0).all());
  REQUIRE((slack + tolerance * size * lengths).minCoeff() >= 0);
  REQUIRE((x - p.g.transpose() * lambda).norm() <= tolerance * x.norm() + 1e-13 * terms);
  for (int i = 0; i < p.d.size(); ++i) {
    REQUIRE((lambda[i] == 0 || std::abs(slack[i]) <= tolerance * size * lengths[i]));
  }
  REQUIRE(r.objective == Approx(0.5 * x.squaredNorm()).epsilon(1e-12).margin(1e-300));
}

/// The least objective over all active sets whose equality solution is feasible, or infinity.
double enumerate(const Program& p, const Vec6& z0) {
  const int n = static_cast<int>(p.d.size());
  double best = std::numeric_limits<double>::infinity();
  for (int set = 0; set < 1 << n; ++set) {
    std::vector<int> rows;
    for (int i = 0; i < n; ++i) {
      if (set >> i & 1) rows.push_back(i);
    }
    Vec6 z = z0;
    if (!rows.empty()) {
      const Eigen::MatrixXd g = p.g(rows, Eigen::all);
      const Eigen::FullPivLU<Eigen::MatrixXd> lu((g * g.transpose()).eval());
      if (!lu.isInvertible()) {
        continue;
      }
      z += g.transpose() * lu.solve((p.d(rows) - g * z0).eval());
    }
    if ((p.g * z - p.d).minCoeff() >= -1e-9) {
      best = std::min(best, 0.5 * (z - z0).squaredNorm());
    }
  }
  return best;
}

}  // namespace

TEST_CASE("Least distance: held bodies: the least-constraint motion, proved optimal", "[qp]") {
  Random random(21);
  LeastDistanceSolver solver(2000);
  for (int i = 0; i < 4000; ++i) {
    const Program p = held_body(random, i);
    CAPTURE(i);
    require_optimal(p, Vec6::Zero(), solver.solve(p.matrix(), p.d.data(), Vec6::Zero()), 1e-5);
    const Vec6 z0 = 1e-3 * random.vec6();
    const Eigen::VectorXd b = p.d + p.g * z0;
    require_optimal({p.g, b}, z0, solver.solve(p.matrix(), b.data(), z0), 1e-5);
  }
}

TEST_CASE("Least distance: well-separated normals: optimal to rounding", "[qp]") {
  Random random(22);
  LeastDistanceSolver solver(2000);
  for (int i = 0; i < 1000; ++i) {
    for (const int kind : {0, 1, 4, 5, 6, 7}) {
      const Program p = held_body(random, kind);
      require_optimal(p, Vec6::Zero(), solver.solve(p.matrix(), p.d.data(), Vec6::Zero()), 1e-8);
    }
  }
}

TEST_CASE("Least distance: slots whose walls agree to 1e-8 to 1e-16 rad: never a wrong verdict", "[qp]") {
  Random random(23);
  LeastDistanceSolver solver(64);
  int stalled = 0;
  for (int i = 0; i < 2000; ++i) {
    const double spread = std::pow(10.0, random.uniform(-16, -8));
    const Program p = program(near_parallel(random, random.integer(2, 40), spread, true), Body{}, wanted(random), 1e-5);
    const QpResult& r = solver.solve(p.matrix(), p.d.data(), Vec6::Zero());
    REQUIRE(r.status != LpStatus::infeasible);
    if (r.status == LpStatus::optimal) {
      require_optimal(p, Vec6::Zero(), r, 1e-5);
    } else {
      ++stalled;
    }
  }
  CHECK(stalled <= 40);
}

TEST_CASE("Least distance: small programs against all active sets", "[qp]") {
  Random random(24);
  LeastDistanceSolver solver(16);
  int infeasible = 0;
  for (int i = 0; i < 4000; ++i) {
    const Program p = small(random, random.integer(1, 9));
    const Vec6 z0 = random.vec6();
    const double best = enumerate(p, z0);
    const QpResult& r = solver.solve(p.matrix(), p.d.data(), z0);
    CAPTURE(i, p.g, p.d);
    if (std::isfinite(best)) {
      require_optimal(p, z0, r, 1e-8);
      REQUIRE(r.objective == Approx(best).epsilon(1e-6).margin(1e-9));
    } else {
      ++infeasible;
      REQUIRE(r.status == LpStatus::infeasible);
      REQUIRE(proves_infeasible({p.g, p.d - p.g * z0}, dense(r.multipliers, p.d.size()), 1e7));
    }
  }
  CHECK(infeasible > 300);
}

TEST_CASE("Least distance: warm starts: the same motion, no iterations for an unchanged problem", "[qp]") {
  Random random(25);
  LeastDistanceSolver solver(2000);
  for (int i = 0; i < 2000; ++i) {
    const int kinds[] = {0, 1, 4, 5, 6, 7};
    const Program p = held_body(random, kinds[i % 6]);
    const LowRankMatrix g = p.matrix();
    const QpResult cold = solver.solve(g, p.d.data(), Vec6::Zero());
    const QpResult again =
        solver.solve(g, p.d.data(), Vec6::Zero(), cold.multipliers.index.data(), cold.multipliers.count);
    CHECK(again.iterations == 0);
    CHECK((again.z - cold.z).norm() <= 1e-9 * cold.z.norm());
    // Any rows at all, repeated and out of range ones too.
    int warm[12];
    for (int& row : warm) {
      row = random.integer(-1, g.rows());
    }
    const QpResult any = solver.solve(g, p.d.data(), Vec6::Zero(), warm, 12);
    require_optimal(p, Vec6::Zero(), any, 1e-8);
    CHECK((any.z - cold.z).norm() <= 1e-7 * cold.z.norm());
  }
}

TEST_CASE("Least distance: simple and bad problems", "[qp]") {
  LeastDistanceSolver solver(4);
  Program p;
  const Vec6 z0 = Vec6::Constant(2);
  SECTION("no rows, satisfied rows") {
    p.g.resize(0, 6);
    CHECK(solver.solve(p.matrix(), nullptr, z0).z == z0);
    p.g = Eigen::Matrix<double, 1, 6>::Ones();
    p.d = Eigen::VectorXd::Constant(1, 11);
    const QpResult& r = solver.solve(p.matrix(), p.d.data(), z0);
    CHECK(r.status == LpStatus::optimal);
    CHECK(r.z == z0);
    CHECK(r.iterations == 0);
  }
  SECTION("one row: the foot of the perpendicular") {
    p.g = Eigen::Matrix<double, 1, 6>(0, 2, 0, 0, 0, 0);
    p.d = Eigen::VectorXd::Constant(1, 10);
    const QpResult& r = solver.solve(p.matrix(), p.d.data(), z0);
    CHECK((r.z - (Vec6() << 2, 5, 2, 2, 2, 2).finished()).norm() < 1e-14);
    CHECK(r.multipliers.value[0] == Approx(1.5));
  }
  SECTION("a slot without room, a zero row") {
    p.g = Eigen::Matrix<double, 2, 6>::Zero();
    p.g(0, 0) = 1;
    p.g(1, 0) = -1;
    p.d = Eigen::Vector2d(1, -0.5);
    const QpResult slot = solver.solve(p.matrix(), p.d.data(), z0);
    REQUIRE(slot.status == LpStatus::infeasible);
    CHECK(proves_infeasible({p.g, p.d - p.g * z0}, dense(slot.multipliers, 2), 1e12));
    CHECK(slot.z == z0);
    p.g(1, 0) = 0;
    p.d[1] = 1e-9;
    CHECK(solver.solve(p.matrix(), p.d.data(), z0).status == LpStatus::infeasible);
    p.d[1] = 0;
    CHECK(solver.solve(p.matrix(), p.d.data(), z0).status == LpStatus::optimal);
  }
  SECTION("not finite, too many rows") {
    p.g = Eigen::Matrix<double, 1, 6>::Ones();
    p.d = Eigen::VectorXd::Constant(1, std::numeric_limits<double>::infinity());
    CHECK(solver.solve(p.matrix(), p.d.data(), z0).status == LpStatus::stalled);
    p.g = Eigen::Matrix<double, 5, 6>::Ones();
    p.d = Eigen::VectorXd::Zero(5);
    CHECK(solver.solve(p.matrix(), p.d.data(), z0).status == LpStatus::stalled);
  }
}

TEST_CASE("Least distance: a target on the limits up to rounding is kept, not stalled on", "[qp]") {
  // From a body spinning between two pins: all four limits pass through the target but for the last bits.
  LowRankMatrix g(4);
  double b[4];
  int n = 0;
  for (const double s : {-0.374, 0.374}) {
    for (const double t : {-1.2236, 1.2236}) {
      Vec6 row;
      row << 0, 0, 1, s, t, t;
      g.push_row(row);
      b[n++] = -1e-17;
    }
  }
  Vec6 z0;
  z0 << 0, 0, -1.9e-17, 2.2e-17, -4.0861376748654e-4, 4.0861376748656e-4;
  LeastDistanceSolver solver(8);
  const QpResult& r = solver.solve(g, b, z0);
  REQUIRE(r.status == LpStatus::optimal);
  REQUIRE((r.z - z0).norm() < 1e-15);
  for (int i = 0; i < 4; ++i) REQUIRE(g.row(i).dot(r.z) >= b[i] - 1e-15);
}
