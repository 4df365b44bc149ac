#include "review/review_command.hpp"

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "review/path_exports.hpp"
#include "review/review.hpp"
#include "review/verdict_json.hpp"
#include "shared/length_option.hpp"
#include "shared/pose_option.hpp"
#include "shared/run_options.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"
#include "view/replay.hpp"

namespace tegotae::review {
namespace {

std::string beside(const std::string& recording) {
  return std::filesystem::path(recording).replace_extension().string() + ".review.html";
}

/// "LOW:HIGH"; empty: none.
ForceBand parse_band(const std::string& text) {
  ForceBand band;
  if (text.empty()) return band;
  char end = 0;
  if (std::sscanf(text.c_str(), "%lf:%lf%c", &band.low, &band.high, &end) != 2 || !(band.low >= 0) ||
      !(band.high > band.low) || band.high > 10)
    throw Error("--mu: \"" + text + "\" is not LOW:HIGH, two coefficients from 0 to 10");
  return band;
}

void print(const Verdict& verdict, const std::string& report) {
  std::cout << verdict.headline << "\n";
  for (const Evidence& e : verdict.evidence) std::cout << "  " << e.text << "\n";
  std::cout << "report: " << report << std::endl;
}

}  // namespace

std::string recording_report(const std::string& recording, const std::string& scene, const MeshLoader& load) {
  Recording read = read_recording(recording);
  SceneFile file = view::load_recorded_scene(recording, read.info, scene, {{}, true, {}, load});
  return report_html(review_recording(recording, std::move(read), std::move(file), {}, {}), {});
}

CLI::Option* add_band_option(CLI::App& app, std::optional<ClearanceBand>& band) {
  return apps::add_lengths_option(
      app, "--band",
      [&band](double low, double high) {
        band = ClearanceBand{low, high};
      },
      "Also report where the gap is below, inside and above this band, like 50um 0.2mm");
}

CLI::App* add_review(CLI::App& app, ReviewOptions& o) {
  CLI::App* review =
      app.add_subcommand("review", "Report on a recording: whether the part goes in, its clearances and its forces");
  review->add_option("RECORDING", o.recording, "What --record wrote")->required();
  review->add_option("SCENE", o.scene, "Its scene file (the one that the recording names)");
  apps::add_pose_option(*review, "--goal", o.goal, "Goal of the part (default: where the scene's script ends)");
  review->add_option("--out", o.out, "The report (RECORDING.review.html, beside it)")->type_name("FILE.html");
  review->add_option("--csv", o.csv, "Also write the path, with clearances and forces")->type_name("FILE.csv");
  review->add_option("--forces", o.forces, "Also write the force of the assembly over depth")->type_name("FILE.csv");
  review->add_option("--mu", o.mu, "Also with friction, for coefficients between these and the same pen")
      ->type_name("LOW:HIGH");
  add_band_option(*review, o.band);
  review->add_flag("--json", o.json, "Print the verdict as one line of JSON");
  review->add_option("--gltf", o.gltf, "Also write the path as an animation, binary when it ends in .glb")
      ->type_name("FILE.gltf");
  review->add_option("--script", o.script, "Also write the pen's path as a stylus script, for run --script")
      ->type_name("FILE.csv");
  return review;
}

int run_review(const ReviewOptions& o) {
  const std::string out = o.out.empty() ? beside(o.recording) : o.out;
  apps::StatusLine status;
  const Progress progress = [&](const char* what, std::size_t done, std::size_t total) {
    status.show(what, done, total);
  };
  status.say("reading the recording");
  Recording recording = read_recording(o.recording);
  SceneOptions how;
  how.load = o.load;
  how.progress = [&](std::size_t done, std::size_t total) { progress("reading mesh files", done, total); };
  SceneFile scene = view::load_recorded_scene(o.recording, recording.info, o.scene, how);
  std::vector<std::string> inputs = scene.files;
  inputs.insert(inputs.end(), {o.recording, recording_info_path(o.recording)});
  refuse_to_replace({out, o.csv, o.forces, o.script, o.gltf}, inputs);
  ReviewQuestions questions{std::nullopt, parse_band(o.mu), o.band};
  if (!o.goal.empty()) questions.goal = apps::parse_pose(o.goal, scene.scene);
  const Review r = review_recording(o.recording, std::move(recording), std::move(scene), questions, progress);
  const auto& rows = r.recording.frames;
  write_file(out, report_html(r, progress));
  if (!o.csv.empty()) write_file(o.csv, path_csv(r.file.scene, rows, r.scan, r.band));
  if (!o.forces.empty()) {
    if (!r.assembly.known)
      throw Error("--forces: " + o.recording +
                  " has no contact forces: nothing was touched on a way, or it is no MCAP recording of qp");
    write_file(o.forces, assembly_force_csv(r.assembly));
  }
  if (!o.script.empty()) write_file(o.script, path_script(r.file, rows, r.center));
  if (!o.gltf.empty())
    write_file(o.gltf, path_gltf(r.file.scene, r.file.up, rows, r.scan, r.band,
                                 std::filesystem::path(o.gltf).extension() == ".glb"));
  status.say("");
  const Verdict said = verdict_with_figures(r);
  if (o.json)
    std::cout << verdict_json(said).dump() << std::endl;
  else
    print(said, out);
  return r.verdict.outcome == Outcome::does_not_go ? apps::kRunFailed : apps::kDone;
}

}  // namespace tegotae::review
