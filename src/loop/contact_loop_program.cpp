// The program over the contacts of a sub-step: from the wanted motion to one that they allow.
#include <algorithm>
#include <utility>

#include "loop/contact_loop.hpp"
#include "loop/contact_margin.hpp"

namespace tegotae {
namespace {

// A part that stands between opposite sides and may go along them by this share of its way, if the constraints give way
// by the noise of their normals, is held by that noise alone: walls that meet at 1e-7 rad are parallel.
constexpr double kAlongShare = 1e-2;

}  // namespace

bool ContactLoop::resolve(const Vec6& wanted, double cap, TickReport& report, Trial& trial) {
  Vec6 motion = wanted;
  bool rubs = false;
  if (!at_.contacts->constraints().empty()) {
    rubs = friction_.fill(at_.contacts->constraints(), metric_);
    const bool solved = rubs ? solve_with_friction(wanted, report, motion) : solve(wanted, report, motion);
    // Cutting planes between triangles that do not touch explain no lag.
    if (solved && only_contacts()) allowed_ = size(metric_.unwhiten(motion));
    if (!solved) motion.setZero();
    const bool shorter = !resolver_->projects() && try_shorter_motions(wanted, cap, report, motion);
    if (!solved && !shorter) return false;
  }
  trial.d = metric_.unwhiten(motion);
  const double length = size(trial.d);
  if (length > cap) {
    // The direction is that of the whole motion. Gaps are recovered again at the length that is made, or a long motion
    // would leave nearly nothing of their recovery.
    const Vec6 scaled = (cap / length) * motion;
    motion = scaled;
    if (!rubs && !at_.contacts->constraints().empty() &&
        (!solve(scaled, report, motion) || is_long_way_back(motion, wanted)))
      motion = scaled;
  }
  // The rest of a longer motion would see no load and so no friction; its gaps are recovered without friction.
  if (rubs) recover_gaps(report, motion);
  trial.d = metric_.unwhiten(motion);
  trial.X = displaced(X_, center_, trial.d);
  return true;
}

bool ContactLoop::try_shorter_motions(const Vec6& wanted, double cap, TickReport& report, Vec6& motion) {
  const double far = size(metric_.unwhiten(wanted));
  // Of a motion that mostly leads aside little is left when it is cut to a sub-step's length, however long it is.
  const auto brings = [&](const Vec6& m, double longest) {
    return std::min(1.0, longest / std::max(size(metric_.unwhiten(m)), kRest)) * m.dot(wanted);
  };
  Vec6 best = motion;
  bool any = false;
  for (double way = std::min(cap, far);
       way > margin_ && brings(best, way) < kWorthwhile * way / far * wanted.squaredNorm(); way *= kShorter) {
    if (!solve((way / far) * wanted, report, motion)) continue;
    any = true;
    if (brings(motion, cap) > brings(best, cap)) best = motion;
  }
  motion = best;
  return any;
}

bool ContactLoop::solve(const Vec6& wanted, TickReport& report, Vec6& motion) {
  const auto& constraints = at_.contacts->constraints();
  rows_.clear();
  for (const Contact& c : constraints) rows_.push_row(metric_.row(c));
  // Gaps that were lost to rounding or curvature recover where the program allows it; without recovery it has an
  // answer, because standing still is one, but for rounding. Between walls without room that may be the only one, by
  // rounding too.
  bool only_stands = false;
  for (const auto& [recovery, slack] : {std::pair(kRecovery * margin_, 0.0), {0.0, 0.0}, {0.0, kNormalNoise}}) {
    const double give = slack * wanted.norm();
    for (std::size_t i = 0; i < constraints.size(); ++i) {
      bounds_[i] = bound_of(constraints[i], margin_, recover_below_, recovery) - give;
    }
    const Resolution r = resolver_->resolve(rows_, bounds_.data(), wanted);
    ++report.resolves;
    report.iterations += r.iterations;
    report.status = r.status;
    motion = r.motion;
    if (only_stands && (r.status != ResolveStatus::solved || motion.norm() < kAlongShare * wanted.norm())) break;
    if (r.status != ResolveStatus::solved) continue;
    if (recovery != 0 && is_long_way_back(r.motion, wanted)) continue;
    only_stands = recovery == 0 && slack == 0 && resolver_->projects() && motion.norm() < kRest &&
                  wanted.norm() > kRest && wedged();
    if (only_stands) continue;
    mark_carriers(motion);
    return true;
  }
  if (!only_stands) return false;
  motion.setZero();
  report.status = ResolveStatus::solved;
  mark_carriers(motion);
  return true;
}

bool ContactLoop::is_long_way_back(const Vec6& motion, const Vec6& wanted) const {
  // Gaps between nearly parallel constraints may ask for a long way, even back out of a hole: they are not worth it.
  const bool away = motion.squaredNorm() > 2 * wanted.dot(motion);
  return away && size(metric_.unwhiten(motion)) >= kMaxRecovery * margin_;
}

void ContactLoop::mark_carriers(const Vec6& motion) {
  far_planes_ = false;
  for (int i = 0; i < rows_.rows(); ++i)
    if (rows_.row(i).dot(motion) <= bounds_[static_cast<std::size_t>(i)] + kRest) carries(static_cast<std::size_t>(i));
}

void ContactLoop::carries(std::size_t i) {
  at_.contacts->carries(i);
  if (!far_planes_ && at_.contacts->constraints()[i].age == kOneShotAge)
    far_planes_ = !at_.contacts->touches(i, margin_ / kMarginShare);
}

}  // namespace tegotae
