#pragma once

#include <memory>
#include <optional>

#include "bench/contact_programmes.hpp"

namespace tegotae::bench {

/// GLPK's dual simplex on a contact programme with its dense matrix A = G Gᵀ, loaded when made. Only in builds that
/// have GLPK.
class GlpkSolver {
 public:
  static bool available();

  explicit GlpkSolver(const programmes::Programme& p);
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
