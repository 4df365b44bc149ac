// plan_judge: `tegotae plan` beside RRT-Connect with FCL, on the same scenes; writes the table of docs/planning.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "core/number_text.hpp"
#include "core/output_file.hpp"
#include "plan/judge.hpp"
#include "plan/planner.hpp"
#include "shared/format.hpp"
#include "shared/guarded_main.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::plan;
using apps::format;

namespace {

const char* const kBegin = "<!-- begin generated -->\n";
const char* const kEnd = "<!-- end generated -->\n";

std::string median(std::vector<double> values) {
  if (values.empty()) return "–";
  std::sort(values.begin(), values.end());
  return format("%.2f", values[values.size() / 2]);
}

/// Paths that FCL finds in a part, of those that were found.
std::string bad(const PlannerFigures& f) {
  return f.found == 0 ? "–" : format("%d of %d", f.bad_paths, f.found);
}

std::string first_cell(const JudgedScene& scene) {
  return "| " + scene.name + (scene.comes_out ? " " : " (no way) ");
}

std::string row(const JudgedScene& scene, const JudgedFigures& f, int seeds) {
  const PlannerFigures &a = f.ours, &b = f.baseline;
  return first_cell(scene) + format("| %d of %d", a.found, seeds) + " | " + median(a.cpu) + " | " +
         median(a.whole_cpu) + " | " + (a.found == 0 ? "–" : number_text(1e6 * a.clearance, 3)) + " | " + bad(a) +
         format(" | %d of %d", b.found, seeds) + " | " + median(b.cpu) + " | " + bad(b) + " |\n";
}

const char* const kHead =
    "| scene | found | first path, s | with shortening and certificate, s | least clearance certified, µm | paths in "
    "which FCL finds contact | RRT-Connect + FCL: found | s | paths in which FCL finds contact "
    "|\n|---|---|---|---|---|---|---|---|---|\n";

/// A generated part of a file, and what is around it.
struct Page {
  std::string before, generated, after;
};

Page read_page(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be read");
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::size_t begin = text.find(kBegin), end = text.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw Error(path + ": has no lines " + std::string(kBegin, 24) + " and " + std::string(kEnd, 22));
  const std::size_t inside = begin + std::string(kBegin).size();
  return {text.substr(0, inside), text.substr(inside, end - inside), text.substr(end)};
}

/// The row of a scene in a table; empty: it has none.
std::string row_in(const std::string& table, const JudgedScene& scene) {
  const std::size_t begin = table.find("\n" + first_cell(scene) + "|");
  return begin == std::string::npos ? "" : table.substr(begin + 1, table.find('\n', begin + 1) - begin);
}

struct Options {
  JudgeOptions judge;
  std::vector<std::string> scenes;
  std::string parts, markdown;
};

bool wanted(const Options& o, const JudgedScene& scene) {
  return o.scenes.empty() || std::find(o.scenes.begin(), o.scenes.end(), scene.name) != o.scenes.end();
}

/// The command that makes the complete table, as the file shows it.
std::string command(const Options& o) {
  return "Command: `plan_judge --seeds " + std::to_string(o.judge.seeds) + " --seconds " +
         number_text(o.judge.seconds, 6) + (o.parts.empty() ? "" : " --parts " + o.parts) + " --markdown " +
         o.markdown + "` (with `--scene NAME` a row of it)\n\n";
}

/// Rows that were made replace those of the table, if it is of the same command; a run of all scenes makes it anew
/// where it is of another one.
void write_table(const Options& o, const std::vector<JudgedScene>& scenes,
                 const std::map<std::string, std::string>& rows) {
  const Page page = read_page(o.markdown);
  const bool same = page.generated.find(command(o)) == 0;
  if (!o.scenes.empty() && !same)
    throw Error(o.markdown + ": its table is not of " + command(o).substr(0, command(o).find('\n')));
  std::string table = command(o) + kHead;
  for (const JudgedScene& scene : scenes) {
    const auto made = rows.find(scene.name);
    table += made != rows.end() ? made->second : same ? row_in(page.generated, scene) : "";
  }
  replace_file(o.markdown, page.before + table + page.after);
}

/// Exit code 1 when a path of ours intersects, or one is found where there is none.
int run(const Options& o) {
  if (!has_planner()) throw Error(missing_planner());
  const std::vector<JudgedScene> scenes = judged_scenes(o.parts);
  for (const std::string& name : o.scenes)
    if (std::none_of(scenes.begin(), scenes.end(), [&](const JudgedScene& s) { return s.name == name; }))
      throw Error("no scene \"" + name + "\"");
  std::map<std::string, std::string> rows;
  bool clean = true;
  for (const JudgedScene& scene : scenes) {
    if (!wanted(o, scene)) continue;
    JudgedFigures f;
    {
      apps::StatusLine status;
      status.say(scene.name);
      f = judge(scene, o.judge);
    }
    clean = clean && f.ours.intersecting == 0 && (scene.comes_out || f.ours.found == 0);
    rows[scene.name] = row(scene, f, o.judge.seeds);
    std::cout << rows[scene.name] << std::flush;
    if (!o.markdown.empty()) write_table(o, scenes, rows);
  }
  return clean ? apps::kDone : apps::kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the planner with RRT-Connect that asks FCL, in processor time of all threads.", "plan_judge");
  Options o;
  app.add_option("--seeds", o.judge.seeds, "Runs of each planner on a scene")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seconds", o.judge.seconds, "Processor time of a search, at most")
      ->check(CLI::Range(0.1, 1e5))
      ->capture_default_str();
  app.add_option("--scene", o.scenes, "Only this one (may be repeated)")->type_name("NAME");
  app.add_option("--parts", o.parts, "Folder of real parts, with pairs.json")->type_name("DIR");
  app.add_option("--markdown", o.markdown, "Also replace the generated part of this file")->type_name("FILE");
  return apps::guarded_main(app, argc, argv, [&] { return run(o); });
}
