#include "study/report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/number_text.hpp"
#include "core/output_file.hpp"
#include "loop/scene_parts.hpp"
#include "review/verdict.hpp"
#include "shared/format.hpp"
#include "study/outcome.hpp"
#include "web/page.hpp"

namespace tegotae::study {
namespace {

using apps::format;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxRows = 10000;  // of a page that is to open; the table has all
constexpr double kDegrees = 57.29577951;

/// The path of `file` from `folder`.
std::string from_folder(const std::string& folder, const std::string& file) {
  namespace fs = std::filesystem;
  return fs::absolute(file).lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal()).string();
}

/// Counts by a text of each case, in the order of the texts.
std::map<std::string, Count> counted(const std::vector<Result>& results,
                                     const std::function<std::string(const Result&)>& key) {
  std::map<std::string, Count> out;
  for (const Result& r : results) {
    Count& c = out[key(r)];
    ++c.cases;
    c.reached += r.reached ? 1 : 0;
  }
  return out;
}

/// What is summed up: the results, and how they are called.
struct Source {
  const Study& study;
  Tasks& tasks;
  const std::vector<Result>& results;
  const std::vector<int>& replays;
  std::string file;  // the study's, from the report's folder: the same however the command spelled either

  bool tries() const { return study.path.empty(); }
  const char* word() const { return word_for(study); }
  std::map<std::string, Count> by_axis(const Axis& axis) const {
    return counted(results, [&](const Result& r) { return make_case(study, r.number).find(axis.name)->text; });
  }
  std::map<std::string, Count> by_operator() const {
    return counted(results, [](const Result& r) { return r.who; });
  }
  std::map<std::string, Count> by_route() const {
    return counted(results, [](const Result& r) { return r.route; });
  }
  std::vector<double> ascending(double Result::*value) const {
    std::vector<double> out;
    for (const Result& r : results) out.push_back(r.*value);
    std::sort(out.begin(), out.end());
    return out;
  }
};

Json pose(const Pose& X) {
  return {X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z()};
}

Json spread(const std::vector<double>& v) {
  return {{"least", v.front()}, {"median", quantile(v, 0.5)}, {"p95", quantile(v, 0.95)}, {"most", v.back()}};
}

Json groups(const std::map<std::string, Count>& counts, const char* word) {
  Json out = Json::object();
  for (const auto& [name, c] : counts) {
    const auto [low, high] = wilson_interval(c.reached, c.cases);
    out[name] = {{word, c.cases}, {"reached", c.reached}, {"share_95", {low, high}}};
  }
  return out;
}

Json what(const Source& s) {
  Json j;
  if (s.tries()) {
    const Task& task = *s.tasks.of(make_case(s.study, 0)).front();
    j["scene"] = task.file.path;
    j["held"] = held_part(task.file.scene).name;
    j["goal"] = pose(task.routes.front().goal);
  } else {
    j["study"] = s.file;
    j["task"] = s.tasks.fingerprint();
  }
  j["seed"] = s.study.seed;
  j["seconds"] = s.study.seconds;
  return j;
}

Json summary(const Source& s) {
  Json j = what(s);
  j[s.word()] = s.results.size();
  j["reached"] = reached(s.results);
  if (!s.results.empty()) {
    const auto [low, high] = wilson_interval(reached(s.results), s.results.size());
    j["share_95"] = {low, high};
  }
  const std::vector<double> t = times(s.results);
  if (!t.empty()) j["time_s"] = {{"least", t.front()}, {"median", quantile(t, 0.5)}, {"most", t.back()}};
  if (!s.results.empty()) {
    j["force_n"] = spread(s.ascending(&Result::force));
    j["clearance_m"] = spread(s.ascending(&Result::clearance));
  }
  j["by_operator"] = groups(s.by_operator(), s.word());
  j["by_route"] = groups(s.by_route(), s.word());
  for (const Axis& axis : s.study.axes)
    if (axis.draw == Axis::Draw::none) j["by_" + axis.name] = groups(s.by_axis(axis), s.word());
  j["blocked_by"] = Json::object();
  for (const auto& [part, n] : blockers(s.results)) j["blocked_by"][part] = n;
  if (const Result* best = best_case(s.results))
    j["best"] = {{s.tries() ? "try" : "case", best->number},
                 {"reached", best->reached},
                 {"time_s", best->time},
                 {"force_n", best->force}};
  return j;
}

Json group_table(const Source& s, const std::string& name, const std::map<std::string, Count>& counts) {
  Json t = {{"head", {name, s.word(), "reached", "share", "95 %"}}, {"rows", Json::array()}};
  for (const auto& [value, c] : counts) {
    const auto [low, high] = wilson_interval(c.reached, c.cases);
    t["rows"].push_back({value, c.cases, c.reached,
                         format("%.1f %%", 100.0 * static_cast<double>(c.reached) / static_cast<double>(c.cases)),
                         format("%.1f to %.1f %%", 100 * low, 100 * high)});
  }
  return t;
}

Json failure_table(const Source& s) {
  Json t = {{"head", {"failed", s.word()}}, {"rows", Json::array()}};
  for (const auto& [why, n] : failures(s.results)) t["rows"].push_back({why, n});
  return t;
}

Json measures_table(const Source& s) {
  Json t = {{"head", {"measure", "least", "median", "95 % below", "most"}}, {"rows", Json::array()}};
  const auto add = [&](const char* name, const std::vector<double>& v, const std::function<std::string(double)>& text) {
    if (!v.empty())
      t["rows"].push_back({name, text(v.front()), text(quantile(v, 0.5)), text(quantile(v, 0.95)), text(v.back())});
  };
  add("largest force", s.ascending(&Result::force), [](double x) { return format("%.2f N", x); });
  add("largest torque", s.ascending(&Result::torque), [](double x) { return format("%.1f mN·m", 1e3 * x); });
  add("least clearance", s.ascending(&Result::clearance), review::length_text);
  add("time to the goal", times(s.results), review::seconds_text);
  return t;
}

Json case_row(const Source& s, const Result& r) {
  const std::string number = std::to_string(r.number);
  const bool shown = !s.tries() && began(r);
  Json row = Json::array();
  row.push_back(shown ? Json({{"text", number}, {"href", replay_page(r.number)}}) : Json(number));
  for (const std::string& parameter : r.parameters) row.push_back(parameter);
  for (const Json& cell :
       {Json(r.who), Json(r.route), Json(format("%.2f", 1e3 * r.offset)), Json(format("%.1f", r.tilt * kDegrees)),
        Json({{"text", r.reached ? "reached" : "not reached"}, {"class", r.reached ? "holds" : "fails"}}),
        Json(format("%.2f", r.time)), Json(fixed_text(1e3 * r.depth, 2)), Json(format("%.2f", r.force)),
        Json(review::length_text(r.clearance)), Json(format("%.2f", r.stuck)), Json(r.reached ? "–" : r.why)})
    row.push_back(cell);
  if (shown)
    row.push_back({{"command", {"tegotae", "study", "case", s.file, number, "--out", "."}}, {"files", {3, 6}}});
  else if (!s.tries())
    row.push_back("–");
  return row;
}

Json cases_table(const Source& s) {
  Json head = {s.tries() ? "try" : "case"};
  for (const std::string& name : parameter_columns(s.study)) head.push_back(name);
  for (const char* name : {"operator", "route", "off (mm)", "tilt (°)", "result", "time (s)", "way (mm)", "force (N)",
                           "clearance", "wiggled (s)", "why not"})
    head.push_back(name);
  if (!s.tries()) head.push_back("makes the replay");
  Json rows = Json::array();
  for (std::size_t i = 0; i < std::min(kMaxRows, s.results.size()); ++i) rows.push_back(case_row(s, s.results[i]));
  return {{"head", head}, {"rows", rows}};
}

/// A point a case, by a name.
Json plot(const std::string& title, const std::string& x_label, const char* y_label, const std::vector<Result>& results,
          const std::function<std::string(const Result&)>& name, const std::function<double(const Result&)>& x,
          double Result::*y) {
  std::map<std::string, std::pair<Json, Json>> lines;
  for (const Result& r : results) {
    auto& [xs, ys] = lines[name(r)];
    xs.push_back(x(r));
    ys.push_back(r.*y);
  }
  Json series = Json::array();
  for (const auto& [label, line] : lines)
    series.push_back({{"name", label}, {"x", line.first}, {"y", line.second}, {"points", true}});
  return {{"title", title}, {"x", {{"label", x_label}}}, {"y", {{"label", y_label}}}, {"series", series}};
}

Json plots(const Source& s) {
  Json out = Json::array();
  const auto number = [](const Result& r) { return static_cast<double>(r.number); };
  const auto who = [](const Result& r) { return r.who; };
  std::vector<Result> there;
  for (const Result& r : s.results)
    if (r.reached) there.push_back(r);
  const std::string one = s.tries() ? "try" : "case";
  if (!there.empty()) out.push_back(plot("Time to the goal", one, "time (s)", there, who, number, &Result::time));
  out.push_back(plot("Largest force", one, "force (N)", s.results, who, number, &Result::force));
  for (const Axis& axis : s.study.axes) {
    if (axis.draw == Axis::Draw::none) continue;
    std::vector<Result> sorted = s.results;
    const auto value = [&](const Result& r) { return make_case(s.study, r.number).find(axis.name)->number; };
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](const Result& a, const Result& b) { return value(a) < value(b); });
    const std::string label = axis.column().empty() ? axis.name : axis.column();
    out.push_back(plot(
        "Largest force by " + axis.name, label, "force (N)", sorted,
        [](const Result& r) { return r.reached ? "reached" : "not reached"; }, value, &Result::force));
  }
  return out;
}

