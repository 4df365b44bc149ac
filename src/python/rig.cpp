// Rigs: a scene, a pen and everything between them.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <cmath>
#include <limits>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/python_rig.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::python {
namespace {

/// A row of Rig.contacts and Rig.events.
struct ContactRow {
  double point_a[3], point_b[3], normal[3], gap, force, friction[3];
  std::int64_t ticks;
  std::uint32_t part, feature_a, feature_b;
  std::uint8_t kind_a, kind_b;
  bool slides, began;
};

/// numpy.dtype of ContactRow. It lives as long as the interpreter.
nb::handle contact_type() {
  static PyObject* const type = row_type({{"part", "u4", offsetof(ContactRow, part)},
                                          {"point_a", "(3,)f8", offsetof(ContactRow, point_a)},
                                          {"point_b", "(3,)f8", offsetof(ContactRow, point_b)},
                                          {"normal", "(3,)f8", offsetof(ContactRow, normal)},
                                          {"gap", "f8", offsetof(ContactRow, gap)},
                                          {"force", "f8", offsetof(ContactRow, force)},
                                          {"friction", "(3,)f8", offsetof(ContactRow, friction)},
                                          {"slides", "?", offsetof(ContactRow, slides)},
                                          {"ticks", "i8", offsetof(ContactRow, ticks)},
                                          {"kind_a", "u1", offsetof(ContactRow, kind_a)},
                                          {"feature_a", "u4", offsetof(ContactRow, feature_a)},
                                          {"kind_b", "u1", offsetof(ContactRow, kind_b)},
                                          {"feature_b", "u4", offsetof(ContactRow, feature_b)},
                                          {"began", "?", offsetof(ContactRow, began)}},
                                         sizeof(ContactRow))
                                    .release()
                                    .ptr();
  return type;
}

ContactRow row_of(const ContactPoint& c, bool began) {
  ContactRow row{};
  Vec3::Map(row.point_a) = c.point_a;
  Vec3::Map(row.point_b) = c.point_b;
  Vec3::Map(row.normal) = c.normal;
  Vec3::Map(row.friction) = c.friction;
  row.gap = c.gap;
  row.force = c.force.value_or(std::numeric_limits<double>::quiet_NaN());
  row.ticks = c.ticks;
  row.part = c.part.index;
  row.feature_a = c.feature_a.index;
  row.feature_b = c.feature_b.index;
  row.kind_a = static_cast<std::uint8_t>(c.feature_a.kind);
  row.kind_b = static_cast<std::uint8_t>(c.feature_b.kind);
  row.slides = c.slides;
  row.began = began;
  return row;
}

nb::object contacts(const PythonRig& rig) {
  std::vector<ContactRow> rows;
  for (const ContactPoint& c : rig.at_rest().contacts()) rows.push_back(row_of(c, c.ticks == 0));
  return row_array(contact_type(), std::move(rows));
}

nb::object events(const PythonRig& rig) {
  std::vector<ContactRow> rows;
  for (const ContactEvent& e : rig.at_rest().contact_events())
    rows.push_back(row_of(e.contact, e.kind == ContactEvent::Kind::began));
  return row_array(contact_type(), std::move(rows));
}

/// TickReport, a copy.
struct Report {
  int contacts, constraints, resolves, iterations;
  double contact_gap, gap, depth, fraction, lag;
  std::string status, lag_reason;
  TickFlags flags;
  std::int64_t unexplained_lag_ticks;
  int filtered, shrunk;
  std::optional<Wrench> contact_wrench;
};

const char* word(ResolveStatus status) {
  switch (status) {
    case ResolveStatus::not_needed:
      return "not_needed";
    case ResolveStatus::solved:
      return "solved";
    case ResolveStatus::infeasible:
      return "infeasible";
    case ResolveStatus::stalled:
      break;
  }
  return "stalled";
}

Report report(const PythonRig& python) {
  const Rig& rig = python.at_rest();
  const TickReport& r = rig.report();
  std::optional<Wrench> sum;
  if (r.forces.available) sum = r.forces.sum(r.proxy.X * rig.loop().center(), rig.pen().scale);
  return {r.contacts,
          r.constraints,
          r.resolves,
          r.iterations,
          r.contact_gap,
          r.gap,
          r.depth,
          r.fraction,
          r.lag,
          word(r.status),
          to_string(r.lag_reason),
          r.flags,
          r.unexplained_lag_ticks,
          r.filtered,
          r.shrunk,
          sum};
}

void bind_report(nb::module_& m) {
  nb::class_<Report>(m, "Report", "What the last step did, as it was then.")
      .def_ro("contacts", &Report::contacts, "Pairs of features with a gap of at most `contact_gap`.")
      .def_ro("contact_gap", &Report::contact_gap, "m, what counts as contact.")
      .def_ro("constraints", &Report::constraints, "Pairs of features that limited the motion, contacts included.")
      .def_ro("gap", &Report::gap, "m, smallest that is known; inf when nothing is within reach.")
      .def_ro("depth", &Report::depth, "m, deepest vertex inside another part; only \"penalty\" penetrates.")
      .def_ro("resolves", &Report::resolves, "Programs solved.")
      .def_ro("iterations", &Report::iterations, "Pivots of all programs.")
      .def_ro("status", &Report::status, "\"not_needed\", \"solved\", \"infeasible\", \"stalled\".")
      .def_ro("fraction", &Report::fraction, "Part of the wanted motion that was made, 0 to 1.")
      .def_ro("lag", &Report::lag, "m, how far the part is behind the pen: centers, plus radius times angle.")
      .def_ro("lag_reason", &Report::lag_reason, "\"none\", \"contact\", \"time\", \"capacity\", \"suspended\".")
      .def_ro("unexplained_lag_ticks", &Report::unexplained_lag_ticks,
              "Ticks so far in which the part was held back and no contact explains it.")
      .def_ro("filtered", &Report::filtered, "Pairs that overlapped at the start and are not kept apart yet.")
      .def_ro("shrunk", &Report::shrunk, "Pairs that touched at the start and have not come free.")
      .def_prop_ro(
          "timed_out", [](const Report& r) { return r.flags.timed_out; }, "Time or work ran out.")
      .def_prop_ro(
          "overflow", [](const Report& r) { return r.flags.overflow; }, "A capacity was exceeded.")
      .def_prop_ro(
          "input_ignored", [](const Report& r) { return r.flags.input_ignored; },
          "The pen's pose was none that a pen can have.")
      .def_prop_ro(
          "scene_changed", [](const Report& r) { return r.flags.scene_changed; },
          "It is the first step in a changed scene.")
      .def_prop_ro(
          "part_changed", [](const Report& r) { return r.flags.part_changed; }, "... in which another part is held.")
      .def_prop_ro(
          "contact_wrench",
          [](const Report& r) -> nb::object {
            return r.contact_wrench ? nb::cast(to_array(*r.contact_wrench)) : nb::none();
          },
          nb::sig("def contact_wrench(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "(6,) float64: force (N) and torque (N m) of all contacts on the part at its center of mass, world axes.\n"
          "None: not available (free, or a resolver that knows no forces).");
}

const char* word(ChangeState state) {
  switch (state) {
    case ChangeState::pending:
      return "pending";
    case ChangeState::in_force:
      return "in_force";
    case ChangeState::superseded:
      return "superseded";
    case ChangeState::replaced:
      return "replaced";
    case ChangeState::canceled:
      break;
  }
  return "canceled";
}

void bind_change(nb::module_& m) {
  nb::class_<SceneChange>(m, "Change", "A change of a running scene. All of it from any thread.")
      .def_prop_ro("number", &SceneChange::number, "From 1 on.")
      .def_prop_ro(
          "state", [](const SceneChange& c) { return word(c.state()); },
          "\"pending\" (waits for a step, or for the held part to be out of its way), \"in_force\",\n"
          "\"superseded\", \"replaced\" (while it was pending), \"canceled\".")
      .def(
          "wait", [](const SceneChange& c, double seconds) { return word(c.wait(seconds)); }, nb::arg("seconds"),
          nb::call_guard<nb::gil_scoped_release>(),
          "Waits for at most `seconds` until it is no longer pending; returns the state then. Another thread must "
          "step.")
      .def("cancel", &SceneChange::cancel, "Takes it back. False when it is no longer pending.");
}

RigClock clock_of(const std::string& name) {
  if (name == "simulated") return RigClock::simulated;
  if (name == "real") return RigClock::real;
  throw Error(ErrorKind::setting, "rig: the clock is \"simulated\" or \"real\", not \"" + name + "\"");
}

nb::dict servo(const PythonRig& rig) {
  const ServoStatistics s = rig.from_any_thread().servo_statistics();
  const auto summary = [](const LatencySummary& us) {
    nb::dict d;
    d["p50"] = us.p50;
    d["p99"] = us.p99;
    d["p999"] = us.p999;
    d["max"] = us.max;
    return d;
  };
  nb::dict d;
  d["ticks"] = s.ticks;
  d["missed"] = s.missed;
  d["rate_hz"] = s.rate_hz;
  d["late_us"] = summary(s.late_us);
  d["compute_us"] = summary(s.compute_us);
  return d;
}

int visit(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<PythonRig>(self)->pen().ptr());
  return 0;
}

int clear(PyObject* self) {
  nb::inst_ptr<PythonRig>(self)->forget_pen();
  return 0;
}

PyType_Slot kSlots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(visit)}, {Py_tp_clear, reinterpret_cast<void*>(clear)}, {0, nullptr}};

