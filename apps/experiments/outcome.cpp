#include "experiments/outcome.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "core/output_file.hpp"
#include "shared/csv_cell.hpp"
#include "tegotae/core/error.hpp"
#include "web/page.hpp"

namespace tegotae::experiments {
namespace {

using Json = nlohmann::json;

constexpr int kPlotDigits = 6;  // more than a screen shows

std::string short_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(std::isfinite(v) ? Json(rounded(v, kPlotDigits)) : Json(nullptr));
  return out;
}

Json to_json(const Axis& a) {
  return {{"label", a.label}, {"log", a.log}, {"whole", a.whole}, {"percent", a.percent}};
}

Json to_json(const Plot& p) {
  Json j = {{"title", p.title}, {"x", to_json(p.x)}, {"y", to_json(p.y)}, {"kind", p.trace ? "trace" : "time"}};
  j["series"] = Json::array();
  for (const Series& s : p.series) {
    Json one = {{"name", s.name}, {"x", numbers(s.x)}, {"y", numbers(s.y)}};
    if (!s.low.empty()) one["low"] = numbers(s.low);
    if (!s.high.empty()) one["high"] = numbers(s.high);
    if (s.points) one["points"] = true;
    if (s.dash) one["dash"] = true;
    j["series"].push_back(one);
  }
  for (const Mark& m : p.marks) j["marks"].push_back({{"x", m.x}, {"label", m.label}});
  return j;
}

Json cell(const Json& value) {
  return value.is_number_float() ? Json(rounded(value.get<double>(), 4)) : value;
}

Json to_json(const Table& t) {
  Json j = {{"caption", t.caption}, {"head", t.head}, {"rows", Json::array()}};
  for (const auto& row : t.rows) {
    Json cells = Json::array();
    for (const Json& value : row) cells.push_back(cell(value));
    j["rows"].push_back(cells);
  }
  return j;
}

Json to_json(const std::vector<Claim>& claims) {
  Json j = Json::array();
  for (const Claim& c : claims) {
    const Json value = std::isfinite(c.value) ? Json(c.value) : Json(nullptr);
    j.push_back({{"name", c.name}, {"value", value}, {"target", c.target}, {"unit", c.unit}, {"holds", c.holds}});
  }
  return j;
}

std::string csv_text(const Csv& csv) {
  std::string text;
  const auto line = [&](const auto& cells, const auto& word) {
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + word(cells[i]);
    text += "\n";
  };
  line(csv.head, apps::csv_cell);
  for (const auto& row : csv.rows)
    line(row, [](const Json& v) {
      return v.is_string()         ? apps::csv_cell(v.get<std::string>())
             : v.is_number_float() ? short_text(v.get<double>())
                                   : v.dump();
    });
  return text;
}

}  // namespace

Claim at_most(const std::string& name, double value, double limit, const std::string& unit) {
  return {name, value, "at most " + short_text(limit), unit, value <= limit};
}
Claim at_least(const std::string& name, double value, double limit, const std::string& unit) {
  return {name, value, "at least " + short_text(limit), unit, value >= limit};
}

double rounded(double x, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return std::strtod(text, nullptr);
}

void thin(Series& s, std::size_t most) {
  const std::size_t stride = s.x.size() / most + 1;
  if (stride == 1) return;
  std::size_t n = 0;
  for (std::size_t i = 0; i < s.x.size(); i += stride, ++n) {
    s.x[n] = s.x[i];
    s.y[n] = s.y[i];
  }
  s.x.resize(n);
  s.y.resize(n);
}

void write_outcome(const Outcome& outcome, const std::string& name, const std::string& subtitle,
                   const std::string& folder) {
  const std::filesystem::path to = folder;
  make_folder(folder);
  for (const Csv& csv : outcome.csv) write_file((to / (csv.name + ".csv")).string(), csv_text(csv));
  const Json claims = to_json(outcome.claims);
  write_file((to / "summary.json").string(), Json{{"experiment", name}, {"claims", claims}}.dump(1) + "\n");
  Json report = {{"title", outcome.title}, {"subtitle", subtitle}, {"intro", outcome.intro}, {"claims", claims}};
  report["sections"] = Json::array();
  for (const Section& s : outcome.sections) {
    Json one = {{"title", s.title}, {"text", s.text}, {"plots", Json::array()}, {"tables", Json::array()}};
    for (const Plot& p : s.plots) one["plots"].push_back(to_json(p));
    for (const Table& t : s.tables) one["tables"].push_back(to_json(t));
    report["sections"].push_back(one);
  }
  write_file((to / "report.html").string(), apps::report_page(report));
}

}  // namespace tegotae::experiments
