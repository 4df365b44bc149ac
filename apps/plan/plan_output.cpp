#include "plan/plan_output.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "broadphase/bounding_spheres.hpp"
#include "core/output_file.hpp"
#include "loop/scene_parts.hpp"
#include "review/path_exports.hpp"
#include "review/review.hpp"
#include "session/run_goal.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/record/recorder.hpp"

namespace tegotae::plan {
namespace {

constexpr double kSpeed = 0.02;  // m/s
constexpr double kRow = 0.01;    // s

/// The report on the recording, with the zones of the band.
void write_review(const PlanReport& r, const std::string& folder, const review::Progress& progress) {
  const std::string path = folder + "/recording.csv";
  Recording recording = read_recording(path);
  review::ReviewQuestions questions;
  questions.goal = recording.frames.back().x;
  questions.band = r.band->band;
  review::Review shown = review::review_recording(path, std::move(recording), r.file, questions, progress);
  if (!r.plan.found) {
    shown.verdict.outcome = review::Outcome::open;
    shown.verdict.headline = "No way was found: this one leads to the farthest pose";
  }
  write_file(folder + "/review.html", review::report_html(shown, progress));
}

}  // namespace

std::vector<RecordFrame> path_rows(const std::vector<Pose>& path, const Vec3& center, double radius) {
  std::vector<RecordFrame> rows;
  const auto add = [&rows](double t, const Pose& X) {
    RecordFrame row;
    row.tick = rows.size();
    row.t = t;
    row.x = row.y = X;
    rows.push_back(row);
  };
  add(0, path.front());
  double t = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Displacement d = displacement(path[i - 1], path[i], center);
    const double time = (d.dp.norm() + radius * d.dr.norm()) / kSpeed;
    const int parts = std::max(1, static_cast<int>(std::ceil(time / kRow)));
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      t += std::max(time / parts, 1e-4);  // rows have times that ascend, however short a motion is
      add(t, k == parts ? path[i] : displaced(path[i - 1], center, share * d));
    }
  }
  return rows;
}

std::vector<std::string> plan_files(const std::string& folder) {
  std::vector<std::string> out;
  for (const char* name : {"/path.csv", "/path.glb", "/script.csv", "/recording.csv", "/recording.csv.info.json",
                           "/review.html", "/plan.json"})
    out.push_back(folder + name);
  return out;
}

void measure(PlanReport& r, const std::optional<review::ClearanceBand>& band, const review::Progress& progress) {
  held_part(r.file.scene).pose = r.plan.path.front();
  // The scan reports the part's center as the contact loop has it; radius and rows only set the pace.
  const Sphere ball = bounding_sphere(*held_part(r.file.scene).mesh);
  r.rows = path_rows(r.plan.path, r.plan.center, ball.radius);
  r.scan = review::scan_path(r.file.scene, r.file.path, r.rows, progress, band ? band->high : 0);
  r.file.script = StylusScript({{0, r.rows.front().x}, {1, r.rows.back().x}});
  const review::Findings found = review::find(r.file, r.rows, r.scan, r.scan.center);
  r.way = found.way;
  r.turn = found.turn;
  r.tightest = found.clearances;
  if (band) r.band = review::find_band(*band, r.rows, r.scan);
}

void write_plan(const PlanReport& r, const std::string& folder, const review::Progress& progress) {
  const SceneFile& file = r.file;
  write_file(folder + "/path.csv", review::path_csv(file.scene, r.rows, r.scan, r.band));
  write_file(folder + "/path.glb", review::path_gltf(file.scene, file.up, r.rows, r.scan, r.band, true));
  write_file(folder + "/script.csv", review::path_script(file, r.rows, r.scan.center));
  RecordingInfo info;
  info.scene = file.path;
  info.held = held_part(file.scene).name;
  if (r.plan.found) info.goal = goal_text(r.rows.back().x);
  info.program = "tegotae " TEGOTAE_VERSION_STRING;
  Recorder recorder(folder + "/recording.csv", RecordMode::synchronous, info);
  for (const RecordFrame& row : r.rows) recorder.push(row);
  recorder.close();
  // A report on another path is not a neighbor of this one.
  if (r.band)
    write_review(r, folder, progress);
  else
    std::filesystem::remove(folder + "/review.html");
  write_file(folder + "/plan.json", plan_json(r) + "\n");
}

}  // namespace tegotae::plan
