#include "bench/measure_lp.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/contact_programs.hpp"
#include "bench/glpk_solver.hpp"
#include "bench/timing.hpp"
#include "lp/least_distance.hpp"
#include "lp/simplex.hpp"

namespace tegotae::bench {
namespace {

using namespace tegotae::programs;

constexpr int kInstances = 16;
// Gap (m) that the contacts of the programs keep.
constexpr double kLMin = 1e-5;
// Each figure is measured for about this long, s.
constexpr double kSeconds = 0.3, kQuickSeconds = 0.01;
// GLPK's dense matrix of 10 000 rows would take gigabytes.
constexpr int kMaxGlpkRows = 1000;

std::vector<Program> instances(int rows, bool on_ball) {
  Random random(5);
  std::vector<Program> all;
  while (all.size() < kInstances) {
    const int facets = std::max(rows / 16, 4);
    const Contacts c = on_ball ? ball(random, rows) : peg(random, facets, rows / facets, 1e-4);
    Program p = program(c, Body{}, wanted(random), kLMin);
    if (p.d.maxCoeff() > 0) all.push_back(std::move(p));
  }
  return all;
}

/// Mean time (µs) of solve(k) over all instances, repeated for about `seconds`.
template <class Solve>
double mean_us(double seconds, Solve solve) {
  for (std::size_t k = 0; k < kInstances; ++k) solve(k);
  const std::int64_t start = thread_cpu_ns(), enough = start + static_cast<std::int64_t>(1e9 * seconds);
  std::int64_t now = start, solves = 0;
  while (now < enough) {
    for (std::size_t k = 0; k < kInstances; ++k) solve(k);
    solves += kInstances;
    now = thread_cpu_ns();
  }
  return 1e-3 * static_cast<double>(now - start) / static_cast<double>(solves);
}

LpTimes measure(int rows, bool on_ball, double seconds) {
  const std::vector<Program> all = instances(rows, on_ball);
  std::vector<LowRankMatrix> g;
  for (const Program& p : all) g.push_back(p.matrix());

  LpTimes t;
  LpSolver lp(rows);
  std::vector<double> objective;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const LpResult& r = lp.solve(g[k], all[k].d.data());
    t.failed += r.status != LpStatus::optimal;
    t.gap = std::max(t.gap, std::abs(r.objective - r.dual_objective) / r.objective);
    t.iterations += static_cast<double>(r.iterations) / kInstances;
    objective.push_back(r.objective);
  }
  t.us = mean_us(seconds, [&](std::size_t k) { lp.solve(g[k], all[k].d.data()); });
  LeastDistanceSolver qp(rows);
  t.qp_us = mean_us(seconds, [&](std::size_t k) { qp.solve(g[k], all[k].d.data(), Vec6::Zero()); });
  if (!GlpkSolver::available() || rows > kMaxGlpkRows) return t;

  std::vector<std::unique_ptr<GlpkSolver>> solvers;
  for (const Program& p : all) solvers.push_back(std::make_unique<GlpkSolver>(p));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto value = solvers[k]->solve();
    if (!value) return t;
    t.glpk_differs = std::max(t.glpk_differs, std::abs(*value - objective[k]) / objective[k]);
  }
  t.glpk_us = mean_us(seconds, [&](std::size_t k) { solvers[k]->solve(); });
  return t;
}

}  // namespace

std::vector<LpFigures> measure_lp(bool quick) {
  const double seconds = quick ? kQuickSeconds : kSeconds;
  const struct {
    int rows;
    double target_us;
  } sizes[] = {{8, 1}, {64, 5}, {1000, 60}, {10000, 800}};
  std::vector<LpFigures> all;
  for (const auto& s : sizes) {
    if (quick && s.rows > 100) continue;
    all.push_back({s.rows, s.target_us, measure(s.rows, false, seconds), measure(s.rows, true, seconds)});
  }
  return all;
}

}  // namespace tegotae::bench
