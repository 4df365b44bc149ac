#include "review/findings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "broadphase/bounding_spheres.hpp"
#include "loop/lag.hpp"
#include "loop/scene_parts.hpp"
#include "review/spans.hpp"
#include "session/run_goal.hpp"

namespace tegotae::review {
namespace {

// Breaks that do not end an episode, s: a part that slides over facets lets go for a tick now and then.
constexpr double kJoin = 0.05;
constexpr double kMinTwoSided = 5e-3;  // s
// By so much a run's last row may be before its end, s: a tick or, in real time, a few.
constexpr double kTicks = 5e-3;
// A stall: slower than this over the window while the pen is ahead by so much, for so long.
constexpr double kStallSpeed = 1e-3, kWindow = 0.05, kAhead = 0.5e-3, kMinStall = 0.2;

class Finder {
 public:
  Finder(const SceneFile& file, const std::vector<RecordFrame>& rows, const Scan& scan, const Vec3& center,
         const GoalRule& rule)
      : file_(file),
        rows_(rows),
        scan_(scan),
        center_(center),
        radius_(radius_about(*held_part(file.scene).mesh, center)),
        goal_(rule.tolerance ? RunGoal(file, center, *rule.tolerance) : RunGoal(file, center)),
        rule_(rule) {}

  Findings all() const {
    Findings out;
    out.seconds = rows_.back().t - rows_.front().t;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      const Displacement d = displacement(rows_[i - 1].x, rows_[i].x, center_);
      out.way += d.dp.norm();
      out.turn += d.dr.norm();
    }
    out.start = find_start(file_.scene, rows_, scan_);
    out.blocker = apps::find_blocker(file_.scene, start_at_the_end(out.start), last_ticks());
    if (has_goal()) {
      out.goal = goal();
      out.exit = find_exit(file_.scene, center_, rows_.front().x, goal_.end(), rows_[out.goal->judged_row].x);
    }
    out.clearances = clearances();
    out.contacts = contacts();
    out.two_sided = two_sided();
    out.stalls = stalls();
    out.loads = loads();
    return out;
  }

 private:
  const RecordFrame& row(std::size_t i) const { return rows_[scan_.rows[i].row]; }
  double force(std::size_t i) const { return row(i).wrench.force.norm(); }
  bool has_goal() const { return file_.script.end() > file_.script.begin(); }
  Span span(const std::pair<std::size_t, std::size_t>& s) const { return {row(s.first).t, row(s.second).t}; }

  static const Clearance* to_part(const ScannedRow& row, std::size_t part) {
    for (const Clearance& c : row.clearances)
      if (c.part == part) return &c;
    return nullptr;
  }
  bool touches(std::size_t i, std::size_t part) const {
    const Clearance* c = to_part(scan_.rows[i], part);
    return c && c->distance <= scan_.rows[i].contact_gap;
  }
  template <typename Holds>
  auto runs(const Holds& holds, double least) const {
    // A thinned recording has breaks of its own.
    return spans(
        scan_.rows.size(), [&](std::size_t i) { return row(i).t; }, holds, kJoin, least);
  }

  /// The last row of each tick.
  std::vector<apps::TickPoses> last_ticks() const {
    std::vector<apps::TickPoses> out;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (i + 1 == rows_.size() || rows_[i + 1].tick != rows_[i].tick)
        out.push_back({rows_[i].t, rows_[i].y, rows_[i].x});
    return out;
  }

  static InitialContactReport start_at_the_end(const StartFindings& start) {
    InitialContactReport out;
    for (const StartFinding& f : start.pairs) {
      out.pairs.push_back(f.pair);
      if (std::isfinite(f.until)) out.pairs.back().state = InitialContactState::active;
    }
    return out;
  }

