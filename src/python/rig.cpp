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
  nb::class_<Report>(m, "Report", "Report of a step. It is a copy: later steps do not change it.")
      .def_ro("contacts", &Report::contacts, "Number of feature pairs with a gap of at most `contact_gap`.")
      .def_ro("contact_gap", &Report::contact_gap, "m, largest gap of a contact in this step.")
      .def_ro("constraints", &Report::constraints,
              "Number of feature pairs that constrained the motion, contacts included.")
      .def_ro("gap", &Report::gap,
              "m, smallest known gap; inf when nothing is within reach, negative where parts penetrate.")
      .def_ro("depth", &Report::depth,
              "m, depth of the vertex that is deepest inside another part; only \"penalty\" penetrates.")
      .def_ro("resolves", &Report::resolves, "Number of programs solved (\"penalty\": Newton steps).")
      .def_ro("iterations", &Report::iterations, "Number of pivots of all programs (\"impulse\": impulses).")
      .def_ro("status", &Report::status,
              "How the last program ended: \"not_needed\", \"solved\", \"infeasible\" or \"stalled\".")
      .def_ro("fraction", &Report::fraction, "Fraction of the wanted motion that the step made, 0 to 1.")
      .def_ro("lag", &Report::lag,
              "m, how far the part lags the pen: the distance of the two centers of mass, plus the part's radius\n"
              "times the angle between the two poses. With a weight it is the lag behind the pose to which the\n"
              "weight draws the part.")
      .def_ro("lag_reason", &Report::lag_reason,
              "Reason for the lag: \"none\", \"contact\", \"time\", \"capacity\" or \"suspended\".")
      .def_ro("unexplained_lag_ticks", &Report::unexplained_lag_ticks,
              "Number of ticks so far in which something other than a contact held the part back.")
      .def_ro("filtered", &Report::filtered,
              "Number of pairs that overlapped at the start and have not separated yet. Nothing keeps them apart.")
      .def_ro("shrunk", &Report::shrunk, "Number of pairs that touched at the start and have not separated yet.")
      .def_prop_ro(
          "timed_out", [](const Report& r) { return r.flags.timed_out; },
          "Whether time or work ran out before the tick was done.")
      .def_prop_ro(
          "overflow", [](const Report& r) { return r.flags.overflow; },
          "Whether a capacity was exceeded. The motion is still free.")
      .def_prop_ro(
          "input_ignored", [](const Report& r) { return r.flags.input_ignored; },
          "Whether the tick ignored an invalid pen pose or time.")
      .def_prop_ro(
          "scene_changed", [](const Report& r) { return r.flags.scene_changed; },
          "Whether this was the first tick in a changed scene.")
      .def_prop_ro(
          "part_changed", [](const Report& r) { return r.flags.part_changed; },
          "Whether that scene holds another part. The tick then did not follow the pen.")
      .def_prop_ro(
          "contact_wrench",
          [](const Report& r) -> nb::object {
            return r.contact_wrench ? nb::cast(to_array(*r.contact_wrench)) : nb::none();
          },
          nb::sig("def contact_wrench(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "Sum of the contact forces on the held part, (6,) float64: force (N), then torque (N m) about the part's\n"
          "center of mass, in the axes of the world and the lengths of the pen. None: not available, because the\n"
          "part is free or the resolver reports no forces.");
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
  nb::class_<SceneChange>(m, "Change", "A change of a running scene. Any thread may use it.")
      .def_prop_ro("number", &SceneChange::number,
                   "Number of the change, from 1 on. The number of a canceled change is used again.")
      .def_prop_ro(
          "state", [](const SceneChange& c) { return word(c.state()); },
          "Present state: \"pending\" (it waits for a tick, or until the held part is out of its way), \"in_force\",\n"
          "\"superseded\" (a later change came into force), \"replaced\" (by a later change while it was pending) or\n"
          "\"canceled\".")
      .def(
          "wait", [](const SceneChange& c, double seconds) { return word(c.wait(seconds)); }, nb::arg("seconds"),
          nb::call_guard<nb::gil_scoped_release>(),
          "Waits at most `seconds` until the change is no longer pending, and returns its state. Another thread must\n"
          "step the rig meanwhile. Other Python threads continue.")
      .def("cancel", &SceneChange::cancel, "Cancels the change. Returns False when it is no longer pending.");
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

constexpr char kRunDoc[] =
    R"(Steps until `seconds` after start(), or until request_stop().

Without a callback the loop runs in a thread that never waits for Python, and other Python threads continue. In real
time it steps at most once a period, with real-time priority where the system grants it. Ctrl-C ends it.

Parameters
----------
seconds : float
    Time at which the run ends, s since start().
callback : callable, optional
    Called as callback(rig) after each step. The next step waits for it; in real time the servo does not.

Raises
------
Error
    The rig does not run, or another thread steps it. The call also raises what the callback or a PythonPen raised,
    which ends the run.)";

