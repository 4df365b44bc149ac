#pragma once

#include <memory>
#include <optional>

#include "bench/contact_programs.hpp"

namespace tegotae::bench {

/// GLPK's dual simplex on a contact program with its dense matrix A = G Gᵀ, loaded when made. Only in builds that
/// have GLPK.
class GlpkSolver {
 public:
  static bool available();

  explicit GlpkSolver(const programs::Program& p);
  ~GlpkSolver();
  GlpkSolver(const GlpkSolver&) = delete;
  GlpkSolver& operator=(const GlpkSolver&) = delete;

  /// Solves from the slack basis with GLPK's faster defaults (no presolver, no output); the objective, nothing when it
  /// failed.
  std::optional<double> solve();

 private:
  struct Problem;
  std::unique_ptr<Problem> problem_;
};

}  // namespace tegotae::bench
