#include "bench/glpk_solver.hpp"

#include <glpk.h>

#include <vector>

namespace tegotae::bench {

struct GlpkSolver::Problem {
  glp_prob* p = glp_create_prob();
  glp_smcp settings;

  Problem() {
    glp_init_smcp(&settings);
    settings.msg_lev = GLP_MSG_OFF;
    settings.meth = GLP_DUAL;
  }
  ~Problem() { glp_delete_prob(p); }
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;
};

bool GlpkSolver::available() {
  return true;
}

GlpkSolver::GlpkSolver(const programs::Program& program) : problem_(std::make_unique<Problem>()) {
  glp_prob* p = problem_->p;
  const int n = static_cast<int>(program.d.size());
  const Eigen::MatrixXd a = program.g * program.g.transpose();
  glp_add_rows(p, n);
  glp_add_cols(p, n);
  std::vector<int> column(n + 1);
  std::vector<double> value(n + 1);
  for (int i = 1; i <= n; ++i) {
    glp_set_row_bnds(p, i, GLP_LO, program.d[i - 1], 0);
    glp_set_col_bnds(p, i, GLP_LO, 0, 0);
    glp_set_obj_coef(p, i, 1);
    for (int j = 1; j <= n; ++j) {
      column[j] = j;
      value[j] = a(i - 1, j - 1);
    }
    glp_set_mat_row(p, i, n, column.data(), value.data());
  }
}

GlpkSolver::~GlpkSolver() = default;

std::optional<double> GlpkSolver::solve() {
  glp_std_basis(problem_->p);
  if (glp_simplex(problem_->p, &problem_->settings) != 0 || glp_get_status(problem_->p) != GLP_OPT) return {};
  return glp_get_obj_val(problem_->p);
}

}  // namespace tegotae::bench
