// plan_judge: `tegotae plan` beside RRT-Connect with FCL, on the same scenes; writes the table of docs/planning.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

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

std::string row(const JudgedFigures& f, int seeds) {
  const PlannerFigures &a = f.ours, &b = f.baseline;
  return "| " + f.name + (f.comes_out ? "" : " (no way)") + format(" | %d of %d", a.found, seeds) + " | " +
         median(a.cpu) + " | " + median(a.whole_cpu) + " | " +
         (a.found == 0 ? "–" : format("%.3g", 1e6 * a.clearance)) + " | " + bad(a) +
         format(" | %d of %d", b.found, seeds) + " | " + median(b.cpu) + " | " + bad(b) + " |\n";
}

std::string table(const std::vector<JudgedFigures>& figures, int seeds) {
  std::string text =
      "| scene | found | first path, s | with shortening and certificate, s | least clearance certified, µm | paths in "
      "which FCL "
      "finds contact | RRT-Connect + FCL: found | s | paths in which FCL finds contact "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const JudgedFigures& f : figures) text += row(f, seeds);
  return text;
}

/// Puts `text` between the marks of a file.
void replace_generated(const std::string& path, const std::string& text) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be read");
  const std::string old(std::istreambuf_iterator<char>(in), {});
  const std::size_t begin = old.find(kBegin), end = old.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw Error(path + ": has no lines " + std::string(kBegin, 24) + " and " + std::string(kEnd, 22));
  replace_file(path, old.substr(0, begin) + kBegin + text + old.substr(end));
}

struct Options {
  JudgeOptions judge;
  std::vector<std::string> scenes;
  std::string parts, markdown;
};

/// Exit code 1 when a path of ours intersects, or one is found where there is none.
int run(const Options& o, const std::string& command) {
  if (!has_planner()) throw Error(missing_planner());
  std::vector<JudgedFigures> figures;
  bool clean = true;
  for (const JudgedScene& scene : judged_scenes(o.parts)) {
    if (!o.scenes.empty() && std::find(o.scenes.begin(), o.scenes.end(), scene.name) == o.scenes.end()) continue;
    {
      apps::StatusLine status;
      status.say(scene.name);
      figures.push_back(judge(scene, o.judge));
    }
    const JudgedFigures& f = figures.back();
    clean = clean && f.ours.intersecting == 0 && (f.comes_out || f.ours.found == 0);
    std::cout << row(f, o.judge.seeds) << std::flush;
  }
  if (!o.markdown.empty())
    replace_generated(o.markdown, "Command: `" + command + "`\n\n" + table(figures, o.judge.seeds));
  return clean ? apps::kDone : apps::kRunFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the planner with RRT-Connect that asks FCL, in processor time of one thread.", "plan_judge");
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
  std::string command = "plan_judge";
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  return apps::guarded_main(app, argc, argv, [&] { return run(o, command); });
}
