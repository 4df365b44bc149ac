// plan_judge: `tegotae plan` beside RRT-Connect with FCL, on the same scenes; writes the table of docs/planning.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "core/number_text.hpp"
#include "core/output_file.hpp"
#include "plan/judge.hpp"
#include "plan/judge_rows.hpp"
#include "plan/planner.hpp"
#include "shared/format.hpp"
#include "shared/guarded_main.hpp"
#include "shared/option_check.hpp"
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

struct Options {
  JudgeOptions judge;
  std::vector<std::string> scenes;
  std::string parts, rows, markdown;
};

bool wanted(const Options& o, const JudgedScene& scene) {
  return o.scenes.empty() || std::find(o.scenes.begin(), o.scenes.end(), scene.name) != o.scenes.end();
}

/// The command that makes the table, as the file shows it.
std::string command(const Options& o) {
  const auto option = [](const char* name, const std::string& value) {
    return value.empty() ? "" : std::string(" ") + name + " " + value;
  };
  return "Command: `plan_judge --seeds " + std::to_string(o.judge.seeds) + " --seconds " +
         number_text(o.judge.seconds, 6) + option("--parts", o.parts) + option("--rows", o.rows) +
         option("--markdown", o.markdown) + "`\n\n";
}

void write_table(const Options& o, const std::string& rows) {
  const Page page = read_page(o.markdown);
  write_file(o.markdown, page.before + command(o) + kHead + rows + page.after);
}

JudgedFigures figures(const Options& o, const JudgedScene& scene, JudgeRows& kept) {
  const std::string from = judged_from(scene, o.judge);
  if (const std::optional<JudgedFigures> known = kept.find(scene.name, from)) return *known;
  apps::StatusLine status;
  const JudgedFigures made = judge(scene, o.judge, [&](int seed, const char* what) {
    status.say(scene.name + format(", seed %d of %d: ", seed, o.judge.seeds) + what);
  });
  kept.keep(scene.name, from, made);
  return made;
}

/// Exit code 1 when a path of ours intersects, or one is found where there is none.
int run(const Options& o) {
  if (!has_planner()) throw Error(missing_planner());
  const std::vector<JudgedScene> scenes = judged_scenes(o.parts);
  for (const std::string& name : o.scenes)
    if (std::none_of(scenes.begin(), scenes.end(), [&](const JudgedScene& s) { return s.name == name; }))
      throw Error("no scene \"" + name + "\"");
  JudgeRows kept(o.rows);
  if (!o.markdown.empty()) read_page(o.markdown);  // that it cannot be written is said before hours of work
  std::string rows;
  bool clean = true;
  for (const JudgedScene& scene : scenes) {
    if (!wanted(o, scene)) continue;
    const JudgedFigures f = figures(o, scene, kept);
    clean = clean && f.ours.intersecting == 0 && (scene.comes_out || f.ours.found == 0);
    rows += row(scene, f, o.judge.seeds);
    std::cout << row(scene, f, o.judge.seeds) << std::flush;
  }
  if (!o.markdown.empty()) write_table(o, rows);
  return clean ? apps::kDone : apps::kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the planner with RRT-Connect that asks FCL, in processor time of all threads.", "plan_judge");
  Options o;
  app.add_option("--seeds", o.judge.seeds, "Runs of each planner on a scene")
      ->check(apps::between(1, 1000))
      ->capture_default_str();
  app.add_option("--seconds", o.judge.seconds, "Processor time of a search, at most")
      ->check(apps::between(0.1, 1e5))
      ->capture_default_str();
  CLI::Option* scene = app.add_option("--scene", o.scenes, "Only this one (may be repeated)")->type_name("NAME");
  app.add_option("--parts", o.parts, "Folder of real parts, with pairs.json")->type_name("DIR");
  app.add_option("--rows", o.rows,
                 "Keeps figures here; a scene whose program, options and parts are the same is taken from it")
      ->type_name("FILE.json");
  app.add_option("--markdown", o.markdown, "Also replace the generated part of this file, when all scenes are done")
      ->excludes(scene)
      ->type_name("FILE");
  return apps::guarded_main(app, argc, argv, [&] { return run(o); });
}
