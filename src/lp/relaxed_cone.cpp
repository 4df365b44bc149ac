#include "lp/relaxed_cone.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tegotae {
namespace {

/// What is accepted where rounding keeps a row from being taken.
constexpr double kAccepted = 1e-7;
/// A unit row whose part outside the span of the others is shorter depends on them.
constexpr double kDependent = 1e-9;
/// Far above the 2 to 60 changes that solves take.
constexpr int kMaxChanges = 300;

LaneBlock product(const RowBlock& rows, const Vec6& z) noexcept {
  LaneBlock out{};
  for (int k = 0; k < 6; ++k)
    for (int lane = 0; lane < kRowLanes; ++lane) out.v[lane] += rows.g[k][lane] * z[k];
  return out;
}

}  // namespace

RelaxedCone::RelaxedCone(int capacity)
    : friction_{LowRankMatrix(capacity), LowRankMatrix(capacity)},
      bounds_(static_cast<std::size_t>((capacity + kRowLanes - 1) / kRowLanes)) {}

void RelaxedCone::set_problem(const FrictionProblem& problem) noexcept {
  problem_ = &problem;
  const int rows = problem.normals.rows();
  for (int k = 0; k < 2; ++k) {
    friction_[k].clear();
    for (int i = 0; i < rows; ++i)
      friction_[k].push_row(problem.mu[i] > 0 ? Vec6(problem.mu[i] * problem.tangents[i].row[k]) : Vec6::Zero());
  }
  for (int i = 0; i < rows; ++i) bounds_[static_cast<std::size_t>(i / kRowLanes)].v[i % kRowLanes] = problem.bounds[i];
}

bool RelaxedCone::most_violated(double tolerance, Row& out) noexcept {
  const int rows = problem_->normals.rows();
  double worst = tolerance;
  int found = -1;
  for (int begin = 0; begin < rows; begin += kRowLanes) {
    const int at = begin / kRowLanes;
    const LaneBlock n = product(problem_->normals.blocks()[at], z_), t0 = product(friction_[0].blocks()[at], z_),
                    t1 = product(friction_[1].blocks()[at], z_);
    const LaneBlock& bound = bounds_[static_cast<std::size_t>(at)];
    LaneBlock by;
    for (int lane = 0; lane < kRowLanes; ++lane)
      by.v[lane] = bound.v[lane] - n.v[lane] + std::sqrt(t0.v[lane] * t0.v[lane] + t1.v[lane] * t1.v[lane]);
    for (int lane = 0; lane < std::min(kRowLanes, rows - begin); ++lane)
      if (by.v[lane] > worst) {
        worst = by.v[lane];
        found = begin + lane;
      }
  }
  if (found < 0) return false;
  make_row(found, out);
  return out.length > 0;
}

void RelaxedCone::make_row(int contact, Row& out) const noexcept {
  const FrictionProblem& p = *problem_;
  out.contact = contact;
  out.unit = p.normals.row(contact);
  out.direction[0] = out.direction[1] = 0;
  if (p.mu[contact] > 0) {
    const TangentRows& t = p.tangents[contact];
    const double s0 = t.row[0].dot(z_), s1 = t.row[1].dot(z_), slip = std::sqrt(s0 * s0 + s1 * s1);
    if (slip > 0) {
      out.direction[0] = s0 / slip;
      out.direction[1] = s1 / slip;
    }
    out.unit -= p.mu[contact] * (out.direction[0] * t.row[0] + out.direction[1] * t.row[1]);
  }
  out.length = out.unit.norm();
  if (!(out.length > 0)) return;
  out.unit /= out.length;
  out.target = p.bounds[contact] / out.length - out.unit.dot(p.wanted);
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

bool RelaxedCone::solve(const FrictionProblem& problem, double tolerance) noexcept {
  set_problem(problem);
  span_.clear();
  size_ = changes_ = 0;
  z_ = problem.wanted;
  const double scale = problem.wanted.norm();
  Row row;
  while (most_violated(tolerance * scale, row)) {
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