  GoalFindings goal() const {
    GoalFindings out;
    const RecordFrame& last = rows_.back();
    out.reached = goal_.reached(last.x) &&
                  !held_up(size(displacement(last.x, last.y, center_)), lag_bound(radius_), last.lag_reason);
    out.starts_there = goal_.reached(rows_.front().x);
    out.by_end = rule_.judged_after.has_value();
    out.cut = out.by_end && last.t + kTicks < *rule_.judged_after;
    const auto first = std::find_if(rows_.begin(), rows_.end(), [&](const auto& r) { return goal_.reached(r.x); });
    out.passed = first != rows_.end();
    if (out.passed) out.at = first->t;
    const bool before = !out.reached && out.passed && !out.by_end;
    out.judged_row = before ? static_cast<std::size_t>(first - rows_.begin()) : rows_.size() - 1;
    out.there_depth = goal_.depth(rows_[out.judged_row].x);
    const Displacement missing = goal_.missing(rows_.back().x);
    out.missing = missing.dp.norm();
    out.missing_angle = missing.dr.norm();
    out.depth = goal_.depth(rows_.back().x);
    out.way = goal_.way();
    out.tolerance = goal_.tolerance();
    return out;
  }

  std::vector<PartClearance> clearances() const {
    std::map<std::size_t, PartClearance> least;
    for (std::size_t i = 0; i < scan_.rows.size(); ++i)
      for (const Clearance& c : scan_.rows[i].clearances) {
        const auto [at, fresh] = least.try_emplace(c.part);
        if (fresh || c.distance < at->second.distance)
          at->second = {c.part, c.distance, row(i).t, 0.5 * (c.on_held_W + c.on_other_W)};
      }
    std::vector<PartClearance> out;
    out.reserve(least.size());
    for (const auto& [part, one] : least) out.push_back(one);
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
    return out;
  }

