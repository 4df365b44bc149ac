#include "review/report_plots.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/number_text.hpp"
#include "core/numbers.hpp"
#include "session/run_goal.hpp"
#include "shared/format.hpp"

namespace tegotae::review {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxPoints = 1500;  // of a line: more than pixels
constexpr std::size_t kMaxParts = 5;
constexpr double kMinShown = 1e-4;  // mm: where the logarithm of an intersection is drawn
// A bound farther above the largest value than this goes into the title: drawn, it would flatten the line.
constexpr double kMaxAbove = 4;

json number(double x) {
  return std::isfinite(x) ? json(static_cast<double>(static_cast<float>(x))) : json(nullptr);
}

/// Stretches of the looked-at rows, each shown as one point.
class Buckets {
 public:
  explicit Buckets(const Review& r) : r_(r), rows_(r.scan.rows.size()) {}
  std::size_t size() const { return std::min(rows_, kMaxPoints); }
  double time(std::size_t k) const { return row(begin(k)).t; }
  json times() const {
    json out = json::array();
    for (std::size_t k = 0; k < size(); ++k) out.push_back(number(time(k)));
    return out;
  }
  /// The value of each segment that `better` prefers; NaN where there is none.
  template <typename Value, typename Better>
  json line(const Value& value, const Better& better) const {
    json out = json::array();
    for (std::size_t k = 0; k < size(); ++k) {
      double best = kNan;
      for (std::size_t i = begin(k); i < begin(k + 1); ++i) {
        const double v = value(i);
        if (std::isnan(best) || better(v, best)) best = v;
      }
      out.push_back(number(best));
    }
    return out;
  }
  template <typename Value>
  json most(const Value& value) const {
    return line(value, [](double a, double b) { return a > b; });
  }
  const RecordFrame& row(std::size_t i) const { return r_.recording.frames[r_.scan.rows[i].row]; }

