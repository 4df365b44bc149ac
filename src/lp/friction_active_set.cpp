#include "lp/friction_active_set.hpp"

#include <algorithm>
#include <cmath>

#include "lp/small_lu.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Rounds after which it will not end; those that end take 2 to 12.
constexpr int kMaxRounds = 25;
/// A contact that changed between sliding and sticking so often goes in a circle.
constexpr int kMaxFlips = 4;
/// Less than this part of the wanted motion is neither a motion nor a violation.
constexpr double kSmall = 1e-8;
/// Pulls and friction beyond a cone count from this part of the wanted motion on.
constexpr double kForce = 1e-9;
/// How much a contact gives (m per m of force, by the mean squared length of the rows) before the next round takes it
/// back. All give alike: a face then presses as one on an even bed does.
constexpr double kGive = 1e-7;
/// An answer so many times as long as the wanted motion is none: the system was close to singular.
constexpr double kFar = 1e3;
/// Slip directions stand when they turn by less (rad).
constexpr double kTurn = 1e-8;
/// While they turn by less (rad) it is right already what is violated.
constexpr double kTurnsLittle = 0.1;
/// Forces below this part of the wanted motion matter in proportion for whether a direction stands.
constexpr double kMatters = 1e-2;
/// Of contacts beyond their cones those within this share of the worst slide in one round.
constexpr double kTogether = 0.5;
/// Of more contacts than this that touch, an even sample shares the load.
constexpr std::size_t kMaxTouching = 64;

/// Of numbers whose squares neither overflow nor vanish; std::hypot costs ten times as much.
double length(double a, double b) noexcept {
  return std::sqrt(a * a + b * b);
}

}  // namespace

FrictionActiveSet::FrictionActiveSet(int capacity)
    : pricing_(pricing()),
      bounds_(static_cast<std::size_t>((capacity + kRowLanes - 1) / kRowLanes)),
      outside_(bounds_.size()) {
  touching_.reserve(static_cast<std::size_t>(capacity));
}

void FrictionActiveSet::set_direction(Member& m, double d0, double d1) noexcept {
  m.direction[0] = d0;
  m.direction[1] = d1;
  m.column = m.n;
  if (m.mu > 0) m.column -= m.mu * (d0 * m.t[0] + d1 * m.t[1]);
}

bool FrictionActiveSet::add(int row) noexcept {
  if (count_ == kMaxMembers) return false;
  Member& m = members_[static_cast<std::size_t>(count_++)];
  m.row = row;
  m.n = problem_->normals.row(row);
  m.bound = problem_->bounds[row];
  m.mu = problem_->mu[row];
  m.length = m.n.norm();
  m.normal = m.tangential[0] = m.tangential[1] = m.slip[0] = m.slip[1] = 0;
  m.flips = 0;
  set_outside(row, false);
  m.slides = true;
  if (m.mu > 0) {
    m.t[0] = problem_->tangents[row].row[0];
    m.t[1] = problem_->tangents[row].row[1];
    m.slip[0] = m.t[0].dot(z_);
    m.slip[1] = m.t[1].dot(z_);
    const double far = length(m.slip[0], m.slip[1]);
    m.slides = far > slip_;
    m.along = std::max(far, slip_);
    if (m.slides) set_direction(m, m.slip[0] / far, m.slip[1] / far);
  } else {
    set_direction(m, 0, 0);
  }
  return true;
}

void FrictionActiveSet::remove(int position) noexcept {
  set_outside(members_[static_cast<std::size_t>(position)].row, true);
  std::copy(members_.begin() + position + 1, members_.begin() + count_, members_.begin() + position);
  --count_;
}

void FrictionActiveSet::set_problem(const Vec6& from) noexcept {
  z_ = from;
  scale_ = problem_->wanted.norm();
  slip_ = kSmall * scale_;
  count_ = 0;
  const int rows = problem_->normals.rows(), blocks = (rows + kRowLanes - 1) / kRowLanes;
  for (int i = 0; i < blocks * kRowLanes; ++i) {
    bounds_[static_cast<std::size_t>(i / kRowLanes)].v[i % kRowLanes] = i < rows ? problem_->bounds[i] : 0;
    outside_[static_cast<std::size_t>(i / kRowLanes)].v[i % kRowLanes] = i < rows ? 1 : 0;
  }
}

void FrictionActiveSet::begin(const Vec6& from) noexcept {
  set_problem(from);
  const int rows = problem_->normals.rows();
  touching_.clear();
  for (int i = 0; i < rows; ++i)
    if (problem_->normals.row(i).dot(z_) - problem_->bounds[i] < slip_) touching_.push_back(i);
  const std::size_t taken = std::min(touching_.size(), kMaxTouching);
  double squares = 0;
  for (std::size_t k = 0; k < taken; ++k)
    squares += problem_->normals.row(touching_[k * touching_.size() / taken]).squaredNorm();
  give_ = kGive * (taken > 0 ? squares / static_cast<double>(taken) : 1);
  for (std::size_t k = 0; k < taken; ++k) add(touching_[k * touching_.size() / taken]);
}

