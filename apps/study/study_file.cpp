#include "study/study_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/numbers.hpp"
#include "scene_file/toml_table.hpp"
#include "shared/pose_option.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/operator/operator.hpp"

namespace tegotae::study {
namespace {

constexpr double kMaxCases = 1e7, kMaxSeconds = 3600, kMaxMu = 10;

std::int64_t whole(const TomlTable& t, const char* key, double fallback, double least, double most) {
  const double value = t.number(key, fallback);
  if (value != std::floor(value) || value < least || value > most) {
    char range[80];
    std::snprintf(range, sizeof range, "must be a whole number from %.0f to %.0f", least, most);
    t.fail(key, range);
  }
  return static_cast<std::int64_t>(value);
}

/// What a number may be, in the file's unit, and what that unit is in the study's.
struct Range {
  double least, most, unit;
};

/// Numbers under `key`: a list, or { uniform = [low, high] }, or { tolerance = [low, high] }.
Axis read_axis(const TomlTable& t, const char* key, const std::string& name, const Range& range) {
  Axis axis;
  axis.name = name;
  const auto check = [&](double x) {
    if (x >= range.least && x <= range.most) return range.unit * x;
    t.fail(key, digits(x) + " is not from " + digits(range.least) + " to " + digits(range.most));
  };
  if (!t.is_table(key)) {
    std::set<double> seen;
    for (const double x : t.numbers(key, 1, 1000)) {
      axis.numbers.push_back(check(x));
      if (!seen.insert(x).second) t.fail(key, digits(x) + " is in it twice");
    }
    return axis;
  }
  const TomlTable drawn = t.table(key, {"uniform", "tolerance"});
  if (drawn.has("uniform") == drawn.has("tolerance"))
    t.fail(key, "give either uniform = [LOW, HIGH] or tolerance = [LOW, HIGH], or a list of numbers");
  const char* kind = drawn.has("uniform") ? "uniform" : "tolerance";
  axis.draw = drawn.has("uniform") ? Axis::Draw::uniform : Axis::Draw::tolerance;
  const std::vector<double> bounds = drawn.numbers(kind, 2);
  if (!(bounds[0] < bounds[1])) drawn.fail(kind, "the first number must be less than the second");
  axis.low = check(bounds[0]);
  axis.high = check(bounds[1]);
  return axis;
}

std::vector<std::string> names(const TomlTable& t, const char* key) {
  std::vector<std::string> out = t.texts(key);
  if (out.empty()) t.fail(key, "must be a list of at least one name");
  std::set<std::string> seen;
  for (const std::string& name : out)
    if (!seen.insert(name).second) t.fail(key, name + " is in it twice");
  return out;
}

Axis read_operators(const TomlTable& t) {
  Axis axis;
  axis.name = "operator";
  axis.texts = names(t, "operator");
  for (const std::string& name : axis.texts) {
    try {
      operator_profile(name);
    } catch (const Error& e) {
      t.fail("operator", e.what());
    }
  }
  return axis;
}

void read_orders(const TomlTable& t, const TomlTable& top, Study& study) {
  Axis axis;
  axis.name = "order";
  for (const TomlTable& order : t.tables("order", {"parts"})) {
    study.orders.push_back(names(order, "parts"));
    std::string text;
    for (const std::string& part : study.orders.back()) text += (text.empty() ? "" : ", ") + part;
    if (std::find(study.orders.begin(), study.orders.end() - 1, study.orders.back()) != study.orders.end() - 1)
      order.fail("parts", "another order has the same");
    axis.texts.push_back(text);
  }
  if (axis.texts.empty()) return;
  if (study.goal != "out") top.fail("goal", "must be \"out\" where there are orders: their parts go out one by one");
  if (!study.hold.empty()) top.fail("hold", "an order says which parts are held");
  study.axes.push_back(axis);
}

void read_parameters(const TomlTable& top, Study& study) {
  const TomlTable t = top.table("parameters", {"operator", "offset", "tilt_deg", "mu", "inward", "order"});
  read_orders(t, top, study);
  if (t.has("operator")) study.axes.push_back(read_operators(t));
  if (t.has("mu")) study.axes.push_back(read_axis(t, "mu", "mu", {0, kMaxMu, 1}));
  if (t.has("offset")) study.axes.push_back(read_axis(t, "offset", "offset", {0, 0.1, 1}));
  if (t.has("tilt_deg")) study.axes.push_back(read_axis(t, "tilt_deg", "tilt", {0, 45, kDegree}));
  std::set<std::string> parts;
  for (const TomlTable& part : t.tables("inward", {"part", "by"})) {
    const std::string name = part.text("part");
    if (!parts.insert(name).second) part.fail("part", name + " has a table already");
    if (!part.has("by")) part.fail("by", "missing");
    study.axes.push_back(read_axis(part, "by", "inward " + name, {-1e-2, 1e-2, 1}));
  }
}

}  // namespace

Study read_study(const std::string& path) {
  const toml::table parsed = parse_toml(read_file(path), path);
  const TomlTable top(parsed, path, "", {"scenes", "hold", "goal", "seconds", "seed", "repeats", "parameters"});
  Study study;
  study.path = path;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  Axis scenes;
  scenes.name = "scene";
  scenes.texts = names(top, "scenes");
  for (const std::string& scene : scenes.texts) {
    study.scenes.push_back((folder / scene).string());
    if (!std::filesystem::exists(study.scenes.back())) top.fail("scenes", study.scenes.back() + ": no such file");
  }
  study.axes.push_back(scenes);
  study.hold = top.text("hold", "");
  study.goal = top.text("goal", "");
  const std::string wrong = study.goal.empty() ? "" : apps::goal_error(study.goal);
  if (!wrong.empty()) top.fail("goal", wrong);
  study.seconds = top.positive("seconds", study.seconds);
  if (study.seconds > kMaxSeconds) top.fail("seconds", "must be at most 3600");
  study.seed = static_cast<std::uint64_t>(whole(top, "seed", 1, 0, 9007199254740992.0));
  study.repeats = static_cast<int>(whole(top, "repeats", 1, 1, kMaxCases));
  read_parameters(top, study);
  double cases = study.repeats;
  for (const Axis& axis : study.axes) cases *= static_cast<double>(axis.size());
  if (cases > kMaxCases) top.fail("repeats", "makes more than ten million cases, with all that the parameters list");
  return study;
}

}  // namespace tegotae::study
