#include "tries/try_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "core/output_file.hpp"
#include "loop/scene_parts.hpp"
#include "shared/format.hpp"
#include "web/page.hpp"

namespace tegotae::tries {
namespace {

using apps::format;
using Json = nlohmann::ordered_json;

struct Count {
  int tries = 0, reached = 0;
};

template <typename Key>
std::map<std::string, Count> counted(const std::vector<Result>& results, const Key& key) {
  std::map<std::string, Count> out;
  for (const Result& r : results) {
    Count& c = out[key(r)];
    ++c.tries;
    c.reached += r.reached ? 1 : 0;
  }
  return out;
}

int reached(const std::vector<Result>& results) {
  return static_cast<int>(std::count_if(results.begin(), results.end(), [](const Result& r) { return r.reached; }));
}

std::vector<double> times(const std::vector<Result>& results) {
  std::vector<double> out;
  for (const Result& r : results)
    if (r.reached) out.push_back(r.time);
  std::sort(out.begin(), out.end());
  return out;
}

/// Of an ascending list that is not empty.
double median(const std::vector<double>& v) {
  return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]);
}

std::map<std::string, int> blockers(const std::vector<Result>& results) {
  std::map<std::string, int> out;
  for (const Result& r : results)
    if (!r.reached) ++out[r.blocked_by];
  return out;
}

std::string blocker_name(const std::string& part) {
  return part.empty() ? "nothing at the end" : part;
}

/// The share of successes that a result like this speaks for with 95 % (Wilson's interval).
std::pair<double, double> interval(int successes, std::size_t n) {
  constexpr double z = 1.959964;
  const double p = successes / static_cast<double>(n), nn = static_cast<double>(n);
  const double middle = (p + z * z / (2 * nn)) / (1 + z * z / nn);
  const double half = z / (1 + z * z / nn) * std::sqrt(p * (1 - p) / nn + z * z / (4 * nn * nn));
  return {middle - half, middle + half};
}

Json pose(const Pose& X) {
  return {X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z()};
}

Json groups(const std::map<std::string, Count>& counts) {
  Json out = Json::object();
  for (const auto& [name, c] : counts) out[name] = {{"tries", c.tries}, {"reached", c.reached}};
  return out;
}

Json summary(const Task& task, const std::vector<Result>& results) {
  Json j;
  j["scene"] = task.file.path;
  j["held"] = held_part(task.file.scene).name;
  j["goal"] = pose(task.file.script.pose(task.file.script.end()));
  j["seed"] = task.seed;
  j["seconds"] = task.seconds;
  j["tries"] = results.size();
  j["reached"] = reached(results);
  if (!results.empty()) {
    const auto [low, high] = interval(reached(results), results.size());
    j["share_95"] = {low, high};
  }
  const std::vector<double> t = times(results);
  if (!t.empty()) j["time_s"] = {{"least", t.front()}, {"median", median(t)}, {"most", t.back()}};
  j["by_operator"] = groups(counted(results, [](const Result& r) { return r.who; }));
  j["by_route"] = groups(counted(results, [](const Result& r) { return r.route; }));
  j["blocked_by"] = Json::object();
  for (const auto& [part, n] : blockers(results)) j["blocked_by"][part] = n;
  if (const Result* best = best_try(results))
    j["best"] = {{"try", best->number}, {"reached", best->reached}, {"time_s", best->time}, {"force_n", best->force}};
  return j;
}

Json group_table(const char* what, const std::map<std::string, Count>& counts) {
  Json t = {{"head", {what, "tries", "reached"}}, {"rows", Json::array()}};
  for (const auto& [name, c] : counts) t["rows"].push_back({name, c.tries, c.reached});
  return t;
}

Json tries_table(const std::vector<Result>& results) {
  Json t = {{"head",
             {"try", "operator", "route", "off (mm)", "tilt (°)", "result", "time (s)", "way (mm)", "force (N)",
              "wiggled (s)", "blocked by", "at (mm)"}},
            {"rows", Json::array()}};
  for (const Result& r : results) {
    const Vec3 p = 1e3 * r.place_W;
    t["rows"].push_back({std::to_string(r.number),
                         r.who,
                         r.route,
                         format("%.2f", 1e3 * r.offset),
                         format("%.1f", r.tilt * 57.29577951),
                         {{"text", r.reached ? "reached" : "not reached"}, {"class", r.reached ? "holds" : "fails"}},
                         format("%.2f", r.time),
                         format("%.2f", 1e3 * r.depth),
                         format("%.2f", r.force),
                         format("%.2f", r.stuck),
                         r.reached ? "–" : blocker_name(r.blocked_by),
                         r.reached || r.blocked_by.empty() ? "–" : format("%.2f, %.2f, %.2f", p.x(), p.y(), p.z())});
  }
  return t;
}

