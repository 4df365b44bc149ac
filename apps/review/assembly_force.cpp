#include "review/assembly_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/number_text.hpp"
#include "core/numbers.hpp"
#include "review/review.hpp"
#include "session/run_goal.hpp"
#include "shared/format.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::review {
namespace {

constexpr std::size_t kSegments = 200;  // of the way
// A part that advances by more than this in a tick (m) moves: 0.1 mm/s at 1 kHz.
constexpr double kMoves = 1e-7;
// Share of the greatest depth: a part that rests this close to it is seated.
constexpr double kSeated = 0.01;
// A path shorter than this (m) has no force over depth.
constexpr double kMinWay = 1e-3;
constexpr double kPeriod = 1e-3;  // s, of the contact loop in runs
constexpr std::size_t kTellEvery = 256;

/// The contact forces of a tick and the depth they act at.
struct Tick {
  double t = 0, depth = 0;
  ContactForces forces;
};

/// Sum, count and maximum over the ticks of a segment.
struct Sum {
  double force = 0, friction = 0, most = 0;
  int count = 0;
  void add(double f, double rubs) {
    force += f;
    friction += rubs;
    most = count == 0 ? f : std::max(most, f);
    ++count;
  }
  double mean() const { return count > 0 ? force / count : kNan; }
};

/// Collects the ticks of a run by segment.
struct Profile {
  std::vector<Sum> in = std::vector<Sum>(kSegments), out = in, stands = in;
  ForcePeak insertion, seating, pull_out;
  double deepest = 0, shallowest = kInfinity;

  /// What the way takes, and how far the part came on it.
  const std::vector<Sum>& way(bool pulled) const { return pulled ? out : in; }
  double end(bool pulled) const { return pulled ? shallowest : deepest; }
};

/// How deep the held part is: along a line inwards.
struct DepthAxis {
  Vec3 inwards;       // of length one
  double offset = 0;  // of the depth, m
  double depth(const Pose& X, const Vec3& center) const { return inwards.dot(X * center) + offset; }
};

void take_peak(const Tick& tick, double force, const Scene& scene, ForcePeak& peak) {
  if (!(force > peak.force)) return;
  peak = {force, tick.depth, tick.t, Vec3::Zero(), ""};
  double most = -1;
  for (int i = 0; i < tick.forces.count; ++i) {
    const ContactForce& c = tick.forces.items[static_cast<std::size_t>(i)];
    if (c.force <= most || c.part.index >= scene.parts.size()) continue;
    most = c.force;
    peak.place_W = c.point;
    peak.part = scene.parts[c.part.index].name;
  }
}

Profile profile(const std::vector<Tick>& ticks, const Vec3& direction, double way, const Scene& scene) {
  Profile p;
  for (const Tick& tick : ticks) {
    p.deepest = std::max(p.deepest, tick.depth);
    p.shallowest = std::min(p.shallowest, tick.depth);
  }
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const Tick& tick = ticks[i];
    const double moved = tick.depth - ticks[i - 1].depth;
    Vec3 sum = Vec3::Zero(), rubs = Vec3::Zero();
    for (int k = 0; k < tick.forces.count; ++k) {
      const ContactForce& c = tick.forces.items[static_cast<std::size_t>(k)];
      sum += c.force * c.n + c.friction;
      rubs += c.friction;
    }
    const double against = -sum.dot(direction), friction = -rubs.dot(direction);
    const double share = std::clamp(tick.depth / way, 0.0, 1.0);
    const auto stretch = std::min(static_cast<std::size_t>(share * kSegments), kSegments - 1);
    if (moved > kMoves) {
      p.in[stretch].add(against, friction);
      take_peak(tick, against, scene, p.insertion);
    } else if (moved < -kMoves) {
      p.out[stretch].add(-against, -friction);
      take_peak(tick, -against, scene, p.pull_out);
    } else if (tick.depth > (1 - kSeated) * p.deepest) {
      p.stands[stretch].add(against, friction);
      take_peak(tick, against, scene, p.seating);
    }
  }
  return p;
}

