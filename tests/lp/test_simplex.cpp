#include "lp/simplex.hpp"

#include <Eigen/LU>
#include <cstring>
#include <limits>

#include "catch.hpp"
#include "lp/programs.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Optimality of f and y for min Σf, A f >= d, f >= 0 from the raw data with the dense A = G Gᵀ: feasibility of both
/// and equal objectives prove it (weak duality). Tolerances are relative to the terms of each sum.
void require_optimal(const Program& p, const LpResult& r, double tolerance) {
  REQUIRE(r.status == LpStatus::optimal);
  REQUIRE(r.force.count <= 6);
  REQUIRE(r.dual.count <= 6);
  const Eigen::VectorXd f = dense(r.force, p.d.size());
  const Eigen::VectorXd y = dense(r.dual, p.d.size());
  const Eigen::MatrixXd a = p.g * p.g.transpose();
  const double largest = std::max(0.0, p.d.maxCoeff());
  REQUIRE((f.array() >= 0).all());
  REQUIRE((y.array() >= 0).all());
  const Eigen::VectorXd f_terms = a.cwiseAbs() * f;
  const Eigen::VectorXd y_terms = a.cwiseAbs() * y;
  REQUIRE((p.d - a * f - tolerance * (f_terms.array() + largest).matrix()).maxCoeff() <= 0);
  REQUIRE(((a * y).array() - 1 - tolerance * (1 + y_terms.array())).maxCoeff() <= 0);
  REQUIRE(std::abs(f.sum() - p.d.dot(y)) <= tolerance * (f.sum() + p.d.cwiseAbs().dot(y)));
  REQUIRE(r.objective == Approx(f.sum()).epsilon(1e-12).margin(1e-300));
  REQUIRE((r.w - p.g.transpose() * f).norm() <= tolerance * (r.w.norm() + (p.g.cwiseAbs().transpose() * f).norm()));
  REQUIRE(r.primal_residual <= 1e-5 * (largest + r.w.norm() * p.g.rowwise().norm().maxCoeff()));
}

/// The least objective over all basic solutions with up to six basic forces, or infinity: a feasible program has an
/// optimal one.
double enumerate(const Program& p) {
  const int n = static_cast<int>(p.d.size());
  const Eigen::MatrixXd a = p.g * p.g.transpose();
  double best = std::numeric_limits<double>::infinity();
  for (int forces = 0; forces < 1 << n; ++forces) {
    for (int tight = 0; tight < 1 << n; ++tight) {
      if (__builtin_popcount(forces) != __builtin_popcount(tight)) {
        continue;
      }
      std::vector<int> ps, qs;
      for (int i = 0; i < n; ++i) {
        if (forces >> i & 1) ps.push_back(i);
        if (tight >> i & 1) qs.push_back(i);
      }
      Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
      if (!ps.empty()) {
        const Eigen::FullPivLU<Eigen::MatrixXd> lu(a(qs, ps).eval());
        if (!lu.isInvertible()) {
          continue;
        }
        f(ps) = lu.solve(p.d(qs).eval());
      }
      if (f.minCoeff() >= -1e-9 && (a * f - p.d).minCoeff() >= -1e-9) {
        best = std::min(best, f.sum());
      }
    }
  }
  return best;
}

}  // namespace

TEST_CASE("Held bodies: always an answer, proved optimal", "[lp]") {
  Random random(11);
  LpSolver solver(2000);
  for (int i = 0; i < 4000; ++i) {
    const Program p = held_body(random, i);
    CAPTURE(i);
    require_optimal(p, solver.solve(p.matrix(), p.d.data()), 1e-6);
  }
}

TEST_CASE("Well-separated normals: optimal to rounding", "[lp]") {
  Random random(12);
  LpSolver solver(2000);
  for (int i = 0; i < 1000; ++i) {
    for (const int kind : {0, 1, 5, 6, 7}) {
      const Program p = held_body(random, kind);
      require_optimal(p, solver.solve(p.matrix(), p.d.data()), 1e-9);
    }
  }
}

TEST_CASE("Round pegs that lean in their holes: an answer with however many facets", "[lp]") {
  Random random(18);
  LpSolver solver(1024);
  int pivots = 0;
  for (const int facets : {16, 64, 176, 256, 512})
    for (const double tilt : {1e-3, 1.2e-2, 5e-2})
      for (int i = 0; i < 5; ++i) {
        const Program p = program(leaning_peg(random, facets, tilt, 2e-6), Body{}, wanted(random), 2e-6);
        const LpResult& r = solver.solve(p.matrix(), p.d.data());
        CAPTURE(facets, tilt, i, r.iterations);
        require_optimal(p, r, 1e-6);
        pivots = std::max(pivots, r.iterations);
      }
  CHECK(pivots > 512);  // these do take long
}