  std::vector<ContactEpisode> contacts() const {
    std::set<std::size_t> touched;
    for (std::size_t i = 0; i < scan_.rows.size(); ++i)
      for (const Clearance& c : scan_.rows[i].clearances)
        if (touches(i, c.part)) touched.insert(c.part);
    std::vector<ContactEpisode> out;
    for (const std::size_t part : touched)
      for (const auto& s : runs([&](std::size_t i) { return touches(i, part); }, 0)) {
        ContactEpisode e;
        e.span = span(s);
        e.part = part;
        e.force = -1;
        e.clearance = INFINITY;
        for (std::size_t i = s.first; i <= s.second; ++i) {
          const Clearance* c = to_part(scan_.rows[i], part);
          if (!c || !touches(i, part)) continue;
          e.clearance = std::min(e.clearance, c->distance);
          if (force(i) <= e.force) continue;
          e.force = force(i);
          e.place_W = c->on_other_W;
        }
        out.push_back(e);
      }
    std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.span.begin < b.span.begin; });
    return out;
  }

  /// Parts in contact at `share` of the rows of a run at least.
  std::vector<std::size_t> parts_in(const std::pair<std::size_t, std::size_t>& s, double share) const {
    std::map<std::size_t, std::size_t> count;
    for (std::size_t i = s.first; i <= s.second; ++i)
      for (const Clearance& c : scan_.rows[i].clearances)
        if (touches(i, c.part)) ++count[c.part];
    std::vector<std::size_t> out;
    for (const auto& [part, n] : count)
      if (static_cast<double>(n) >= share * static_cast<double>(s.second - s.first + 1)) out.push_back(part);
    return out;
  }

  std::vector<TwoSidedEpisode> two_sided() const {
    std::vector<TwoSidedEpisode> out;
    for (const auto& s : runs([&](std::size_t i) { return scan_.rows[i].two_sided; }, kMinTwoSided)) {
      TwoSidedEpisode e{span(s), parts_in(s, 0), -1, Vec3::Zero()};
      for (std::size_t i = s.first; i <= s.second; ++i) {
        if (!scan_.rows[i].two_sided || force(i) <= e.force) continue;
        e.force = force(i);
        e.place_W = scan_.rows[i].contact_W;
      }
      out.push_back(e);
    }
    return out;
  }

  /// How far the pen, or where the part was going, is from the part, m.
  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }

  std::vector<Stall> stalls() const {
    std::vector<bool> stands(scan_.rows.size());
    for (std::size_t i = 0, from = 0; i < stands.size(); ++i) {
      while (row(i).t - row(from).t > kWindow) ++from;
      const double window = row(i).t - row(from).t;
      stands[i] = window > 0.5 * kWindow && row(i).contacts > 0 &&
                  size(displacement(row(from).x, row(i).x, center_)) < kStallSpeed * window &&
                  size(displacement(row(i).x, row(i).y, center_)) > kAhead;
    }
    std::vector<Stall> out;
    for (const auto& s : runs([&](std::size_t i) { return stands[i]; }, kMinStall)) out.push_back(stall(s));
    return out;
  }

  Stall stall(const std::pair<std::size_t, std::size_t>& s) const {
    Stall e;
    e.span = span(s);
    e.parts = parts_in(s, 0.5);
    e.force = -1;
    for (std::size_t i = s.first; i <= s.second; ++i) {
      e.ahead = std::max(e.ahead, size(displacement(row(i).x, row(i).y, center_)));
      if (force(i) <= e.force) continue;
      e.force = force(i);
      const auto& near = scan_.rows[i].clearances;
      e.place_W = near.empty() || near.front().distance > scan_.rows[i].contact_gap ? row(i).x * center_
                                                                                    : near.front().on_other_W;
      e.depth = has_goal() ? goal_.depth(row(i).x) : 0;
    }
    return e;
  }

  Loads loads() const {
    Loads out;
    const SafetySettings& safety = file_.safety;
    out.limit_force = std::min(safety.limits.force, file_.device.limits.force);
    out.limit_torque = std::min(safety.limits.torque, file_.device.limits.torque);
    const double a = safety.continuous_force, b = file_.device.continuous_force;
    out.continuous = a > 0 && b > 0 ? std::min(a, b) : std::max(a, b);
    out.thermal_time = safety.thermal_time;
    double squares = 0;  // N² s over the last thermal_time
    std::size_t oldest = 1;
    const auto share = [&](std::size_t i) {
      return rows_[i].wrench.force.squaredNorm() * (rows_[i].t - rows_[i - 1].t);
    };
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const RecordFrame& r = rows_[i];
      const auto larger = [&](double value, double& most, double* at) {
        if (!(value > most)) return;
        most = value;
        if (at) *at = r.t;
      };
      larger(r.wrench.force.norm(), out.force, &out.force_at);
      larger(r.wrench.torque.norm(), out.torque, &out.torque_at);
      const Wrench asked = asked_wrench(r, file_.scene.coupling, center_);
      larger(asked.force.norm(), out.asked_force, nullptr);
      larger(asked.torque.norm(), out.asked_torque, nullptr);
      if (i == 0) continue;
      squares += share(i);
      while (r.t - rows_[oldest].t > out.thermal_time) squares -= share(oldest++);
      larger(std::sqrt(std::max(0.0, squares) / out.thermal_time), out.running_rms, nullptr);
    }
    return out;
  }

  const SceneFile& file_;
  const std::vector<RecordFrame>& rows_;
  const Scan& scan_;
  Vec3 center_;
  double radius_;
  RunGoal goal_;
  GoalRule rule_;
};

}  // namespace

Wrench asked_wrench(const RecordFrame& row, const CouplingSettings& coupling, const Vec3& center) {
  if (row.contacts == 0) return row.wrench;  // the coupling is off while nothing touches
  const Displacement lead = displacement(row.x, row.y, center);
  const Wrench springs{coupling.stiffness * lead.dp, coupling.torsional_stiffness * lead.dr};
  return {springs.force.norm() > row.wrench.force.norm() ? springs.force : row.wrench.force,
          springs.torque.norm() > row.wrench.torque.norm() ? springs.torque : row.wrench.torque};
}

Findings find(const SceneFile& file, const std::vector<RecordFrame>& rows, const Scan& scan, const Vec3& center,
              const GoalRule& rule) {
  return Finder(file, rows, scan, center, rule).all();
}

}  // namespace tegotae::review