double mean_of(const std::vector<Sum>& stretches) {
  double sum = 0;
  int count = 0;
  for (const Sum& s : stretches) {
    if (s.count == 0) continue;
    sum += s.mean();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// Depth is along the way to the goal, or to where the part came farthest.
Vec3 direction_of(const Review& r) {
  const Vec3 from = r.recording.frames.front().x * r.center;
  const Pose goal = r.file.script.pose(r.file.script.end());
  Vec3 way = RunGoal(r.file, r.center).way() > kMinWay ? Vec3(goal * r.center - from) : Vec3::Zero();
  if (way.norm() > kMinWay) return way.normalized();
  for (const RecordFrame& row : r.recording.frames) {
    const Vec3 gone = row.x * r.center - from;
    if (gone.norm() > way.norm()) way = gone;
  }
  return way.norm() > kMinWay ? Vec3(way.normalized()) : Vec3::Zero();
}

/// Depth is 0 where the way begins; of a way out where the part came farthest out.
DepthAxis axis_of(const Review& r, const Vec3& direction, bool pulled) {
  DepthAxis axis{pulled ? Vec3(-direction) : direction};
  const auto& rows = r.recording.frames;
  if (!pulled) {
    axis.offset = -axis.depth(rows.front().x, r.center);
    return axis;
  }
  double least = kInfinity;
  for (const RecordFrame& row : rows) least = std::min(least, axis.depth(row.x, r.center));
  axis.offset = -least;
  return axis;
}

/// The last row of each tick.
std::vector<Tick> recorded(const Review& r, const DepthAxis& axis) {
  const auto& rows = r.recording.frames;
  std::vector<Tick> out;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (i + 1 == rows.size() || rows[i + 1].tick != rows[i].tick)
      out.push_back({rows[i].t, axis.depth(rows[i].x, r.center), rows[i].forces});
  return out;
}

/// The pen of the recording, with another coefficient of friction.
std::vector<Tick> rerun(const Review& r, const DepthAxis& axis, double mu, const Progress& progress) {
  const auto& rows = r.recording.frames;
  Scene scene = r.file.scene;
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  scene.friction = {mu, {}};
  HapticLoop loop(scene);
  std::vector<Tick> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (progress && i % kTellEvery == 0) progress("with other friction, row", i, rows.size());
    if (i > 0 && rows[i].tick == rows[i - 1].tick) continue;
    const TickReport& report = loop.step(rows[i].y, kPeriod);
    out.push_back({rows[i].t, axis.depth(report.proxy.X, r.center), report.forces});
  }
  return out;
}

/// The forces by depth, and what of the way's work is friction.
void fill_depths(const Profile& nominal, const Profile& low, const Profile& high, AssemblyForce& out) {
  double work = 0, rubbed = 0;
  for (std::size_t k = 0; k < kSegments; ++k) {
    const Sum &in = nominal.in[k], &way = nominal.way(out.pulled)[k];
    DepthForce d;
    d.depth = (static_cast<double>(k) + 0.5) / kSegments * out.way;
    d.insertion = in.mean();
    d.insertion_peak = in.count > 0 ? in.most : kNan;
    d.friction = way.count > 0 ? way.friction / way.count : kNan;
    d.seating = nominal.stands[k].mean();
    d.pull_out = nominal.out[k].mean();
    d.pull_out_peak = nominal.out[k].count > 0 ? nominal.out[k].most : kNan;
    d.low = low.way(out.pulled)[k].mean();
    d.high = high.way(out.pulled)[k].mean();
    out.over_depth.push_back(d);
    if (way.count == 0) continue;
    work += way.mean();
    rubbed += d.friction;
  }
  out.friction_share = work > 0 ? rubbed / work : 0;
}

}  // namespace

