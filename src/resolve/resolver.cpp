#include "tegotae/resolve/resolver.hpp"

#include <algorithm>

#include "lp/friction_solver.hpp"
#include "lp/least_distance.hpp"
#include "lp/simplex.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

ResolveStatus status_of(LpStatus s) {
  switch (s) {
    case LpStatus::optimal:
      return ResolveStatus::solved;
    case LpStatus::infeasible:
      return ResolveStatus::infeasible;
    default:
      return ResolveStatus::stalled;
  }
}

/// The paper's program (equations 5 to 7): contact forces of least sum that push the wanted motion out of every
/// limit. Taken as it is, it follows a target in a limit cycle: the push may overshoot what the error asks for. So the
/// motion is scaled to the point on its line that is nearest to the target; the limits hold there too, because they
/// hold at both ends of the line.
class LpResolver final : public Resolver {
 public:
  explicit LpResolver(int capacity) : solver_(capacity), d_(static_cast<std::size_t>(capacity)) {}

  Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept override {
    for (int i = 0; i < rows.rows(); ++i) d_[static_cast<std::size_t>(i)] = bounds[i] - rows.row(i).dot(wanted);
    const LpResult& r = solver_.solve(rows, d_.data());
    Resolution out;
    out.status = status_of(r.status);
    out.iterations = r.iterations;
    if (r.status != LpStatus::optimal) return out;
    const Vec6 motion = wanted + r.w;
    const double length2 = motion.squaredNorm();
    out.motion = length2 > 0 ? Vec6(std::clamp(wanted.dot(motion) / length2, 0.0, 1.0) * motion) : motion;
    return out;
  }

  bool projects() const override { return false; }

 private:
  LpSolver solver_;
  std::vector<double> d_;
};

/// The allowed motion nearest to the wanted one: in the coupling's metric the one of least energy. With friction the
/// one that Coulomb's law gives.
class QpResolver final : public Resolver {
 public:
  explicit QpResolver(int capacity) : solver_(capacity), friction_(capacity) {}

  Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept override {
    const QpResult& r = solver_.solve(rows, bounds, wanted);
    Resolution out;
    out.status = status_of(r.status);
    out.iterations = r.iterations;
    if (r.status == LpStatus::optimal) out.motion = r.z;
    return out;
  }

  bool projects() const override { return true; }

  bool knows_friction() const override { return true; }

  Resolution resolve_with_friction(const FrictionProblem& problem) noexcept override {
    const FrictionResult& r = friction_.solve(problem);
    return {r.z, status_of(r.status), r.iterations, &r.forces};
  }

 private:
  LeastDistanceSolver solver_;
  FrictionSolver friction_;
};

}  // namespace

std::unique_ptr<Resolver> make_resolver(ResolverKind kind, int capacity) {
  if (kind == ResolverKind::lp) return std::make_unique<LpResolver>(capacity);
  if (kind == ResolverKind::qp) return std::make_unique<QpResolver>(capacity);
  throw Error(ErrorKind::setting,
              "the resolver " + to_string(kind) + " is a loop of its own; set ContactSettings::resolver");
}

}  // namespace tegotae