void FrictionActiveSet::push_product(double factor, const Vec6& a, const Vec6& b) noexcept {
  const auto k = static_cast<std::size_t>(products_++);
  for (int i = 0; i < 6; ++i) {
    left_[k].v[i] = factor * a[i];
    right_[k].v[i] = b[i];
  }
}

bool FrictionActiveSet::step() noexcept {
  Vec6 r = problem_->wanted;
  const double stiff = 1 / give_;
  products_ = 0;
  for (int k = 0; k < count_; ++k) {
    Member& m = members_[static_cast<std::size_t>(k)];
    const double push = m.normal + m.bound * stiff;
    if (m.slides) {
      r += push * m.column;
      push_product(stiff, m.column, m.n);
      // As z turns the slip, friction turns with it: across it by what z goes across, over how far it goes along.
      m.turns = m.mu > 0 && m.normal > 0;
      if (m.turns) {
        const Vec6 across = m.direction[0] * m.t[1] - m.direction[1] * m.t[0];
        push_product(m.mu * m.normal / m.along, across, across);
      }
    } else {
      r += push * m.n + m.tangential[0] * m.t[0] + m.tangential[1] * m.t[1];
      push_product(stiff, m.n, m.n);
      for (const Vec6& t : m.t) push_product(stiff, t, t);
    }
  }
  PaddedVec6 sum[6];
  pricing_.sum_products(left_.data(), right_.data(), products_, sum);
  double h[6][6];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) h[i][j] = sum[i].v[j] + (i == j ? 1 : 0);
  SmallLu lu;
  if (!lu.factor(h, 6)) return false;
  lu.solve(r.data());
  if (!r.allFinite() || r.norm() > kFar * scale_) return false;
  z_ = r;
  error_ = 0;
  for (int k = 0; k < count_; ++k) {
    Member& m = members_[static_cast<std::size_t>(k)];
    const double gap = m.bound - m.n.dot(z_);
    m.normal += gap / give_;
    error_ = std::max(error_, std::abs(gap));
    if (m.mu == 0) continue;
    for (int i = 0; i < 2; ++i) {
      m.slip[i] = m.t[i].dot(z_);
      if (!m.slides) m.tangential[i] -= m.slip[i] / give_;
    }
    if (!m.slides) error_ = std::max(error_, length(m.slip[0], m.slip[1]));
  }
  return true;
}

bool FrictionActiveSet::drop_pulling(bool first) noexcept {
  const double most = -kForce * scale_;
  int worst = -1;
  double pull = most;
  for (int k = 0; k < count_; ++k) {
    const Member& m = members_[static_cast<std::size_t>(k)];
    if (m.normal * m.length < pull) {
      pull = m.normal * m.length;
      worst = k;
    }
  }
  if (worst < 0) return false;
  if (!first) {
    remove(worst);
    return true;
  }
  for (int k = count_ - 1; k >= 0; --k)
    if (members_[static_cast<std::size_t>(k)].normal < 0) remove(k);
  for (int k = 0; k < count_; ++k) {
    Member& m = members_[static_cast<std::size_t>(k)];
    m.normal = m.tangential[0] = m.tangential[1] = 0;
  }
  return true;
}

FrictionActiveSet::Change FrictionActiveSet::stick_or_turn() noexcept {
  bool changed = false;
  turn_ = 0;
  for (int k = 0; k < count_; ++k) {
    Member& m = members_[static_cast<std::size_t>(k)];
    if (m.mu == 0 || !m.slides) continue;
    const double far = length(m.slip[0], m.slip[1]), force = m.normal * m.length;
    double d[2] = {m.direction[0], m.direction[1]};
    if (far > slip_ && force > kForce * scale_)
      turn_ = std::max(turn_, length(m.slip[0] / far - d[0], m.slip[1] / far - d[1]) *
                                  std::min(1.0, m.mu * force / (kMatters * scale_)));
    // Direction and length are unknowns of their own (Newton's method for z, the direction and the length): the next
    // direction is the one that friction had in this round, not that of the slip, which turns by any angle where little
    // of it is left.
    if (m.turns) {
      const double by = (d[0] * m.slip[1] - d[1] * m.slip[0]) / m.along, size = std::sqrt(1 + by * by);
      d[0] = (m.direction[0] - by * m.direction[1]) / size;
      d[1] = (m.direction[1] + by * m.direction[0]) / size;
    }
    m.along = m.slip[0] * d[0] + m.slip[1] * d[1];
    if (m.along < -slip_) {
      if (++m.flips > kMaxFlips) return Change::failed;
      m.slides = false;
      for (int i = 0; i < 2; ++i) m.tangential[i] = -m.mu * m.normal * m.direction[i];
      changed = true;
    } else if (m.turns) {
      set_direction(m, d[0], d[1]);
    } else if (far > slip_) {
      set_direction(m, m.slip[0] / far, m.slip[1] / far);
      m.along = far;
    }
    m.along = std::max(m.along, slip_);
  }
  return changed ? Change::some : Change::none;
}