using RigClass = nb::class_<PythonRig>;

void bind_lifecycle(RigClass& c) {
  c.def(
       "__init__",
       [](PythonRig* self, const Scene& scene, const Pen& pen, const std::string& clock, double period) {
         new (self) PythonRig(scene, pen, clock_of(clock), period);
       },
       nb::arg("scene"), nb::arg("pen"), nb::arg("clock") = "simulated", nb::kw_only(), nb::arg("period") = 1e-3)
      .def(
          "__init__",
          [](PythonRig* self, const Scene& scene, const std::string& device) { new (self) PythonRig(scene, device); },
          nb::arg("scene"), nb::arg("device"))
      .def("start", &PythonRig::start, "Starts the device and its servo. Raises Error with the cause.")
      .def("stop", &PythonRig::stop, "Force off; servo and device stop. What a pen in Python raised is raised here.")
      .def(
          "__enter__",
          [](PythonRig& rig) -> PythonRig& {
            rig.start();
            return rig;
          },
          nb::rv_policy::reference)
      .def(
          "__exit__", [](PythonRig& rig, nb::args) { rig.stop(); },
          nb::sig("def __exit__(self, *args: object) -> None"))
      .def("step", &PythonRig::step, nb::arg("count") = 1,
           "`count` ticks: each reads the pen, moves the part as near to it as the others allow, and publishes the "
           "result.\n"
           "Other Python threads continue meanwhile, and Ctrl-C ends it where there are several.")
      .def("run", &PythonRig::run, nb::arg("seconds"), nb::arg("callback") = nb::none(),
           nb::sig("def run(self, seconds: float, callback: collections.abc.Callable[[Rig], object] | None = None) -> "
                   "None"),
           R"(Steps until `seconds` after start(), or until request_stop().

Without a callback the loop has a thread that never waits for Python, and other Python threads go on; Ctrl-C ends it.
In real time it steps at most once a period, with real-time priority where the system grants it.

Parameters
----------
seconds : float
    Of the rig's time since start().
callback : callable, optional
    Called as callback(rig) after each step; the next step waits for it, the servo does not. What it raises ends the
    run.)")
      .def("request_stop", &PythonRig::request_stop, "Ends run() after the step that it is in. From any thread.")
      .def("change", &PythonRig::change, nb::arg("scene"),
           R"(Continues in another scene: parts added, removed or moved, or another one held.

The part that is held now goes on from where it is. From any thread. A later change replaces one that is pending.

Raises
------
Error
    The scene cannot be held; nothing changes then.)");
}

