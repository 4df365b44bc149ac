#include "lp/relaxed_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// What is accepted where rounding keeps a row from being taken.
constexpr double kAccepted = 1e-7;
/// A unit row whose part outside the span of the others is shorter depends on them.
constexpr double kDependent = 1e-9;
/// Far above the 2 to 60 changes that solves take.
constexpr int kMaxChanges = 300;

}  // namespace

RelaxedCone::RelaxedCone(int capacity)
    : pricing_(pricing()),
      friction_{LowRankMatrix(capacity), LowRankMatrix(capacity)},
      lanes_(static_cast<std::size_t>((capacity + kRowLanes - 1) / kRowLanes)) {}

void RelaxedCone::set_problem(const FrictionProblem& problem) noexcept {
  problem_ = &problem;
  for (LowRankMatrix& rows : friction_) rows.clear();
  for (int i = 0; i < problem.normals.rows(); ++i)
    for (int k = 0; k < 2; ++k)
      friction_[k].push_row(problem.mu[i] > 0 ? Vec6(problem.mu[i] * problem.tangents[i].row[k]) : Vec6::Zero());
}

void RelaxedCone::set_bounds(const double* bounds) noexcept {
  bounds_ = bounds;
  const int rows = problem_->normals.rows(), blocks = (rows + kRowLanes - 1) / kRowLanes;
  for (int i = 0; i < blocks * kRowLanes; ++i)
    lanes_[static_cast<std::size_t>(i / kRowLanes)].v[i % kRowLanes] =
        i < rows ? bounds[i] : -std::numeric_limits<double>::infinity();
}

bool RelaxedCone::most_violated(double tolerance, Row& out) noexcept {
  const int blocks = (problem_->normals.rows() + kRowLanes - 1) / kRowLanes;
  const RowChoice worst =
      pricing_.most_violated_cone(problem_->normals.blocks(), friction_[0].blocks(), friction_[1].blocks(),
                                  lanes_.data(), blocks, z_.data(), tolerance);
  if (worst.row < 0) return false;
  make_row(worst.row, out);
  return out.length > 0;
}

void RelaxedCone::make_row(int contact, Row& out) const noexcept {
  const FrictionProblem& p = *problem_;
  out.contact = contact;
  out.direction[0] = out.direction[1] = 0;
  if (p.mu[contact] > 0) {
    const TangentRows& t = p.tangents[contact];
    const double s0 = t.row[0].dot(z_), s1 = t.row[1].dot(z_), slip = std::sqrt(s0 * s0 + s1 * s1);
    if (slip > 0) {
      out.direction[0] = s0 / slip;
      out.direction[1] = s1 / slip;
    }
  }
  complete(out);
}

void RelaxedCone::complete(Row& row) const noexcept {
  const FrictionProblem& p = *problem_;
  row.unit = p.normals.row(row.contact);
  if (p.mu[row.contact] > 0)
    for (int k = 0; k < 2; ++k) row.unit -= p.mu[row.contact] * row.direction[k] * p.tangents[row.contact].row[k];
  row.length = row.unit.norm();
  if (!(row.length > 0)) return;
  row.unit /= row.length;
  row.target = bounds_[row.contact] / row.length - row.unit.dot(p.wanted);
}

void RelaxedCone::start_from(const std::vector<FrictionForce>& forces) noexcept {
  for (const FrictionForce& f : forces) {
    const double most = problem_->mu[f.row] * f.normal;
    if (size_ == 6) break;
    Row row;
    row.contact = f.row;
    // N z - μ d·T z >= b holds wherever the cone's limit does for every d of length at most 1; of a contact that sticks
    // the one plane with d = -τ / (μ ν) has its whole force.
    if (most > 0) {
      const double size = std::sqrt(f.tangential[0] * f.tangential[0] + f.tangential[1] * f.tangential[1]);
      for (int k = 0; k < 2; ++k) row.direction[k] = -f.tangential[k] / std::max(most, size);
    }
    complete(row);
    if (row.length > 0 && span_.append(row.unit, kDependent)) rows_[size_++] = row;
  }
  // The method may start from any rows whose own problem has them all pushing.
  for (;;) {
    solve_active();
    const double* least = std::min_element(lambda_, lambda_ + size_);
    if (size_ == 0 || *least >= 0) return;
    drop(static_cast<int>(least - lambda_));
  }
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

bool RelaxedCone::solve(const double* bounds, double tolerance, const std::vector<FrictionForce>& start) noexcept {
  set_bounds(bounds);
  span_.clear();
  size_ = changes_ = 0;
  z_ = problem_->wanted;
  const double scale = problem_->wanted.norm();
  start_from(start);
  Row row;
  while (most_violated(tolerance * scale, row)) {
    if (past(problem_->deadline_ns)) return false;
    if (take(row)) continue;
    return !most_violated(std::max(tolerance, kAccepted) * scale, row);
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