constexpr char kChangeDoc[] =
    R"(Continues in another scene: with parts added, removed or moved, or with another part held.

The part held now continues from where it is, whatever pose `scene` gives it. Another held part starts at its pose in
`scene`, and the pen's present pose maps to it. A later change replaces one that is still pending. Any thread may call
it; the call builds the new scene, and the rig can step meanwhile.

Parameters
----------
scene : Scene
    Copied.

Returns
-------
Change
    Comes into force between two steps.

Raises
------
Error
    The contact loop cannot hold the scene. Then nothing changes.)";

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
      .def("start", &PythonRig::start,
           "Starts the device and its servo. Has no effect on a rig that runs. Raises Error with the cause, and what\n"
           "the first read() of a PythonPen raised.")
      .def("stop", &PythonRig::stop,
           "Switches the force off, and stops servo and device. Has no effect on a rig that does not run. Raises\n"
           "what a PythonPen raised.")
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
           "Runs `count` ticks. Each reads the pen, moves the part as near to it as the other parts allow, and\n"
           "publishes the result to the servo. Other Python threads continue meanwhile. Ctrl-C ends a call with\n"
           "several ticks. Raises Error when the rig does not run, and what a PythonPen raised.")
      .def("run", &PythonRig::run, nb::arg("seconds"), nb::arg("callback") = nb::none(),
           nb::sig("def run(self, seconds: float, callback: collections.abc.Callable[[Rig], object] | None = None) -> "
                   "None"),
           kRunDoc)
      .def("request_stop", &PythonRig::request_stop, "Ends run() after its present step. Any thread may call it.")
      .def("change", &PythonRig::change, nb::arg("scene"), kChangeDoc);
}

