// Runs of scenes, and recordings.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <filesystem>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/pen.hpp"
#include "python/running.hpp"
#include "python/scenes.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::python {
namespace {

nb::dict to_dict(const LatencySummary& us) {
  nb::dict d;
  d["p50"] = us.p50;
  d["p99"] = us.p99;
  d["p999"] = us.p999;
  d["max"] = us.max;
  return d;
}

nb::dict lag_of(const LagSummary& lag) {
  nb::dict ticks, d;
  for (int i = 1; i < kLagReasons; ++i)
    ticks[to_string(static_cast<LagReason>(i))] = lag.ticks[static_cast<std::size_t>(i)];
  d["max_m"] = lag.max_m;
  d["unexplained_ticks"] = lag.unexplained;
  d["ticks"] = ticks;
  return d;
}

nb::dict to_dict(const RunSummary& s) {
  nb::dict servo, d;
  servo["rate_hz"] = s.servo.rate_hz;
  servo["missed"] = s.servo.missed;
  servo["late_us"] = to_dict(s.servo.late_us);
  servo["compute_us"] = to_dict(s.servo.compute_us);
  d["ticks"] = s.ticks;
  d["seconds"] = s.seconds;
  d["completed"] = s.completed;
  d["depth_m"] = s.depth_m;
  d["contacts_max"] = s.contacts_max;
  d["lag"] = lag_of(s.lag);
  d["penetrating"] = s.penetrating;
  d["checked"] = s.checked;
  d["poses"] = s.poses;
  d["deepest_m"] = s.deepest_m;
  d["tick_us"] = to_dict(s.tick_us);
  d["servo"] = servo;
  d["recordings"] = s.recordings;
  d["record_dropped"] = s.record_dropped;
  d["record_failure"] = s.record_failure;
  d["ignored"] = s.ignored;
  d["force_max_n"] = s.force_max_n;
  d["torque_max_nm"] = s.torque_max_nm;
  d["missing_realtime"] = s.missing_realtime;
  d["stability"] = s.stability;
  return d;
}

/// What is to be run: a scene file, by its path too, or a scene with a pen.
SceneFile file_of(nb::handle scene, const ScriptPen* pen) {
  SceneFile file{"", {}, {}, StylusScript({{0, Pose()}})};
  if (nb::isinstance<Scene>(scene)) {
    if (pen == nullptr) throw Error(ErrorKind::setting, "run: a Scene needs a pen");
    file.scene = nb::cast<Scene>(scene);
  } else {
    file = nb::isinstance<SceneFile>(scene) ? nb::cast<SceneFile>(scene) : read_scene_file(scene, "", false);
  }
  if (pen != nullptr) {
    file.device = pen->settings;
    file.script = pen->script;
  }
  return file;
}

nb::dict run(nb::handle scene, const ScriptPen* pen, const std::optional<std::filesystem::path>& record, bool real_time,
             double seconds, bool check_all) {
  const SceneFile file = file_of(scene, pen);
  std::atomic<bool> stop{false};
  RunSettings how;
  how.real_time = real_time;
  how.seconds = seconds;
  how.check_all = check_all;
  how.record = record ? record->string() : "";
  how.program = "tegotae for Python " TEGOTAE_VERSION_STRING;
  how.stop = &stop;
  how.stop_check = &stop;
  RunSummary summary;
  interruptible([&] { summary = run_session(file, how); }, [&stop] { stop = true; });
  return to_dict(summary);
}

/// A row of Recording.forces.
struct ForceRow {
  double point[3], normal[3], gap, force, friction[3], mu;
  std::int64_t row;
  std::uint32_t part;
  bool slides;
};

nb::object forces_of(const Recording& recording) {
  static PyObject* const type = row_type({{"row", "i8", offsetof(ForceRow, row)},
                                          {"part", "u4", offsetof(ForceRow, part)},
                                          {"point", "(3,)f8", offsetof(ForceRow, point)},
                                          {"normal", "(3,)f8", offsetof(ForceRow, normal)},
                                          {"gap", "f8", offsetof(ForceRow, gap)},
                                          {"force", "f8", offsetof(ForceRow, force)},
                                          {"friction", "(3,)f8", offsetof(ForceRow, friction)},
                                          {"mu", "f8", offsetof(ForceRow, mu)},
                                          {"slides", "?", offsetof(ForceRow, slides)}},
                                         sizeof(ForceRow))
                                    .release()
                                    .ptr();
  std::vector<ForceRow> rows;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const ContactForces& forces = recording.frames[i].forces;
    for (int k = 0; k < forces.count; ++k) {
      const ContactForce& c = forces.items[static_cast<std::size_t>(k)];
      ForceRow row{};
      Vec3::Map(row.point) = c.point;
      Vec3::Map(row.normal) = c.n;
      Vec3::Map(row.friction) = c.friction;
      row.gap = c.gap;
      row.force = c.force;
      row.mu = c.mu;
      row.row = static_cast<std::int64_t>(i);
      row.part = c.part.index;
      row.slides = c.slides;
      rows.push_back(row);
    }
  }
  return row_array(type, std::move(rows));
}

/// One value of each row.
template <class T, class Get>
nb::object column_of(const std::vector<RecordFrame>& frames, Get get) {
  std::vector<T> values;
  values.reserve(frames.size());
  for (const RecordFrame& f : frames) values.push_back(static_cast<T>(get(f)));
  return column(std::move(values));
}