TEST_CASE("Slots whose walls agree to 1e-8 to 1e-16 rad: never a wrong verdict", "[lp]") {
  Random random(13);
  LpSolver solver(64);
  int stalled = 0;
  for (int i = 0; i < 2000; ++i) {
    const double spread = std::pow(10.0, random.uniform(-16, -8));
    const Program p = program(near_parallel(random, random.integer(2, 40), spread, true), Body{}, wanted(random), 1e-5);
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    REQUIRE(r.status != LpStatus::infeasible);
    if (r.status == LpStatus::optimal) {
      require_optimal(p, r, 2e-6);
    } else {
      ++stalled;
    }
  }
  CHECK(stalled <= 20);
}

TEST_CASE("Small programs against all bases", "[lp]") {
  Random random(14);
  LpSolver solver(8);
  int infeasible = 0;
  for (int i = 0; i < 3000; ++i) {
    const Program p = small(random, random.integer(1, 5));
    const double best = enumerate(p);
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    CAPTURE(i, p.g, p.d);
    if (std::isfinite(best)) {
      require_optimal(p, r, 1e-9);
      REQUIRE(r.objective == Approx(best).epsilon(1e-7).margin(1e-9));
    } else {
      ++infeasible;
      REQUIRE(r.status == LpStatus::infeasible);
      REQUIRE(proves_infeasible(p, dense(r.dual, p.d.size()), 1e7));
    }
  }
  CHECK(infeasible > 300);
}

TEST_CASE("Larger programs without structure: proved optimal or proved infeasible", "[lp]") {
  Random random(15);
  LpSolver solver(200);
  int infeasible = 0;
  for (int i = 0; i < 3000; ++i) {
    Program p = small(random, random.integer(6, 200));
    if (i % 2) {  // some motion satisfies every row
      p.d = p.g * random.vec6() - p.d.cwiseAbs();
    }
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    if (r.status == LpStatus::optimal) {
      require_optimal(p, r, 1e-9);
    } else {
      ++infeasible;
      REQUIRE(r.status == LpStatus::infeasible);
      REQUIRE(proves_infeasible(p, dense(r.dual, p.d.size()), 1e7));
      REQUIRE(r.reach > 0);
    }
  }
  CHECK(infeasible > 300);
  CHECK(infeasible <= 1500);
}

TEST_CASE("The lemma of section 3: gaps at a free pose always give a feasible program", "[lp]") {
  Random random(16);
  LpSolver solver(128);
  for (int i = 0; i < 3000; ++i) {
    const int n = random.integer(1, 64);
    Program p;
    p.g.resize(n, 6);
    p.d.resize(n);
    const Vec6 delta = std::pow(10.0, random.uniform(-6, 0)) * random.vec6();
    const double l_min = random.uniform(0, 1e-3);
    for (int k = 0; k < n; ++k) {
      // Every second row is the opposite of the one before: null combinations y >= 0, Gᵀ y = 0 exist by construction.
      p.g.row(k) = k % 2 ? Eigen::Matrix<double, 1, 6>(-p.g.row(k - 1)) : random.vec6().transpose().eval();
      const double gap = random.integer(0, 1) ? 0 : random.uniform(0, 2e-3);
      p.d[k] = std::min(l_min, gap) - gap - p.g.row(k).dot(delta);
    }
    // Two witnesses of feasibility: no Farkas combination gains, and the motion -Δ satisfies every row.
    for (int k = 1; k < n; k += 2) {
      REQUIRE(p.d[k] + p.d[k - 1] <= 1e-12 * (1 + delta.norm()));
    }
    REQUIRE((p.d + p.g * delta).maxCoeff() <= 1e-12 * (1 + delta.norm()));
    require_optimal(p, solver.solve(p.matrix(), p.d.data()), 1e-8);
  }
}

