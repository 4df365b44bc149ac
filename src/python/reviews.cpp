// Reviews of recordings.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/loading.hpp"
#include "python/reports.hpp"
#include "python/running.hpp"
#include "python/scenes.hpp"
#include "review/review.hpp"
#include "review/verdict_json.hpp"
#include "view/replay.hpp"

namespace tegotae::python {
namespace {

struct Ended : std::exception {};

/// numpy.dtype of review::DepthForce. It lives as long as the interpreter.
nb::handle depth_force_type() {
  using review::DepthForce;
  static PyObject* const type = row_type({{"depth", "f8", offsetof(DepthForce, depth)},
                                          {"insertion", "f8", offsetof(DepthForce, insertion)},
                                          {"insertion_peak", "f8", offsetof(DepthForce, insertion_peak)},
                                          {"friction", "f8", offsetof(DepthForce, friction)},
                                          {"seating", "f8", offsetof(DepthForce, seating)},
                                          {"pull_out", "f8", offsetof(DepthForce, pull_out)},
                                          {"pull_out_peak", "f8", offsetof(DepthForce, pull_out_peak)}},
                                         sizeof(DepthForce))
                                    .release()
                                    .ptr();
  return type;
}

/// What is asked of a review.
struct Asked {
  std::string recording, scene;
  std::optional<SceneFile> in_memory;
  MeshLoader load;
  review::ReviewQuestions questions;
  std::string report;  ///< empty: none
};

SceneFile scene_of(const Asked& asked, const RecordingInfo& info) {
  if (!asked.in_memory)
    return view::load_recorded_scene(asked.recording, info, asked.scene, {{}, true, {}, asked.load});
  SceneFile file = *asked.in_memory;
  hold(file.scene, info.held);
  return file;
}

review::Review make(const Asked& asked, const review::Progress& progress) {
  Recording recording = read_recording(asked.recording);
  SceneFile file = scene_of(asked, recording.info);
  std::vector<std::string> inputs = file.files;
  inputs.insert(inputs.end(), {asked.recording, recording_info_path(asked.recording)});
  refuse_to_replace({asked.report}, inputs);
  review::Review made =
      review::review_recording(asked.recording, std::move(recording), std::move(file), asked.questions, progress);
  if (!asked.report.empty()) write_file(asked.report, review::report_html(made, progress));
  return made;
}

nb::dict review_columns(const std::filesystem::path& recording, nb::handle scene, nb::handle goal,
                        const std::optional<std::filesystem::path>& report) {
  Asked asked;
  asked.recording = recording.string();
  asked.load = mesh_loader(false);
  if (nb::isinstance<SceneFile>(scene))
    asked.in_memory = nb::cast<SceneFile>(scene);
  else if (!scene.is_none())
    asked.scene = nb::cast<std::filesystem::path>(scene).string();
  if (!goal.is_none()) asked.questions.goal = pose_of(goal, "goal");
  if (report) asked.report = report->string();
  std::optional<review::Review> made;
  Ending ending;
  interruptible([&] { made = make(asked, ending.watch()); }, [&ending] { ending.request(); });
  nb::dict out;
  out["said"] = verdict_json(verdict_with_figures(*made)).dump();
  add_columns(out, made->file.scene, made->recording.frames, made->scan);
  out["assembly_force"] = nb::none();
  if (made->assembly.known) out["assembly_force"] = row_array(depth_force_type(), std::move(made->assembly.over_depth));
  return out;
}

}  // namespace

review::Progress Ending::watch() const {
  return [this](const char*, std::size_t, std::size_t) {
    if (requested_) throw Ended();
  };
}

void add_columns(nb::dict& out, const Scene& scene, const std::vector<RecordFrame>& rows, const review::Scan& scan) {
  const std::size_t n = scan.rows.size();
  std::vector<double> t(n), path(16 * n), clearance(n), force(n), torque(n);
  std::vector<std::int32_t> part(n, -1);
  for (std::size_t i = 0; i < n; ++i) {
    const review::ScannedRow& s = scan.rows[i];
    const RecordFrame& row = rows[s.row];
    t[i] = row.t;
    write_rows(row.x, path.data() + 16 * i);
    clearance[i] = s.clearances.empty() ? std::numeric_limits<double>::infinity() : s.clearances.front().distance;
    if (!s.clearances.empty()) part[i] = static_cast<std::int32_t>(s.clearances.front().part);
    force[i] = row.wrench.force.norm();
    torque[i] = row.wrench.torque.norm();
  }
  std::vector<std::string> names;
  for (const Part& p : scene.parts) names.push_back(p.name);
  out["parts"] = names;
  out["t"] = column(std::move(t));
  out["path"] = nb::cast(owned<nb::ndarray<nb::numpy, double, nb::shape<-1, 4, 4>>>(std::move(path), {n, 4, 4}));
  out["clearance"] = column(std::move(clearance));
  out["part"] = column(std::move(part));
  out["force"] = column(std::move(force));
  out["torque"] = column(std::move(torque));
}

void bind_reviews(nb::module_& m) {
  m.def("review_columns", &review_columns, nb::arg("recording"), nb::arg("scene").none(), nb::arg("goal").none(),
        nb::arg("report").none(),
        nb::sig("def review_columns(recording: str | os.PathLike[str], scene: str | os.PathLike[str] | SceneFile | "
                "None, goal: "
                "numpy.typing.ArrayLike | None, report: str | os.PathLike[str] | None) -> dict[str, typing.Any]"),
        "Returns the columns of tegotae.Review.");
}

}  // namespace tegotae::python