FrictionActiveSet::Change FrictionActiveSet::slide() noexcept {
  const auto beyond = [this](const Member& m) {
    return (length(m.tangential[0], m.tangential[1]) - m.mu * m.normal) * m.length / scale_;
  };
  double worst = kForce;
  for (int k = 0; k < count_; ++k) {
    const Member& m = members_[static_cast<std::size_t>(k)];
    if (!m.slides) worst = std::max(worst, beyond(m));
  }
  if (!(worst > kForce)) return Change::none;
  for (int k = 0; k < count_; ++k) {
    Member& m = members_[static_cast<std::size_t>(k)];
    if (m.slides || !(beyond(m) > kTogether * worst)) continue;
    if (++m.flips > kMaxFlips) return Change::failed;
    const double force = length(m.tangential[0], m.tangential[1]);
    m.slides = true;
    set_direction(m, -m.tangential[0] / force, -m.tangential[1] / force);
    m.along = slip_;  // first along that line only
    m.tangential[0] = m.tangential[1] = 0;
  }
  return Change::some;
}

bool FrictionActiveSet::add_most_violated() noexcept {
  const LowRankMatrix& rows = problem_->normals;
  const RowChoice worst = pricing_.most_violated(rows.blocks(), bounds_.data(), outside_.data(),
                                                 (rows.rows() + kRowLanes - 1) / kRowLanes, z_.data());
  return worst.row >= 0 && worst.value > slip_ && add(worst.row);
}

bool FrictionActiveSet::solve(const FrictionProblem& problem, const Vec6& from) noexcept {
  problem_ = &problem;
  begin(from);
  return run(true);
}

bool FrictionActiveSet::refine(const FrictionProblem& problem, const Vec6& from,
                               const std::vector<FrictionForce>& forces) noexcept {
  problem_ = &problem;
  set_problem(from);
  double squares = 0;
  for (const FrictionForce& f : forces) squares += problem.normals.row(f.row).squaredNorm();
  give_ = kGive * (forces.empty() ? 1 : squares / static_cast<double>(forces.size()));
  for (const FrictionForce& f : forces) {
    if (!add(f.row)) return false;
    Member& m = members_[static_cast<std::size_t>(count_ - 1)];
    m.normal = f.normal;
    if (m.slides) continue;
    const double force = length(f.tangential[0], f.tangential[1]);
    if (f.slides && force > 0) {  // first along the line of its friction only
      m.slides = true;
      set_direction(m, -f.tangential[0] / force, -f.tangential[1] / force);
      continue;
    }
    m.tangential[0] = f.tangential[0];
    m.tangential[1] = f.tangential[1];
  }
  return run(false);
}

bool FrictionActiveSet::run(bool first) noexcept {
  for (rounds_ = 1; rounds_ <= kMaxRounds; ++rounds_) {
    if (past(problem_->deadline_ns) || !step()) return false;
    if (drop_pulling(first)) continue;
    first = false;
    const Change stuck = stick_or_turn();
    if (stuck == Change::failed) return false;
    if (stuck == Change::some) continue;
    const Change slid = slide();
    if (slid == Change::failed) return false;
    if (slid == Change::some || turn_ > kTurnsLittle || add_most_violated()) continue;
    if (turn_ <= kTurn && error_ <= 0.1 * slip_) return true;
  }
  return false;
}

void FrictionActiveSet::forces(std::vector<FrictionForce>& out) const noexcept {
  for (int k = 0; k < count_; ++k) {
    const Member& m = members_[static_cast<std::size_t>(k)];
    if (!(m.normal > 0)) continue;
    FrictionForce f;
    f.row = m.row;
    f.normal = m.normal;
    f.slides = m.slides && m.mu > 0 && length(m.slip[0], m.slip[1]) > slip_;
    for (int i = 0; i < 2 && m.mu > 0; ++i)
      f.tangential[i] = m.slides ? -m.mu * m.normal * m.direction[i] : m.tangential[i];
    out.push_back(f);
  }
}

}  // namespace tegotae
