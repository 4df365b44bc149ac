#include "plan/order_output.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "broadphase/bounding_spheres.hpp"
#include "core/number_text.hpp"
#include "core/output_file.hpp"
#include "loop/scene_parts.hpp"
#include "plan/plan_output.hpp"
#include "review/path_exports.hpp"
#include "review/verdict.hpp"
#include "shared/format.hpp"
#include "web/page.hpp"

namespace tegotae::plan {
namespace {

using apps::format;
using Json = nlohmann::json;
using Parts = std::vector<std::size_t>;

std::string names(const Scene& scene, const Parts& parts, const char* between) {
  std::string text;
  for (const std::size_t p : parts) text += (text.empty() ? "" : between) + scene.parts[p].name;
  return text;
}

/// In quotes, for CSV.
std::string cell(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

/// In quotes, for Graphviz.
std::string node(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  return out + '"';
}

bool has(const Parts& parts, std::size_t part) {
  return std::find(parts.begin(), parts.end(), part) != parts.end();
}

/// The parts that stopped a step's parts when they were last tried in vain.
Parts waited_for(const Disassembly& order, const Removal& step) {
  Parts out;
  for (const Blocked& b : order.blocked)
    for (const std::size_t by : b.by)
      if (has(step.parts, b.part) && !has(out, by)) out.push_back(by);
  return out;
}

std::string order_csv(const Scene& scene, const Disassembly& order) {
  std::string text = "step,parts,motions,clearance_um,tried_after\n";
  for (std::size_t i = 0; i < order.order.size(); ++i) {
    const Removal& r = order.order[i];
    text += format("%zu,", i + 1) + cell(names(scene, r.parts, "; ")) +
            format(",%zu,%.6g,", r.plan.path.size() - 1, 1e6 * r.plan.clearance) +
            cell(names(scene, waited_for(order, r), "; ")) + "\n";
  }
  return text;
}

/// What each part of a graph says, by its index: the step in which it came out, first as one of a group; none of what
/// is left.
std::map<std::size_t, std::string> labels(const Scene& scene, const Disassembly& order) {
  std::map<std::size_t, std::string> out;
  for (std::size_t i = 0; i < order.order.size(); ++i)
    for (const std::size_t part : order.order[i].parts)
      out.emplace(part, format("%zu. ", i + 1) + scene.parts[part].name);
  for (const std::size_t part : order.left) out.emplace(part, scene.parts[part].name);
  return out;
}

/// An arrow from each part to those that stopped it.
std::string order_dot(const Scene& scene, const Disassembly& order) {
  std::string text = "digraph disassembly {\n  rankdir=LR;\n";
  for (const auto& [part, label] : labels(scene, order))
    text += "  " + node(scene.parts[part].name) + " [label=" + node(label) + "];\n";
  for (const Blocked& b : order.blocked)
    for (const std::size_t by : b.by)
      text += "  " + node(scene.parts[b.part].name) + " -> " + node(scene.parts[by].name) + ";\n";
  return text + "}\n";
}

std::string step_file(std::size_t step) {
  return format("step-%02zu", step + 1);
}

/// A cell that leads to a file beside the page.
Json link(const std::string& file) {
  return {{"text", file}, {"href", file}};
}

struct Column {
  const char* head;
  bool words;  ///< which begin at the left, and numbers end at the right
};

/// A table without the columns that are empty in every row.
Json filled(const std::vector<Column>& columns, const std::vector<std::vector<Json>>& rows) {
  Json t = {{"head", Json::array()}, {"rows", std::vector<Json>(rows.size(), Json::array())}, {"text", Json::array()}};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (std::all_of(rows.begin(), rows.end(), [k](const auto& row) { return row[k] == ""; })) continue;
    if (columns[k].words) t["text"].push_back(t["head"].size());
    t["head"].push_back(columns[k].head);
    for (std::size_t i = 0; i < rows.size(); ++i) t["rows"][i].push_back(rows[i][k]);
  }
  return t;
}

Json order_table(const Scene& scene, const Disassembly& order) {
  std::vector<std::vector<Json>> rows;
  for (std::size_t i = 0; i < order.order.size(); ++i) {
    const Removal& r = order.order[i];
    rows.push_back({std::to_string(i + 1), names(scene, r.parts, " + "), std::to_string(r.plan.path.size() - 1),
                    review::length_text(r.plan.clearance), names(scene, waited_for(order, r), ", "),
                    link(step_file(i) + ".glb"), link(step_file(i) + ".csv")});
  }
  return filled({{"step", false},
                 {"part", true},
                 {"motions", false},
                 {"clearance proved", false},
                 {"tried in vain before, stopped by", true},
                 {"to look at", true},
                 {"path", true}},
                rows);
}

Json blocked_table(const Scene& scene, const Disassembly& order) {
  std::vector<std::vector<Json>> rows;
  for (const Blocked& b : order.blocked) rows.push_back({scene.parts[b.part].name, names(scene, b.by, ", "), b.error});
  return filled({{"part", true}, {"stopped by", true}, {"not tried, because", true}}, rows);
}

/// The parts, each in the column after those that it waited for, with an arrow to each that stopped it. What is left
/// stands last.
Json blocked_graph(const Scene& scene, const Disassembly& order) {
  std::map<std::size_t, std::size_t> layer;
  Json nodes = Json::array(), arrows = Json::array();
  std::map<std::size_t, std::size_t> place;
  std::map<std::size_t, std::string> label = labels(scene, order);
  const auto add = [&](std::size_t part, std::size_t column) {
    layer[part] = column;
    place[part] = nodes.size();
    nodes.push_back({{"text", label[part]}, {"layer", column}});
  };
  std::size_t columns = 0;
  for (std::size_t i = 0; i < order.order.size(); ++i) {
    std::size_t column = 0;
    for (const std::size_t by : waited_for(order, order.order[i]))
      if (layer.count(by) > 0) column = std::max(column, layer[by] + 1);
    for (const std::size_t part : order.order[i].parts)
      if (place.count(part) == 0) add(part, column);
    columns = std::max(columns, column + 1);
  }
  for (const std::size_t part : order.left) add(part, columns);
  for (const Blocked& b : order.blocked)
    for (const std::size_t by : b.by)
      if (place.count(b.part) > 0 && place.count(by) > 0) arrows.push_back({place[b.part], place[by]});
  return {{"nodes", nodes}, {"arrows", arrows}};
}

std::string left_text(const Scene& scene, const Disassembly& order) {
  std::string text = order.left.size() == 1 ? "Left: " : "Did not come apart: ";
  text += names(scene, order.left, ", ");
  for (const Parts& group : order.together) text += "; out, and not apart: " + names(scene, group, " + ");
  return text;
}

std::string order_html(const SceneFile& file, const Disassembly& order) {
  Json report = {{"title", "Order of disassembly"}, {"subtitle", file.path}};
  report["intro"] = left_text(file.scene, order) + ". Assembly is the same, backwards.";
  report["sections"] = Json::array();
  if (!order.order.empty())
    report["sections"].push_back({{"title", "Steps"}, {"tables", {order_table(file.scene, order)}}});
  if (!order.blocked.empty())
    report["sections"].push_back({{"title", "What blocked what"},
                                  {"text",
                                   "The last try of each part that failed: an arrow leads to each part that stopped "
                                   "it. order.dot has the same for Graphviz."},
                                  {"graph", blocked_graph(file.scene, order)},
                                  {"tables", {blocked_table(file.scene, order)}}});
  return apps::report_page(report);
}

/// The path of a step, among the parts that are there then.
void write_step(const SceneFile& file, const Removal& step, const std::optional<review::ClearanceBand>& band,
                const std::string& path, const review::Progress& progress) {
  Scene then = removal_scene(file.scene, step.there, step.parts);
  Part& held = held_part(then);
  const std::vector<RecordFrame> rows = path_rows(step.plan.path, step.plan.center, bounding_sphere(*held.mesh).radius);
  held.pose = rows.front().x;
  const review::Scan scan = review::scan_path(then, path, rows, progress, band ? band->high : 0);
  std::optional<review::BandFindings> zones;
  if (band) zones = review::find_band(*band, rows, scan);
  write_file(path + ".glb", review::path_gltf(then, file.up, rows, scan, zones, true));
  write_file(path + ".csv", review::path_csv(then, rows, scan, zones));
}

/// Of a step, in `folder`.
std::vector<std::string> step_files(std::size_t step, const std::string& folder) {
  const std::string path = folder + "/" + step_file(step);
  return {path + ".glb", path + ".csv"};
}

/// Those of steps that an earlier order had, from one on.
std::vector<std::string> steps_from(std::size_t step, const std::string& folder) {
  std::vector<std::string> out;
  for (bool any = true; any; ++step) {
    any = false;
    for (const std::string& file : step_files(step, folder)) {
      if (!std::filesystem::exists(file)) continue;
      out.push_back(file);
      any = true;
    }
  }
  return out;
}

}  // namespace

std::vector<std::string> order_files(const std::string& folder, std::size_t parts) {
  std::vector<std::string> out = {folder + "/order.csv", folder + "/order.dot", folder + "/order.html"};
  // Each step leaves one piece more, until each part is one.
  for (std::size_t step = 0; step + 1 < parts; ++step)
    for (const std::string& file : step_files(step, folder)) out.push_back(file);
  const std::vector<std::string> more = steps_from(parts - 1, folder);
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

void write_order(const SceneFile& file, const Disassembly& order, const std::optional<review::ClearanceBand>& band,
                 const std::string& folder, const review::Progress& progress) {
  write_file(folder + "/order.csv", order_csv(file.scene, order));
  write_file(folder + "/order.dot", order_dot(file.scene, order));
  write_file(folder + "/order.html", order_html(file, order));
  for (std::size_t i = 0; i < order.order.size(); ++i)
    write_step(file, order.order[i], band, folder + "/" + step_file(i), progress);
  for (const std::string& earlier : steps_from(order.order.size(), folder)) std::filesystem::remove(earlier);
}

std::string order_text(const Scene& scene, const Disassembly& order) {
  std::string text;
  for (std::size_t i = 0; i < order.order.size(); ++i) {
    const Removal& r = order.order[i];
    const std::size_t motions = r.plan.path.size() - 1;
    text += format("%zu. ", i + 1) + names(scene, r.parts, " + ") +
            (motions == 0 ? std::string(": is out where it stands")
                          : format(": %zu motion%s", motions, motions == 1 ? "" : "s")) +
            ", proved to leave " + number_text(1e6 * r.plan.clearance, 3) + " um\n";
  }
  text += left_text(scene, order) + (order.interrupted ? " (interrupted)" : "") + "\n";
  for (const Blocked& b : order.blocked) {
    if (!has(order.left, b.part)) continue;
    // What is out by now stops nothing any more.
    Parts by;
    std::copy_if(b.by.begin(), b.by.end(), std::back_inserter(by), [&](std::size_t p) { return has(order.left, p); });
    if (!b.error.empty())
      text += "  " + scene.parts[b.part].name + " was not tried: " + b.error + "\n";
    else if (!by.empty())
      text += "  " + scene.parts[b.part].name + " was stopped by " + names(scene, by, ", ") + "\n";
  }
  return text;
}

}  // namespace tegotae::plan
