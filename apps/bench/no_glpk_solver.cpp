// Stands in for glpk_solver.cpp in builds without GLPK.
#include "bench/glpk_solver.hpp"

namespace tegotae::bench {

struct GlpkSolver::Problem {};

bool GlpkSolver::available() {
  return false;
}

GlpkSolver::GlpkSolver(const programs::Program&) {}
GlpkSolver::~GlpkSolver() = default;

std::optional<double> GlpkSolver::solve() {
  return {};
}

}  // namespace tegotae::bench