TEST_CASE("Rows in different units are solved alike", "[lp]") {
  Random random(17);
  LpSolver solver(64);
  for (int i = 0; i < 500; ++i) {
    Program p = program(wedged_box(random, 4, Vec3(0.01, 0.02, 0.03)), Body{}, wanted(random), 1e-5);
    for (int k = 0; k < p.d.size(); ++k) {
      const double s = std::pow(10.0, random.uniform(-6, 6));
      p.g.row(k) *= s;
      p.d[k] *= s;
    }
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    REQUIRE(r.status == LpStatus::optimal);
    const Eigen::VectorXd lengths = p.g.rowwise().norm();
    REQUIRE(((p.d - p.g * r.w).array() / lengths.array()).maxCoeff() <=
            1e-8 * (r.w.norm() + (p.d.array() / lengths.array()).maxCoeff()));
    const Eigen::VectorXd f = dense(r.force, p.d.size()), y = dense(r.dual, p.d.size());
    REQUIRE(f.sum() == Approx(p.d.dot(y)).epsilon(1e-6));
    REQUIRE((p.g * (p.g.transpose() * y)).maxCoeff() <= 1 + 1e-6);
  }
}

TEST_CASE("Simple and bad programs", "[lp]") {
  LpSolver solver(16);
  Program p;
  SECTION("no rows") {
    p.g.resize(0, 6);
    const LpResult& r = solver.solve(p.matrix(), nullptr);
    CHECK(r.status == LpStatus::optimal);
    CHECK(r.objective == 0);
  }
  SECTION("one row: f = d / |g|²") {
    p.g = Eigen::Matrix<double, 1, 6>(3, 0, 4, 0, 0, 0);
    p.d = Eigen::VectorXd::Constant(1, 5);
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    REQUIRE(r.force.count == 1);
    CHECK(r.force.value[0] == Approx(0.2));
    CHECK(r.w[2] == Approx(0.8));
  }
  SECTION("a slot with room, and one without") {
    p.g = Eigen::Matrix<double, 2, 6>::Zero();
    p.g(0, 0) = 1;
    p.g(1, 0) = -2;
    p.d = Eigen::Vector2d(0.5, -1.5);
    CHECK(solver.solve(p.matrix(), p.d.data()).w[0] == Approx(0.5));
    p.d = Eigen::Vector2d(0.5, -0.9);
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    REQUIRE(r.status == LpStatus::infeasible);
    CHECK(proves_infeasible(p, dense(r.dual, 2), 1e12));
    CHECK(r.force.count == 0);
  }
  SECTION("zero rows") {
    p.g = Eigen::Matrix<double, 2, 6>::Zero();
    p.g(0, 1) = 1;
    p.d = Eigen::Vector2d(1, -1);
    CHECK(solver.solve(p.matrix(), p.d.data()).status == LpStatus::optimal);
    p.d = Eigen::Vector2d(1, 1e-9);
    const LpResult& r = solver.solve(p.matrix(), p.d.data());
    REQUIRE(r.status == LpStatus::infeasible);
    CHECK(proves_infeasible(p, dense(r.dual, 2), 1e12));
  }
  SECTION("not finite, too many rows") {
    p.g = Eigen::Matrix<double, 2, 6>::Ones();
    p.d = Eigen::Vector2d(1, std::nan(""));
    CHECK(solver.solve(p.matrix(), p.d.data()).status == LpStatus::stalled);
    p.d = Eigen::Vector2d(1, 1);
    p.g(1, 3) = std::numeric_limits<double>::infinity();
    CHECK(solver.solve(p.matrix(), p.d.data()).status == LpStatus::stalled);
    p.g = Eigen::Matrix<double, 17, 6>::Ones();
    p.d = Eigen::VectorXd::Ones(17);
    CHECK(solver.solve(p.matrix(), p.d.data()).status == LpStatus::stalled);
  }
}