template <class Get>
nb::object poses_of(const std::vector<RecordFrame>& frames, Get get) {
  std::vector<double> rows(16 * frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) write_rows(get(frames[i]), rows.data() + 16 * i);
  return nb::cast(owned<nb::ndarray<nb::numpy, double, nb::shape<-1, 4, 4>>>(std::move(rows), {frames.size(), 4, 4}));
}

nb::object wrenches_of(const std::vector<RecordFrame>& frames) {
  std::vector<double> rows;
  rows.reserve(6 * frames.size());
  for (const RecordFrame& f : frames) {
    rows.insert(rows.end(), f.wrench.force.data(), f.wrench.force.data() + 3);
    rows.insert(rows.end(), f.wrench.torque.data(), f.wrench.torque.data() + 3);
  }
  return nb::cast(owned<nb::ndarray<nb::numpy, double, nb::shape<-1, 6>>>(std::move(rows), {frames.size(), 6}));
}

nb::dict info_of(const RecordingInfo& info) {
  nb::dict d;
  d["scene"] = info.scene;
  d["held"] = info.held;
  d["resolver"] = info.resolver;
  d["program"] = info.program;
  d["suspended"] = info.filtered;
  d["follows"] = info.continues;
  d["goes_on"] = info.continued_by;
  d["goal"] = info.goal;
  d["goal_tolerance"] = info.goal_tolerance;
  d["judged_after"] = info.judged_after;
  return d;
}

nb::dict read(const std::filesystem::path& path) {
  Recording recording;
  {
    const nb::gil_scoped_release others_go_on;
    recording = read_recording(path.string());
  }
  const auto& frames = recording.frames;
  nb::dict d;
  d["path"] = path.string();
  d["info"] = info_of(recording.info);
  d["damage"] = recording.damage;
  d["tick"] = column_of<std::uint64_t>(frames, [](const RecordFrame& f) { return f.tick; });
  d["substep"] = column_of<std::uint32_t>(frames, [](const RecordFrame& f) { return f.substep; });
  d["t"] = column_of<double>(frames, [](const RecordFrame& f) { return f.t; });
  d["pen"] = poses_of(frames, [](const RecordFrame& f) -> const Pose& { return f.y; });
  d["part"] = poses_of(frames, [](const RecordFrame& f) -> const Pose& { return f.x; });
  d["wrench"] = wrenches_of(frames);
  d["contacts"] = column_of<std::int32_t>(frames, [](const RecordFrame& f) { return f.contacts; });
  d["gap"] = column_of<double>(frames, [](const RecordFrame& f) { return f.gap; });
  d["tick_us"] = column_of<double>(frames, [](const RecordFrame& f) { return f.tick_us; });
  d["lag_reason"] = column_of<std::uint8_t>(frames, [](const RecordFrame& f) { return f.lag_reason; });
  d["forces"] = forces_of(recording);
  return d;
}

}  // namespace

void bind_runs(nb::module_& m) {
  m.def("recording_columns", &read, nb::arg("path"),
        nb::sig("def recording_columns(path: str | os.PathLike[str]) -> dict[str, typing.Any]"),
        "Returns the columns of tegotae.Recording.");
  m.def(
      "run", &run, nb::arg("scene"), nb::arg("pen") = nb::none(), nb::kw_only(), nb::arg("record") = nb::none(),
      nb::arg("real_time") = false, nb::arg("seconds") = 0.0, nb::arg("check_all") = false,
      nb::sig(
          "def run(scene: str | os.PathLike[str] | SceneFile | Scene, pen: ScriptPen | None = None, *, record: str | "
          "os.PathLike[str] | None = None, real_time: bool = False, seconds: float = 0.0, check_all: bool = False) -> "
          "dict[str, typing.Any]"),
      R"(Runs a scene with a simulated pen to the end of its script. FCL checks the poses.

The run never waits for Python, and other Python threads continue. Ctrl-C ends it with KeyboardInterrupt.

Parameters
----------
scene : str, os.PathLike, SceneFile or Scene
    A scene file by its path or as load_scene() read it, or a scene in memory, which needs a `pen`.
pen : ScriptPen, optional
    Replaces the file's pen and script.
record : str or os.PathLike, optional
    Path of the recording to write, for read_recording() and review(): MCAP when it ends in .mcap, otherwise CSV.
real_time : bool
    False: simulated time, as fast as possible and the same on every run.
seconds : float
    Length of the run, s. 0: to the end of the script, and half a second more.
check_all : bool
    True: FCL checks every pose, however long it takes. False: FCL checks poses during the run, and afterwards for a
    quarter of the time that the run took, or 2 s if that is longer.

Returns
-------
dict
    Figures as in `tegotae run --json`: `completed`, `depth_m`, `ticks`, `seconds`, `contacts_max`, `lag`, `poses`,
    `checked` (poses that FCL checked), `penetrating` (how many of those intersect), `force_max_n`, `torque_max_nm`,
    `tick_us`, `servo`, `recordings`, `record_failure` (why a recording is incomplete) and more. The suffix is the unit:
    m, N, N m (nm) or us.

Raises
------
Error
    The scene or the pen cannot be used, the loop cannot hold the scene, or the recording cannot be begun or would
    replace a file of the scene.)");
}

}  // namespace tegotae::python