void bind_state(RigClass& c) {
  c.def_prop_ro(
       "part", [](const PythonRig& r) { return to_array(r.from_any_thread().part()); }, nb::rv_policy::automatic,
       "Pose X_WF of the held part's own frame, (4, 4) float64, m. Any thread may read it.")
      .def_prop_ro(
          "pen", [](const PythonRig& r) { return to_array(r.at_rest().pen().state.pose); }, nb::rv_policy::automatic,
          "Pose Y where the pen wants the held part's own frame, (4, 4) float64, m, world.")
      .def_prop_ro(
          "wrench", [](const PythonRig& r) { return to_array(r.at_rest().pen().wrench); }, nb::rv_policy::automatic,
          "Wrench on the pen, as rendered, (6,) float64: force (N), then torque (N m) about the held part's center\n"
          "of mass, in the axes of the world.")
      .def_prop_ro(
          "force_off",
          [](const PythonRig& r) -> std::optional<std::string> {
            const ForceOff reason = r.at_rest().pen().reason;
            if (reason == ForceOff::none) return std::nullopt;
            return to_string(reason);
          },
          "Why the device renders no force, in words. None: it renders force.")
      .def_prop_ro(
          "center", [](const PythonRig& r) { return to_array(r.at_rest().loop().center()); }, nb::rv_policy::automatic,
          "Center of mass of the held part, (3,) float64, m, in its own frame.")
      .def_prop_ro(
          "held", [](const PythonRig& r) { return r.from_any_thread().loop().held(); },
          "Name of the held part. Any thread may read it.")
      .def_prop_ro(
          "time", [](const PythonRig& r) { return r.at_rest().time(); }, "Time of the last step, s since start().")
      .def_prop_ro(
          "steps", [](const PythonRig& r) { return r.at_rest().steps(); }, "Number of steps since start().")
      .def_prop_ro(
          "connected", [](const PythonRig& r) { return r.at_rest().connected(); },
          "Whether there was a pen in the last step.")
      .def_prop_ro("report", &report, "Report of the last step; before the first one, of the start.")
      .def_prop_ro("contacts", &contacts, nb::sig("def contacts(self) -> numpy.typing.NDArray[numpy.void]"),
                   R"(Contacts of the last step: a structured array with one row for each contact.

Fields: `part` (number of the fixed part), `point_a` and `point_b` ((3,), m, world: on the held and on the fixed part),
`normal` ((3,), unit, from the fixed to the held part, world), `gap` (m), `force` (N, on the held part along `normal`;
nan: not available), `friction` ((3,), N, on the held part across `normal`, world), `slides` (the held part's point
slid), `ticks` (number of earlier ticks for which the contact has lasted), `kind_a`, `feature_a`, `kind_b` and
`feature_b` (kind and index of the nearest feature of each mesh: 0 vertex, 1 edge, 2 face), `began` (the contact is
new).)")
      .def_prop_ro("events", &events, nb::sig("def events(self) -> numpy.typing.NDArray[numpy.void]"),
                   "Contacts that began or ended in the last step: a structured array with the fields of `contacts`.\n"
                   "`began` is False for a contact that ended; its row has the state of the step before.")
      .def_prop_ro(
          "servo", &servo, nb::sig("def servo(self) -> dict[str, typing.Any]"),
          "Statistics of the servo since start(): `ticks`, `missed` (periods without a tick), `rate_hz`, and in us\n"
          "`late_us` and `compute_us` (each with p50, p99, p999, max). In simulated time only the ticks and their\n"
          "rate have a meaning. Any thread may read it.")
      .def_prop_ro(
          "missing_realtime", [](const PythonRig& r) { return r.at_rest().missing_realtime(); },
          "What the system did not grant to the servo or to run(), in one line; empty: it granted everything.")
      .def_prop_ro(
          "stability", [](const PythonRig& r) { return r.at_rest().stability(); },
          "The coupling's stiffness and its stability limits with this device, in one line; empty for a device in\n"
          "another process.");
}

}  // namespace

void bind_rig(nb::module_& m) {
  bind_report(m);
  bind_change(m);
  RigClass rig(m, "Rig", nb::type_slots(kSlots),
               R"(A scene, a pen, and everything between them: servo, shared memory, contact loop.

The pen carries the held part, the part stays out of the others, and the hand feels it through the pen. Use the rig in a
`with` statement, which starts and stops it.

One thread steps the rig. Where any thread may make a call, the docstring says so. All other calls raise Error while
another thread steps.

Parameters
----------
scene : Scene
    Copied.
pen : Pen
    ScriptPen or PythonPen.
clock : str
    "simulated": each step advances the time, and the same scene, pen and build give the same run, bit for bit. "real":
    the machine's clock; the servo has a thread of its own at 1 kHz.
period : float
    s between two steps, 1e-5 to 1: exactly, in simulated time; at least, in run() in real time.
device : str
    "shm:NAME": the device of another process (tegotae-device), in real time.

Raises
------
Error
    Parts overlap at the start (kind "overlap", with `part`), a setting is out of range (kind "setting"), or there is no
    such device (kind "device").)");
  bind_lifecycle(rig);
  bind_state(rig);
  m.attr("contact_dtype") = contact_type();
}

}  // namespace tegotae::python