Json blocker_table(const std::vector<Result>& results) {
  Json t = {{"head", {"blocked by", "tries"}}, {"rows", Json::array()}};
  for (const auto& [part, n] : blockers(results)) t["rows"].push_back({blocker_name(part), n});
  return t;
}

template <typename Value>
Json plot(const std::string& title, const char* label, const std::vector<Result>& results, bool reached_only,
          const Value& value) {
  std::map<std::string, std::pair<Json, Json>> lines;
  for (const Result& r : results) {
    if (reached_only && !r.reached) continue;
    auto& [x, y] = lines[r.who];
    x.push_back(r.number);
    y.push_back(value(r));
  }
  Json series = Json::array();
  for (const auto& [name, line] : lines)
    series.push_back({{"name", name}, {"x", line.first}, {"y", line.second}, {"points", true}});
  return {{"title", title}, {"x", {{"label", "try"}}}, {"y", {{"label", label}}}, {"series", series}};
}

std::string headline(const std::vector<Result>& results) {
  const int n = reached(results);
  std::string text = format("%d of %zu tries reached the goal", n, results.size());
  if (!results.empty()) {
    const auto [low, high] = interval(n, results.size());
    text += format(" (95 %%: %.0f to %.0f %%)", 100 * low, 100 * high);
  }
  const std::vector<double> t = times(results);
  if (!t.empty()) text += format(", in %.2f to %.2f s, median %.2f s", t.front(), t.back(), median(t));
  return text + ".";
}

Json report(const Task& task, const std::vector<Result>& results) {
  Json sections = Json::array();
  Json groups = {{"title", "Who and which way"}, {"text", ""}, {"plots", Json::array()}, {"tables", Json::array()}};
  groups["tables"].push_back(group_table("operator", counted(results, [](const Result& r) { return r.who; })));
  groups["tables"].push_back(group_table("route", counted(results, [](const Result& r) { return r.route; })));
  if (!blockers(results).empty()) groups["tables"].push_back(blocker_table(results));
  if (!times(results).empty())
    groups["plots"].push_back(
        plot("Time to the goal", "time (s)", results, true, [](const Result& r) { return r.time; }));
  groups["plots"].push_back(
      plot("Largest force", "force (N)", results, false, [](const Result& r) { return r.force; }));
  sections.push_back(groups);
  sections.push_back({{"title", "Tries"}, {"text", ""}, {"tables", {tries_table(results)}}});
  const std::string held = held_part(task.file.scene).name;
  return {
      {"title", "Tries with " + held},
      {"subtitle", std::filesystem::path(task.file.path).filename().string() +
                       format(", seed %llu, %g s each", static_cast<unsigned long long>(task.seed), task.seconds)},
      {"intro", headline(results) +
                    "\nEach try is a modeled operator at a simulated pen, led astray and tilted at random; what is "
                    "in the way when the time is over is who was touched most in the last half second. The best try "
                    "is in best.csv, for tegotae review."},
      {"sections", sections}};
}

}  // namespace

const Result* best_try(const std::vector<Result>& results) {
  const auto better = [](const Result& a, const Result& b) {
    if (a.reached != b.reached) return a.reached;
    return a.reached ? a.time < b.time : a.depth > b.depth;
  };
  const auto best = std::min_element(results.begin(), results.end(), better);
  return best == results.end() ? nullptr : &*best;
}

std::string summary_text(const std::vector<Result>& results) {
  std::string text = headline(results) + "\n";
  for (const auto& [part, n] : blockers(results))
    text += format("  blocked %d times by ", n) + blocker_name(part) + "\n";
  return text;
}

void write_report(const Task& task, const std::vector<Result>& results, const std::string& folder) {
  // Names come from files and may not be UTF-8.
  write_file(folder + "/summary.json",
             summary(task, results).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_file(folder + "/report.html", apps::report_page(report(task, results)));
}

}  // namespace tegotae::tries