TEST_CASE("Every instruction set gives the bits of a plain loop", "[lp]") {
  Random random(18);
  const int n = 203;
  LowRankMatrix g(n);
  std::vector<LaneBlock> d((n + kRowLanes - 1) / kRowLanes), scale(d), step(d), pivot(d), norms(d);
  for (int repeat = 0; repeat < 50; ++repeat) {
    g.clear();
    for (int i = 0; i < n; ++i) {
      g.push_row(i % 5 ? random.vec6() : Vec6::Ones().eval());  // equal rows: ties
      d[i / kRowLanes].v[i % kRowLanes] = i % 5 ? random.normal() : 3;
      scale[i / kRowLanes].v[i % kRowLanes] = i % 7 ? 1 : 0;
    }
    const Vec6 u = random.vec6(), v = random.vec6();
    RowChoice most, largest;
    double bound = std::numeric_limits<double>::infinity();
    const auto dot = [](const Vec6& a, const Vec6& b) {
      double sum = a[0] * b[0];
      for (int k = 1; k < 6; ++k) {
        sum += a[k] * b[k];
      }
      return sum;
    };
    const auto at = [](const std::vector<LaneBlock>& a, int i) { return a[i / kRowLanes].v[i % kRowLanes]; };
    for (int i = 0; i < n; ++i) {
      const double violation = (at(d, i) - dot(g.row(i), u)) * at(scale, i);
      if (violation > most.value) {
        most = {i, violation};
      }
      if (dot(g.row(i), v) * at(scale, i) > 0.1) {
        bound = std::min(bound, (std::max(1 - dot(g.row(i), u), 0.0) + 0.01) / dot(g.row(i), v));
      }
    }
    for (int i = 0; i < n; ++i) {
      const double p = dot(g.row(i), v) * at(scale, i);
      if (p > 0.1 && std::max(1 - dot(g.row(i), u), 0.0) / dot(g.row(i), v) <= bound && p > largest.value) {
        largest = {i, p};
      }
    }
    for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      const Pricing* passes = pricing(set);
      if (!passes) {
        continue;
      }
      const int blocks = static_cast<int>(d.size());
      const RowChoice a = passes->most_violated(g.blocks(), d.data(), scale.data(), blocks, u.data());
      CHECK(a.row == most.row);
      CHECK(std::memcmp(&a.value, &most.value, sizeof a.value) == 0);
      const double b =
          passes->steps(g.blocks(), scale.data(), blocks, u.data(), v.data(), 0.1, 0.01, step.data(), pivot.data());
      CHECK(std::memcmp(&b, &bound, sizeof b) == 0);
      const RowChoice c = passes->largest_pivot(step.data(), pivot.data(), blocks, bound);
      CHECK(c.row == largest.row);
      CHECK(std::memcmp(&c.value, &largest.value, sizeof c.value) == 0);
      passes->inverse_norms(g.blocks(), blocks, norms.data());
      CHECK(at(norms, n - 1) == 1 / std::sqrt(dot(g.row(n - 1), g.row(n - 1))));
    }
  }
}

TEST_CASE("passes for friction give the same bits at every width", "[simplex]") {
  Random random(12);
  for (int n : {1, 7, 8, 9, 64, 203}) {
    LowRankMatrix g(n), t0(n), t1(n);
    std::vector<LaneBlock> d((static_cast<std::size_t>(n) + kRowLanes - 1) / kRowLanes);
    for (LaneBlock& block : d) std::fill_n(block.v, kRowLanes, -std::numeric_limits<double>::infinity());
    std::vector<PaddedVec6> a(static_cast<std::size_t>(n)), b(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      g.push_row(random.vec6());
      t0.push_row(random.vec6());
      t1.push_row(random.vec6());
      d[k / kRowLanes].v[k % kRowLanes] = random.uniform(-5, 1);
      for (int c = 0; c < kRowLanes; ++c) {
        a[k].v[c] = c < 6 ? random.uniform(-1, 1) : 0;
        b[k].v[c] = c < 6 ? random.uniform(-1, 1) : 0;
      }
    }
    const Vec6 w = random.vec6();
    RowChoice worst{-1, 0.5};
    for (int i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double by =
          d[k / kRowLanes].v[k % kRowLanes] - g.row(i).dot(w) + std::hypot(t0.row(i).dot(w), t1.row(i).dot(w));
      if (by > worst.value) worst = {i, by};
    }
    Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
    for (std::size_t k = 0; k < a.size(); ++k)
      sum += Eigen::Map<const Vec6>(a[k].v) * Eigen::Map<const Vec6>(b[k].v).transpose();
    RowChoice first;
    PaddedVec6 products[6], first_products[6];
    for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      const Pricing* passes = pricing(set);
      if (!passes) continue;
      const RowChoice c = passes->most_violated_cone(g.blocks(), t0.blocks(), t1.blocks(), d.data(),
                                                     static_cast<int>(d.size()), w.data(), 0.5);
      CHECK(c.row == worst.row);
      CHECK(c.value == Approx(worst.value));
      passes->sum_products(a.data(), b.data(), n, products);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) CHECK(products[i].v[j] == Approx(sum(i, j)).margin(1e-12));
      if (set == InstructionSet::baseline) {
        first = c;
        std::copy_n(products, 6, first_products);
      }
      CHECK(std::memcmp(&c.value, &first.value, sizeof c.value) == 0);
      for (int i = 0; i < 6; ++i) CHECK(std::memcmp(products[i].v, first_products[i].v, 6 * sizeof(double)) == 0);
      // None is beyond the worst.
      CHECK(passes
                ->most_violated_cone(g.blocks(), t0.blocks(), t1.blocks(), d.data(), static_cast<int>(d.size()),
                                     w.data(), c.value)
                .row == -1);
    }
  }
}