/// Over the table of cases.
std::string cases_text(const Source& s) {
  std::string text = s.results.size() > kMaxRows ? format("The first %zu; cases.csv has all. ", kMaxRows) : "";
  if (s.tries()) return text;
  std::string list;
  for (const int number : s.replays) list += (list.empty() ? "" : ", ") + std::to_string(number);
  if (!list.empty()) text += "The replays of " + list + " are there. ";
  return text +
         "The link of a case leads to its replay once the command in its last column was run, in this report's "
         "folder where it names no other: it makes the case again and records it, for tegotae replay and "
         "review too.";
}

Json report(const Source& s) {
  Json tables = Json::array();
  for (const Axis& axis : s.study.axes)
    if (axis.draw == Axis::Draw::none && axis.name != "operator")
      tables.push_back(group_table(s, axis.name, s.by_axis(axis)));
  tables.push_back(group_table(s, "operator", s.by_operator()));
  tables.push_back(group_table(s, "route", s.by_route()));
  if (!failures(s.results).empty()) tables.push_back(failure_table(s));
  const std::string name = std::filesystem::path(s.tries() ? s.study.scenes.front() : s.study.path).filename().string();
  return {{"title",
           s.tries() ? "Tries with " + held_part(s.tasks.file(make_case(s.study, 0)).scene).name : "Study " + name},
          {"subtitle", name + format(", seed %llu, %s s each", static_cast<unsigned long long>(s.study.seed),
                                     number_text(s.study.seconds, 6).c_str())},
          {"intro", headline(s.results, s.word()) +
                        "\nEach one is a modeled operator at a simulated pen, led astray and tilted at random; what is "
                        "in the way when the time is over is who was touched most in the last half second. " +
                        (s.tries() ? "The best try is in best.csv, for tegotae review."
                                   : "The number of a case is a link to its replay.")},
          {"sections",
           {{{"title", "Success"},
             {"text", "With the interval that holds the true share with 95 % (Wilson)."},
             {"plots", plots(s)},
             {"tables", tables}},
            {{"title", "Forces and clearances"}, {"text", ""}, {"tables", {measures_table(s)}}},
            {{"title", s.tries() ? "Tries" : "Cases"}, {"text", cases_text(s)}, {"tables", {cases_table(s)}}}}}};
}

}  // namespace

const char* word_for(const Study& study) {
  return study.path.empty() ? "tries" : "cases";
}

std::string case_folder(int number) {
  return "case-" + std::to_string(number);
}

std::string replay_page(int number) {
  return case_folder(number) + "/replay.html";
}

void write_report(const Study& study, Tasks& tasks, const std::vector<Result>& results, const std::vector<int>& replays,
                  const std::string& folder) {
  const std::string file = study.path.empty() ? "" : from_folder(folder, study.path);
  const Source source{study, tasks, results, replays, file};
  // Names come from files and may not be UTF-8.
  write_file(folder + "/summary.json", summary(source).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_file(folder + "/report.html", apps::report_page(report(source)));
}

}  // namespace tegotae::study
