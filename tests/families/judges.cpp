#include "families/judges.hpp"

#include <cstdio>

#include "families/touch_line.hpp"

namespace tegotae::test {
namespace {

// The documents promise that half of l_min is kept, and that l_min is 4 to 20 um.
constexpr double kMaxKept = 10e-6, kMaxContactGap = 20e-6;
// FCL's line ends this near (m); the loop's poses are rounded by less than this share of the size.
constexpr double kNear = 1e-6, kRounding = 1e-9;
// A lag wants a contact above 0.3 mm for a part of 0.3 m, and never below what contacts may stand off.
constexpr double kLagShare = 1e-3, kMinLag = 30e-6;
constexpr int kMaxUnexplained = 20, kMaxOff = 50;  // ticks
constexpr double kForceShare = 1.0 / 3;

std::string text(const char* format, double a) {
  char out[64];
  std::snprintf(out, sizeof out, format, a);
  return out;
}

}  // namespace

Truth find_truth(const FamilyCase& c, const TouchLine& line) {
  Truth t;
  const Pose from = {c.seat.q, c.seat.p - c.start * c.approach};
  const double most = c.start + c.press;
  if (c.touch)
    t.touch = *c.touch;
  else if (c.guided)
    t.touch = line.travel_bisected(from, c.approach, most, kNear) - c.start;
  else
    t.touch = line.travel(from, c.approach, most, kNear) - c.start;
  t.slack = c.gain * (2 * kMaxKept + kNear);
  t.margin = c.gain * (kMaxContactGap + kNear);
  t.follows = kRounding * std::max(1.0, c.parameters.size);
  t.lag = std::max(kLagShare * c.parameters.size, kMinLag);
  return t;
}

Judges::Judges(const FamilyCase& c, const CaseOptions& options, const Truth& truth)
    : case_(c), options_(options), truth_(truth), stiffness_(c.scene.coupling.stiffness) {}

void Judges::look(const CaseTick& tick) {
  const bool free = tick.pen < truth_.touch - truth_.margin;
  if (tick.phase == Phase::approach && free) worst_free_ = std::max(worst_free_, tick.off);
  if (tick.phase == Phase::rest && tick.last) rest_ = tick.part;
  look_at_force(tick);
  // A contact farther off than that explains nothing.
  const bool explained = tick.contacts > 0 && tick.gap <= truth_.lag;
  if (tick.off > truth_.lag && !explained) {
    most_unexplained_ = std::max(most_unexplained_, ++unexplained_);
    unexplained_off_ = std::max(unexplained_off_, tick.off);
  } else {
    unexplained_ = 0;
  }
  if (tick.phase != Phase::lift && tick.phase != Phase::away) return;
  // In real time a tick that the machine interrupts makes the part lag for as long.
  const bool follows = tick.off <= (options_.real_time ? truth_.lag : truth_.follows);
  if (free) ++off_after_;
  if (!follows && !options_.real_time) came_off_ = -1;
  if (free && follows && came_off_ < 0) came_off_ = off_after_;
  away_ = tick.off;
  follows_ = follows;
}

double Judges::least_force() const {
  return kForceShare * stiffness_ * (case_.press - std::max(truth_.touch, case_.deepest()));
}

void Judges::look_at_force(const CaseTick& tick) {
  const double wanted = least_force();
  if (tick.phase == Phase::rest && tick.last) rest_force_ = tick.force;
  if (tick.phase == Phase::settle && tick.last) settle_force_ = tick.force;
  if (!case_.flat || (tick.phase != Phase::slide && tick.phase != Phase::settle)) return;
  without_force_ = tick.force < wanted ? without_force_ + 1 : 0;
  most_without_force_ = std::max(most_without_force_, without_force_);
}

void Judges::judge_rest(std::vector<Finding>& out) const {
  const double least = truth_.touch - truth_.slack;
  if (!(rest_ >= least))
    out.push_back({"rests short of where FCL finds touching by", text("%.4f mm", 1e3 * (truth_.touch - rest_)),
                   text("at most %.4f mm", 1e3 * truth_.slack)});
  if (!case_.rest) return;
  const double slack = truth_.slack + 4 * case_.sagitta;
  if (!(rest_ >= case_.rest->low - slack && rest_ <= case_.rest->high + slack))
    out.push_back({"rests beyond its seat by", text("%.4f mm", 1e3 * rest_),
                   text("%.4f", 1e3 * case_.rest->low) + text(" to %.4f mm", 1e3 * case_.rest->high) +
                       text(" within %.4f mm", 1e3 * slack)});
}

void Judges::judge_force(std::vector<Finding>& out) const {
  const double wanted = least_force();
  const std::string expected = text("at least %.3f N", wanted);
  if (!(rest_force_ >= wanted)) out.push_back({"force at rest", text("%.3f N", rest_force_), expected});
  if (!(settle_force_ >= wanted))
    out.push_back({"force after sliding and turning", text("%.3f N", settle_force_), expected});
  const int most = options_.real_time ? kMaxUnexplained : 0;
  if (most_without_force_ > most)
    out.push_back({"sliding on a plane seat with less than " + text("%.3f N", wanted),
                   text("%.0f ticks in a row", most_without_force_), text("at most %.0f", most)});
}

std::vector<Finding> Judges::findings(double way) const {
  std::vector<Finding> out;
  if (!options_.real_time && worst_free_ > truth_.follows)
    out.push_back({"off the pen in free space by", text("%.6f mm", 1e3 * worst_free_), "0"});
  judge_rest(out);
  judge_force(out);
  if (most_unexplained_ > kMaxUnexplained)
    out.push_back({"held back without a contact, " + text("up to %.3f mm, for", 1e3 * unexplained_off_),
                   text("%.0f ticks in a row", most_unexplained_), text("at most %.0f", kMaxUnexplained)});
  if (!came_off())
    out.push_back(
        {"lifted, the part does not follow; FCL finds " + text("%.3f mm free on the way, it is off by", 1e3 * way),
         text("%.3f mm", 1e3 * away_), "0"});
  else if (came_off_ > kMaxOff)
    out.push_back({"lifted, the part follows after", text("%.0f ticks", came_off_), text("at most %.0f", kMaxOff)});
  return out;
}

}  // namespace tegotae::test