 private:
  std::size_t begin(std::size_t k) const { return k * rows_ / size(); }
  const Review& r_;
  std::size_t rows_;
};

json plot(const std::string& title, const char* y, json series, bool log = false) {
  return {{"title", title},
          {"x", {{"label", "time (s)"}}},
          {"y", {{"label", y}, {"log", log}}},
          {"gaps", true},
          {"series", std::move(series)}};
}

json level(const std::string& name, const json& times, double value) {
  json y = json::array();
  for (std::size_t i = 0; i < times.size(); ++i) y.push_back(number(value));
  return {{"name", name}, {"x", times}, {"y", y}, {"dash", true}};
}

json clearance_plot(const Review& r, const Buckets& buckets, const json& times) {
  json series = json::array();
  for (std::size_t k = 0; k < std::min(kMaxParts, r.findings.clearances.size()); ++k) {
    const std::size_t part = r.findings.clearances[k].part;
    const auto value = [&](std::size_t i) {
      for (const Clearance& c : r.scan.rows[i].clearances)
        if (c.part == part) return std::max(1e3 * c.distance, kMinShown);
      return kNan;
    };
    series.push_back({{"name", r.file.scene.parts[part].name},
                      {"x", times},
                      {"y", buckets.line(value, [](double a, double b) { return a < b; })}});
  }
  if (r.band) {
    series.push_back(level("band, low", times, std::max(1e3 * r.band->band.low, kMinShown)));
    series.push_back(level("band, high", times, 1e3 * r.band->band.high));
  }
  return plot("Clearance", "clearance (mm)", series, true);
}

json way_plot(const Review& r, const Buckets& buckets, const json& times) {
  const Pose& first = r.recording.frames.front().x;
  const RunGoal goal(r.file, r.center);
  const bool toward = r.findings.goal.has_value() && goal.way() > 0;
  const auto along = [&](const Pose& X) {
    return 1e3 * (toward ? goal.depth(X) : displacement(first, X, r.center).dp.norm());
  };
  json series = json::array();
  // The last one is drawn on top.
  series.push_back(
      {{"name", "pen"}, {"x", times}, {"y", buckets.most([&](std::size_t i) { return along(buckets.row(i).y); })}});
  series.push_back(
      {{"name", "part"}, {"x", times}, {"y", buckets.most([&](std::size_t i) { return along(buckets.row(i).x); })}});
  if (toward) series.push_back(level("goal", times, 1e3 * goal.way()));
  return plot(toward ? "Way to the goal" : "Distance from the start", "center of mass (mm)", series);
}

json load_plot(const Review& r, const Buckets& buckets, const json& times, bool torque) {
  const Loads& l = r.findings.loads;
  const double unit = torque ? 1e3 : 1;
  const auto rendered = [&](std::size_t i) {
    const Wrench& w = buckets.row(i).wrench;
    return unit * (torque ? w.torque : w.force).norm();
  };
  const auto asked = [&](std::size_t i) {
    const Wrench w = asked_wrench(buckets.row(i), r.file.scene.coupling, r.center);
    return unit * (torque ? w.torque : w.force).norm();
  };
  json series = json::array();
  series.push_back({{"name", "without limits"}, {"x", times}, {"y", buckets.most(asked)}});
  series.push_back({{"name", "rendered"}, {"x", times}, {"y", buckets.most(rendered)}});
  const double most = torque ? l.asked_torque : l.asked_force, limit = torque ? l.limit_torque : l.limit_force;
  std::string title = torque ? "Torque" : "Force";
  const auto add_limit = [&](const char* name, double value) {
    if (value <= kMaxAbove * most)
      series.push_back(level(name, times, unit * value));
    else
      title += apps::format(", %s %s %s", name, number_text(unit * value, 3).c_str(), torque ? "mN·m" : "N");
  };
  add_limit("peak limit", limit);
  if (!torque && l.continuous > 0) add_limit("continuous", l.continuous);
  return plot(title, torque ? "torque (mN·m)" : "force (N)", series);
}

json depth_plot(const AssemblyForce& f) {
  json series = json::array();
  const auto add = [&](const std::string& name, double DepthForce::*value, bool dash) {
    json x = json::array(), y = json::array();
    bool any = false;
    for (const DepthForce& d : f.over_depth) {
      x.push_back(number(1e3 * d.depth));
      y.push_back(number(d.*value));
      any |= std::isfinite(d.*value);
    }
    if (!any) return;
    series.push_back({{"name", name}, {"x", x}, {"y", y}});
    if (dash) series.back()["dash"] = true;
  };
  if (f.band.high > 0) {
    add(apps::format("mu %.2g", f.band.low), &DepthForce::low, true);
    add(apps::format("mu %.2g", f.band.high), &DepthForce::high, true);
  }
  add("pull-out", &DepthForce::pull_out, false);
  add("seating (final)", &DepthForce::seating, false);
  if (f.rubs) add(std::string("of the ") + way_force_name(f) + ", friction", &DepthForce::friction, false);
  add("insertion, largest", &DepthForce::insertion_peak, false);
  add("insertion", &DepthForce::insertion, false);
  json out = plot("Force of the assembly over depth", "force (N)", std::move(series));
  out["x"]["label"] = "depth (mm)";
  return out;
}

}  // namespace

json report_plots(const Review& r) {
  const Buckets buckets(r);
  const json times = buckets.times();
  json marks = json::array();
  for (const Stall& s : r.findings.stalls) marks.push_back({{"x", s.span.begin}, {"label", "stalls"}});
  json out = json::array({clearance_plot(r, buckets, times), way_plot(r, buckets, times),
                          load_plot(r, buckets, times, false), load_plot(r, buckets, times, true)});
  out[1]["marks"] = marks;
  if (r.assembly.known) out.push_back(depth_plot(r.assembly));
  return out;
}

}  // namespace tegotae::review