void bind_state(RigClass& c) {
  c.def_prop_ro(
       "part", [](const PythonRig& r) { return to_array(r.from_any_thread().part()); }, nb::rv_policy::automatic,
       "(4, 4) float64, X_WF, m: of the held part's own frame. From any thread.")
      .def_prop_ro(
          "pen", [](const PythonRig& r) { return to_array(r.at_rest().pen().state.pose); }, nb::rv_policy::automatic,
          "(4, 4) float64, Y, m: where the pen wants the held part's own frame.")
      .def_prop_ro(
          "wrench", [](const PythonRig& r) { return to_array(r.at_rest().pen().wrench); }, nb::rv_policy::automatic,
          "(6,) float64: force (N) and torque (N m) on the pen, as rendered, at the held part's center of mass,\n"
          "world axes.")
      .def_prop_ro(
          "force_off",
          [](const PythonRig& r) -> std::optional<std::string> {
            const ForceOff reason = r.at_rest().pen().reason;
            if (reason == ForceOff::none) return std::nullopt;
            return to_string(reason);
          },
          "Why the device renders no force; None: it does.")
      .def_prop_ro(
          "center", [](const PythonRig& r) { return to_array(r.at_rest().loop().center()); }, nb::rv_policy::automatic,
          "(3,) float64, m: the held part's center of mass in its own frame.")
      .def_prop_ro(
          "held", [](const PythonRig& r) { return r.from_any_thread().loop().held(); },
          "Name of the held part. From any thread.")
      .def_prop_ro(
          "time", [](const PythonRig& r) { return r.at_rest().time(); }, "s since start(), of the last step.")
      .def_prop_ro(
          "steps", [](const PythonRig& r) { return r.at_rest().steps(); }, "Since start().")
      .def_prop_ro(
          "connected", [](const PythonRig& r) { return r.at_rest().connected(); },
          "The pen was there in the last step.")
      .def_prop_ro("report", &report, "Of the last step; before the first one, of the start.")
      .def_prop_ro("contacts", &contacts, nb::sig("def contacts(self) -> numpy.typing.NDArray[numpy.void]"),
                   R"(The contacts of the last step: a structured array, a row each.

Fields: `part` (number of the fixed part), `point_a`, `point_b` ((3,), m, world, on the held and on the fixed part),
`normal` ((3,), unit, from the fixed to the held part, world), `gap` (m), `force` (N, on the held part along `normal`;
nan: not available), `friction` ((3,), N, on the held part, world), `slides`, `ticks` (in contact before this one),
`kind_a`, `feature_a`, `kind_b`, `feature_b` (0 vertex, 1 edge, 2 face, and its index), `began`.)")
      .def_prop_ro("events", &events, nb::sig("def events(self) -> numpy.typing.NDArray[numpy.void]"),
                   "Contacts that began (`began`) or ended in the last step, with the fields of `contacts`.")
      .def_prop_ro("servo", &servo, nb::sig("def servo(self) -> dict[str, typing.Any]"),
                   "What the servo has done since start(): ticks, missed, rate_hz, late_us and compute_us (p50, p99,\n"
                   "p999, max). In simulated time ticks alone. From any thread.")
      .def_prop_ro(
          "missing_realtime", [](const PythonRig& r) { return r.at_rest().missing_realtime(); },
          "What the system did not grant to the servo or to run(); empty: nothing.")
      .def_prop_ro(
          "stability", [](const PythonRig& r) { return r.at_rest().stability(); },
          "Whether the coupling is stable with this device, in words.");
}

}  // namespace

void bind_rig(nb::module_& m) {
  bind_report(m);
  bind_change(m);
  RigClass rig(m, "Rig", nb::type_slots(kSlots),
               R"(A scene, a pen, and everything between them: servo, shared memory, contact loop.

The pen carries the held part, the part stays out of the others, and the pen feels it. Use it in a `with` statement,
which starts and stops it. One thread steps; what is for any thread says so, and the rest raises Error while another
thread steps.

Parameters
----------
scene : Scene
    Copied.
pen : Pen
    ScriptPen or PythonPen.
clock : str
    "simulated": step() and run() alone move time on, and the same scene and pen do the same, bit for bit. "real": the
    machine's clock; the servo has a thread of its own at 1 kHz.
period : float
    s between two steps, 1e-5 to 1: of simulated time, and at least that in run().
device : str
    "shm:NAME", the device of another process (tegotae-device), in real time.

Raises
------
Error
    The parts overlap at the start (kind "overlap", with `part`), a setting is out of range, there is no such device.)");
  bind_lifecycle(rig);
  bind_state(rig);
  m.attr("contact_dtype") = contact_type();
}

}  // namespace tegotae::python
