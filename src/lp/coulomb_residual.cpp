#include "lp/coulomb_residual.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

/// The nearest (n, t) with |t| <= mu n, in place.
void project_on_cone(double mu, double& n, double& t0, double& t1) noexcept {
  const double t = std::sqrt(t0 * t0 + t1 * t1);
  if (t <= mu * n) return;
  if (mu * t <= -n) {
    n = t0 = t1 = 0;
    return;
  }
  n = (n + mu * t) / (1 + mu * mu);
  const double scale = mu * n / t;
  t0 *= scale;
  t1 *= scale;
}

/// What projecting the contact's force changes it by, as a motion.
double contact_residual(const FrictionProblem& p, const Vec6& z, const FrictionForce& f) noexcept {
  const Vec6 n = p.normals.row(f.row);
  const double mu = p.mu[f.row];
  double s0 = 0, s1 = 0;
  if (mu > 0) {
    s0 = p.tangents[f.row].row[0].dot(z);
    s1 = p.tangents[f.row].row[1].dot(z);
  }
  // De Saxcé's velocity turns the law, which is none of normality, into one of a projection.
  const double open = n.dot(z) - p.bounds[f.row] + mu * std::sqrt(s0 * s0 + s1 * s1);
  const double weight = n.squaredNorm();
  double pn = f.normal - open / weight, p0 = f.tangential[0] - s0 / weight, p1 = f.tangential[1] - s1 / weight;
  project_on_cone(mu, pn, p0, p1);
  return weight * std::hypot(f.normal - pn, std::hypot(f.tangential[0] - p0, f.tangential[1] - p1));
}

}  // namespace

double largest_shortfall(const LowRankMatrix& normals, const double* bounds, const Vec6& z) noexcept {
  double worst = 0;
  const int rows = normals.rows();
  for (int begin = 0; begin < rows; begin += kRowLanes) {
    const RowBlock& block = normals.blocks()[begin / kRowLanes];
    double product[kRowLanes] = {};
    for (int k = 0; k < 6; ++k)
      for (int lane = 0; lane < kRowLanes; ++lane) product[lane] += block.g[k][lane] * z[k];
    const int lanes = std::min(kRowLanes, rows - begin);
    for (int lane = 0; lane < lanes; ++lane) worst = std::max(worst, bounds[begin + lane] - product[lane]);
  }
  return worst;
}

double coulomb_residual(const FrictionProblem& problem, const Vec6& z,
                        const std::vector<FrictionForce>& forces) noexcept {
  double worst = largest_shortfall(problem.normals, problem.bounds, z);
  Vec6 rest = z - problem.wanted;
  for (const FrictionForce& f : forces) {
    rest -= f.normal * problem.normals.row(f.row);
    if (problem.mu[f.row] > 0)
      rest -= f.tangential[0] * problem.tangents[f.row].row[0] + f.tangential[1] * problem.tangents[f.row].row[1];
    worst = std::max(worst, contact_residual(problem, z, f));
  }
  return std::max(worst, rest.norm());
}

}  // namespace tegotae
