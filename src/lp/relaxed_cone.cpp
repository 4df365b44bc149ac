#include "lp/relaxed_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tegotae {
namespace {

/// Violations below this part of the wanted motion are none. Where rows come ever closer it takes their last digits.
constexpr double kTolerance = 1e-11;
/// What is accepted where rounding keeps a row from being taken.
constexpr double kAccepted = 1e-7;
/// A unit row whose part outside the span of the others is shorter depends on them.
constexpr double kDependent = 1e-9;
/// Far above the 2 to 60 changes that solves take.
constexpr int kMaxChanges = 300;

}  // namespace

bool RelaxedCone::most_violated(double tolerance, Row& out) const noexcept {
  const FrictionProblem& p = *problem_;
  double worst = tolerance;
  int found = -1;
  double d0 = 0, d1 = 0;
  for (int i = 0; i < p.normals.rows(); ++i) {
    const double short_by = p.bounds[i] - p.normals.row(i).dot(z_);
    double slip = 0, s0 = 0, s1 = 0;
    if (p.mu[i] > 0) {
      s0 = p.tangents[i].row[0].dot(z_);
      s1 = p.tangents[i].row[1].dot(z_);
      slip = std::hypot(s0, s1);
    }
    if (!(short_by + p.mu[i] * slip > worst)) continue;
    worst = short_by + p.mu[i] * slip;
    found = i;
    d0 = slip > 0 ? s0 / slip : 0;
    d1 = slip > 0 ? s1 / slip : 0;
  }
  if (found < 0) return false;
  out.contact = found;
  out.direction[0] = d0;
  out.direction[1] = d1;
  out.unit = p.normals.row(found);
  if (p.mu[found] > 0)
    out.unit -= p.mu[found] * (d0 * p.tangents[found].row[0] + d1 * p.tangents[found].row[1]);
  out.length = out.unit.norm();
  if (!(out.length > 0)) return false;
  out.unit /= out.length;
  out.target = p.bounds[found] / out.length - out.unit.dot(p.wanted);
  return true;
}

void RelaxedCone::drop(int position) noexcept {
  span_.remove(position);
  std::copy(rows_ + position + 1, rows_ + size_, rows_ + position);
  std::copy(lambda_ + position + 1, lambda_ + size_, lambda_ + position);
  --size_;
}

void RelaxedCone::solve_active() noexcept {
  for (int i = 0; i < size_; ++i) lambda_[i] = rows_[i].target;
  span_.solve_lower(lambda_);
  z_ = problem_->wanted;
  for (int i = 0; i < size_; ++i) z_ += lambda_[i] * span_.basis(i);
  span_.solve_upper(lambda_);
}

bool RelaxedCone::take(const Row& row) noexcept {
  Vec6 x = z_ - problem_->wanted;
  for (;;) {
    if (++changes_ > kMaxChanges) return false;
    Vec6 outside;
    double along[6];
    span_.split(row.unit, outside, along);
    span_.solve_upper(along);
    const double square = outside.squaredNorm();
    const bool independent = size_ < 6 && square > kDependent * kDependent;
    double step = std::numeric_limits<double>::infinity();
    int blocking = -1;
    for (int i = 0; i < size_; ++i)
      if (along[i] > 0 && lambda_[i] < step * along[i]) {
        step = lambda_[i] / along[i];
        blocking = i;
      }
    const double full = independent ? std::max(row.target - row.unit.dot(x), 0.0) / square : step;
    if (!independent && blocking < 0) return false;
    if (independent && full <= step) {
      span_.append(row.unit, 0);
      rows_[size_++] = row;
      solve_active();
      return true;
    }
    if (independent) x += step * outside;
    for (int i = 0; i < size_; ++i) lambda_[i] = std::max(lambda_[i] - step * along[i], 0.0);
    drop(blocking);
  }
}

bool RelaxedCone::solve(const FrictionProblem& problem) noexcept {
  problem_ = &problem;
  span_.clear();
  size_ = changes_ = 0;
  z_ = problem.wanted;
  const double scale = problem.wanted.norm();
  Row row;
  while (most_violated(kTolerance * scale, row)) {
    if (take(row)) continue;
    return !most_violated(kAccepted * scale, row);
  }
  return true;
}

void RelaxedCone::forces(std::vector<FrictionForce>& out) const noexcept {
  for (int k = 0; k < size_; ++k) {
    const Row& row = rows_[k];
    const double normal = std::max(lambda_[k], 0.0) / row.length;
    if (!(normal > 0)) continue;
    // A contact may have rows of several directions.
    FrictionForce* f = nullptr;
    for (FrictionForce& known : out)
      if (known.row == row.contact) f = &known;
    if (f == nullptr) {
      out.push_back({});
      f = &out.back();
      f->row = row.contact;
    }
    const double mu = problem_->mu[row.contact];
    f->normal += normal;
    for (int i = 0; i < 2; ++i) f->tangential[i] -= mu * normal * row.direction[i];
  }
}

}  // namespace tegotae