AssemblyForce assembly_force(const Review& r, const ForceBand& band, bool pulled, const Progress& progress) {
  AssemblyForce out;
  out.pulled = pulled;
  const Vec3 direction = direction_of(r);
  if (direction.isZero()) return out;
  const DepthAxis axis = axis_of(r, direction, pulled);
  const std::vector<Tick> ticks = recorded(r, axis);
  for (const Tick& tick : ticks) {
    out.way = std::max(out.way, tick.depth);
    out.known |= tick.forces.count > 0;
    for (int i = 0; i < tick.forces.count; ++i) out.rubs |= tick.forces.items[static_cast<std::size_t>(i)].mu > 0;
  }
  out.known &= out.way > kMinWay;
  if (!out.known) return out;
  const Profile nominal = profile(ticks, axis.inwards, out.way, r.file.scene);
  Profile low, high;
  if (band.high > 0) {
    out.band = band;
    low = profile(rerun(r, axis, band.low, progress), axis.inwards, out.way, r.file.scene);
    high = profile(rerun(r, axis, band.high, progress), axis.inwards, out.way, r.file.scene);
    out.low_mean = mean_of(low.way(pulled));
    out.high_mean = mean_of(high.way(pulled));
    out.low_depth = low.end(pulled);
    out.high_depth = high.end(pulled);
  }
  out.insertion = nominal.insertion;
  out.seating = nominal.seating;
  out.pull_out = nominal.pull_out;
  out.insertion_mean = mean_of(nominal.in);
  out.pull_out_mean = mean_of(nominal.out);
  fill_depths(nominal, low, high, out);
  return out;
}

std::vector<std::string> assembly_force_text(const AssemblyForce& f) {
  using apps::format;
  std::vector<std::string> out;
  if (!f.known) return out;
  const auto newtons = [](double force) { return fixed_text(force, 2) + " N"; };
  const auto mm = [](double depth) { return fixed_text(1e3 * depth, 2); };
  const auto peak = [&](const std::string& what, const ForcePeak& p) {
    return what + ": at most " + newtons(p.force) + " at " + mm(p.depth) + " mm" +
           (p.part.empty() ? "" : ", against " + p.part);
  };
  const auto mean = [&](double force, bool of_way) {
    return "; " + newtons(force) + " in the mean over the way" +
           (of_way && f.rubs ? format(", %.0f %% of it friction", 100 * f.friction_share) : std::string());
  };
  out.push_back(f.insertion.force > 0 ? peak("insertion", f.insertion) + mean(f.insertion_mean, !f.pulled)
                                      : "insertion: no force seen");
  out.push_back(f.seating.force > 0 ? peak("seating (final)", f.seating) : "seating (final): no force seen");
  out.push_back(f.pull_out.force > 0 ? peak("pull-out", f.pull_out) + mean(f.pull_out_mean, f.pulled)
                                     : "pull-out: no force seen");
  if (f.band.high > 0)
    out.push_back(way_force_name(f) + format(" with friction of %.2g to %.2g: ", f.band.low, f.band.high) +
                  fixed_text(f.low_mean, 2) + " to " + newtons(f.high_mean) + " in the mean, to " + mm(f.low_depth) +
                  " and " + mm(f.high_depth) + " mm");
  return out;
}

std::string assembly_force_csv(const AssemblyForce& force) {
  std::string text =
      "depth_mm,insertion_n,insertion_peak_n,friction_n,seating_n,pull_out_n,pull_out_peak_n,low_n,high_n\n";
  // Plus zero, so that there is no "-0".
  const auto number = [](double x) { return std::isfinite(x) ? apps::format("%.6g", x + 0.0) : std::string(); };
  for (const DepthForce& d : force.over_depth) {
    text += number(1e3 * d.depth);
    for (const double x :
         {d.insertion, d.insertion_peak, d.friction, d.seating, d.pull_out, d.pull_out_peak, d.low, d.high})
      text += "," + number(x);
    text += "\n";
  }
  return text;
}

}  // namespace tegotae::review
