// Time per solve over a set of contact programmes: a peg in its hole, contacts all around, at N rows.
#include <benchmark/benchmark.h>

#include "lp/least_distance.hpp"
#include "lp/programmes.hpp"
#include "lp/simplex.hpp"

#ifdef TEGOTAE_BENCH_GLPK
#include <glpk.h>
#endif

namespace {

using namespace tegotae;
using namespace tegotae::test;

constexpr int kInstances = 16;

/// Random contacts on a ball (`ball`, no two alike) or a peg of rings of facets in its hole.
std::vector<Programme> instances(int rows, bool ball) {
  Random random(5);
  std::vector<Programme> all;
  while (all.size() < kInstances) {
    Contacts c;
    if (ball) {
      for (int i = 0; i < rows; ++i) {
        const Vec3 n = random.direction();
        c.add(n, 0.03 * random.direction(), random.integer(0, 1) ? 0 : random.uniform(0, 1e-3));
      }
    } else {
      c = peg(random, std::max(rows / 16, 4), rows / std::max(rows / 16, 4), 1e-4);
    }
    const Programme p = programme(c, Body{}, wanted(random), 1e-5);
    if (p.d.maxCoeff() > 0) {
      all.push_back(p);
    }
  }
  return all;
}

template <class Solve>
void run(benchmark::State& state, Solve solve) {
  const int rows = static_cast<int>(state.range(0));
  const std::vector<Programme> programmes = instances(rows, state.range(1) != 0);
  std::vector<LowRankMatrix> matrices;
  for (const Programme& p : programmes) {
    matrices.push_back(p.matrix());
  }
  std::size_t k = 0;
  double iterations = 0;
  double gap = 0;
  for (auto _ : state) {
    solve(matrices[k], programmes[k].d, iterations, gap);
    k = (k + 1) % programmes.size();
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["relative_gap"] = gap;
}

void simplex(benchmark::State& state) {
  LpSolver solver(static_cast<int>(state.range(0)));
  run(state, [&](const LowRankMatrix& g, const Eigen::VectorXd& d, double& iterations, double& gap) {
    const LpResult& r = solver.solve(g, d.data());
    if (r.status != LpStatus::optimal) {
      state.SkipWithError("not optimal");
    }
    iterations += r.iterations;
    gap = std::max(gap, std::abs(r.objective - r.dual_objective) / r.objective);
  });
}

void least_distance(benchmark::State& state) {
  LeastDistanceSolver solver(static_cast<int>(state.range(0)));
  run(state, [&](const LowRankMatrix& g, const Eigen::VectorXd& d, double& iterations, double&) {
    const QpResult& r = solver.solve(g, d.data(), Vec6::Zero());
    if (r.status != LpStatus::optimal) {
      state.SkipWithError("not optimal");
    }
    iterations += r.iterations;
  });
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"rows", "ball"})->Unit(benchmark::kMicrosecond);
  for (const int ball : {0, 1}) {
    for (const int rows : {8, 64, 1000, 10000}) {
      b->Args({rows, ball});
    }
  }
}
BENCHMARK(simplex)->Apply(sizes);
BENCHMARK(least_distance)->Apply(sizes);

#ifdef TEGOTAE_BENCH_GLPK
/// GLPK's simplex on the same programme with the dense A = G Gᵀ, loaded beforehand; only the solve is timed, from the
/// slack basis, with its faster defaults (no presolver, no output).
void glpk(benchmark::State& state) {
  const std::vector<Programme> programmes = instances(static_cast<int>(state.range(0)), state.range(1) != 0);
  std::vector<glp_prob*> problems;
  for (const Programme& p : programmes) {
    const int n = static_cast<int>(p.d.size());
    const Eigen::MatrixXd a = p.g * p.g.transpose();
    glp_prob* problem = glp_create_prob();
    glp_add_rows(problem, n);
    glp_add_cols(problem, n);
    std::vector<int> column(n + 1);
    std::vector<double> value(n + 1);
    for (int i = 1; i <= n; ++i) {
      glp_set_row_bnds(problem, i, GLP_LO, p.d[i - 1], 0);
      glp_set_col_bnds(problem, i, GLP_LO, 0, 0);
      glp_set_obj_coef(problem, i, 1);
      for (int j = 1; j <= n; ++j) {
        column[j] = j;
        value[j] = a(i - 1, j - 1);
      }
      glp_set_mat_row(problem, i, n, column.data(), value.data());
    }
    problems.push_back(problem);
  }
  glp_smcp settings;
  glp_init_smcp(&settings);
  settings.msg_lev = GLP_MSG_OFF;
  settings.meth = GLP_DUAL;
  std::size_t k = 0;
  for (auto _ : state) {
    glp_std_basis(problems[k]);
    if (glp_simplex(problems[k], &settings) != 0) {
      state.SkipWithError("GLPK failed");
    }
    k = (k + 1) % problems.size();
  }
  for (glp_prob* problem : problems) {
    glp_delete_prob(problem);
  }
}
BENCHMARK(glpk)->ArgNames({"rows", "ball"})->Unit(benchmark::kMicrosecond)->ArgsProduct({{8, 64, 1000}, {0, 1}});
#endif

}  // namespace
