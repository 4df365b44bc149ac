// What of a sub-step is different where contacts rub.
#include "loop/contact_loop.hpp"
#include "loop/contact_margin.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// A contact that slides goes farther than this in a tick (m): 10 µm/s at 1 kHz.
constexpr double kSlip = 1e-8;

}  // namespace

bool ContactLoop::solve_with_friction(const Vec6& wanted, TickReport& report, Vec6& motion) {
  const auto& constraints = at_.contacts->constraints();
  rows_.clear();
  for (const Contact& c : constraints) rows_.push_row(metric_.row(c));
  // The first program of a tick is solved to its end, or a part whose budget is short would never move.
  const std::int64_t deadline_ns = report.resolves == 0 ? kNoDeadline : deadline_ns_;
  for (const double slack : {0.0, kNormalNoise}) {
    const double give = slack * wanted.norm();
    for (std::size_t i = 0; i < constraints.size(); ++i)
      bounds_[i] = bound_of(constraints[i], margin_, recover_below_, 0) - give;
    const Resolution r =
        resolver_->resolve_with_friction(friction_.problem(rows_, bounds_.data(), wanted, deadline_ns));
    ++report.resolves;
    report.iterations += r.iterations;
    // Out of time is not a failure of the program; the tick says that it was cut.
    if (r.status == ResolveStatus::stalled && past(deadline_ns)) return false;
    report.status = r.status;
    motion = r.motion;
    if (r.status != ResolveStatus::solved) continue;
    known_.clear();
    if (r.forces != nullptr)
      for (const FrictionForce& f : *r.forces) {
        const Contact& c = constraints[static_cast<std::size_t>(f.row)];
        if (known_.size() < known_.capacity()) known_.push_back({c.part, c.feature_a, c.feature_b, f});
      }
    mark_carriers(motion);
    return true;
  }
  return false;
}

const std::vector<FrictionForce>& ContactLoop::known_forces() {
  const auto& constraints = at_.contacts->constraints();
  guess_.clear();
  for (const KnownForce& k : known_)
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      const Contact& c = constraints[i];
      if (c.part != k.part || c.feature_a != k.feature_a || c.feature_b != k.feature_b) continue;
      guess_.push_back(k.force);
      guess_.back().row = static_cast<int>(i);
      break;
    }
  return guess_;
}

void ContactLoop::recover_gaps(TickReport& report, Vec6& motion) {
  const auto& constraints = at_.contacts->constraints();
  bool lost = false;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    bounds_[i] = bound_of(constraints[i], margin_, recover_below_, kRecovery * margin_);
    lost |= is_lost(constraints[i], margin_, recover_below_);
  }
  if (!lost) return;
  const Resolution r = resolver_->resolve(rows_, bounds_.data(), motion);
  ++report.resolves;
  report.iterations += r.iterations;
  if (r.status == ResolveStatus::solved && size(metric_.unwhiten(r.motion - motion)) < kMaxRecovery * margin_)
    motion = r.motion;
}

void ContactLoop::report_slip(const Displacement& moved, ContactForces& forces) const {
  const Vec3 c = X_ * center_;
  for (int i = 0; i < forces.count; ++i) {
    ContactForce& f = forces.items[static_cast<std::size_t>(i)];
    const Vec3 way = moved.dp + moved.dr.cross(f.point - c);
    f.slides = f.mu > 0 && (way - f.n.dot(way) * f.n).norm() > kSlip;
  }
}

}  // namespace tegotae
