// What moves the held part: a script, or an object in Python.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

#include <filesystem>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/pen.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::python {
namespace {

StylusScript script_of(nb::handle times, nb::handle poses) {
  const Numbers t = numbers(times, {-1}, "times"), X = numbers(poses, {-1, 4, 4}, "poses");
  if (t.rows != X.rows)
    throw Error(ErrorKind::setting,
                "ScriptPen: there are " + std::to_string(t.rows) + " times and " + std::to_string(X.rows) + " poses");
  std::vector<StylusScript::Key> keys;
  for (std::size_t i = 0; i < t.rows; ++i)
    keys.push_back({t.data[i], pose_of(X.data + 16 * i, "poses[" + std::to_string(i) + "]")});
  return StylusScript(std::move(keys));
}

/// A setting of the simulated pen or its hand.
template <class Get>
void number(nb::class_<ScriptPen, Pen>& c, const char* name, Get get, const char* doc) {
  c.def_prop_rw(
      name, [get](ScriptPen& p) { return get(p.settings); },
      [get](ScriptPen& p, double value) { get(p.settings) = value; }, doc);
}

void bind_script_pen(nb::module_& m) {
  nb::class_<ScriptPen, Pen> c(m, "ScriptPen",
                               R"(A pen without hardware: a rigid body that a hand and the rendered force push.

The hand follows a script: between two times the position moves linearly and the rotation at a constant rate. Before the
first and after the last time the hand rests. Each rig starts at the script's first time. The same script, settings and
steps give the same bits. A rig raises Error (kind "setting") when it is made with a setting out of range.

Parameters
----------
times : (n,) array of float
    s, increasing.
poses : (n, 4, 4) array of float
    X_WF, m: where the hand wants the held part's own frame to be.

Raises
------
Error
    kind "setting": an array has another shape, a number is not finite, a pose is not rigid or lies beyond 10 km, or the
    times do not increase.)");
  c.def(
       "__init__",
       [](ScriptPen* self, nb::handle times, nb::handle poses) { new (self) ScriptPen({}, script_of(times, poses)); },
       nb::arg("times"), nb::arg("poses"),
       nb::sig("def __init__(self, times: numpy.typing.ArrayLike, poses: numpy.typing.ArrayLike) -> None"))
      .def_static(
          "read", [](const std::filesystem::path& path) { return ScriptPen({}, read_script(path.string())); },
          nb::arg("path"), nb::sig("def read(path: str | os.PathLike[str]) -> ScriptPen"),
          "Returns a pen with the script of a CSV file with the columns t,px,py,pz,qw,qx,qy,qz (s, m). Raises Error\n"
          "(kind \"file\") with `file` and `line`.")
      .def_prop_ro(
          "begin", [](const ScriptPen& p) { return p.script.begin(); }, "First time of the script, s.")
      .def_prop_ro(
          "end", [](const ScriptPen& p) { return p.script.end(); }, "Last time of the script, s.")
      .def(
          "target", [](const ScriptPen& p, double t) { return to_array(p.script.pose(t)); }, nb::arg("t"),
          "Returns where the hand wants the held part's own frame at `t` (s): X_WF, (4, 4) float64, m.");
  number(
      c, "hand_stiffness", [](auto& s) -> auto& { return s.hand.stiffness; }, "Stiffness of the hand's grip, N/m.");
  number(
      c, "hand_damping", [](auto& s) -> auto& { return s.hand.damping; },
      "Damping of the hand's grip, N s/m, on the difference to the script's velocity.");
  number(
      c, "hand_torsional_stiffness", [](auto& s) -> auto& { return s.hand.torsional_stiffness; },
      "Torsional stiffness of the hand's grip, N m/rad.");
  number(
      c, "hand_torsional_damping", [](auto& s) -> auto& { return s.hand.torsional_damping; },
      "Torsional damping of the hand's grip, N m s/rad.");
  number(
      c, "hand_mass", [](auto& s) -> auto& { return s.hand.mass; },
      "Effective mass of the hand, which moves with the pen, kg.");
  number(
      c, "mass", [](auto& s) -> auto& { return s.mass; }, "Apparent mass of the pen, kg.");
  number(
      c, "friction", [](auto& s) -> auto& { return s.friction; }, "Coulomb friction of the pen, N.");
  number(
      c, "continuous_force", [](auto& s) -> auto& { return s.continuous_force; },
      "Force that the pen's motors can sustain, N; 0: unbounded.");
}

int visit(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<PythonPen>(self)->hand().hand().ptr());
  return 0;
}

int clear(PyObject* self) {
  PythonDevice& hand = nb::inst_ptr<PythonPen>(self)->hand();
  hand.stop();
  hand.forget();
  return 0;
}

PyType_Slot kSlots[] = {
    {Py_tp_traverse, reinterpret_cast<void*>(visit)}, {Py_tp_clear, reinterpret_cast<void*>(clear)}, {0, nullptr}};

void bind_python_pen(nb::module_& m) {
  nb::class_<PythonPen, Pen>(m, "PythonPen", nb::type_slots(kSlots),
                             R"(A pen written in Python. One rig at a time can run it.

In real time a Python thread of its own calls `hand.write(wrench)` and `hand.read()` in turn, up to `rate` times a
second. It exchanges data with the servo through a mailbox. The servo continues at 1 kHz with the newest pose and never
waits for Python. Without a new pose for 20 ms the force fades out. In simulated time the thread that steps calls both
methods once a servo tick.

An exception in either method ends the pen: the force goes off, and the rig's next step(), run() or stop() raises it.

Parameters
----------
hand : object
    Has a method `read()`, which returns where the pen wants the held part's own frame: X_WF, (4, 4), m. For a pen that
    renders force it also has a method `write(wrench)`. `wrench` is (6,) float64: force (N), then torque (N m) on the
    pen at the held part's center of mass, in the axes of the world.
rate : float
    Largest number of calls of each method in a second, 50 to 4000 Hz.
max_force, max_torque : float
    Peak force (N) and torque (N m) that the pen renders.
continuous_force : float
    Force that the pen can sustain, N; 0: unbounded.

Raises
------
Error
    kind "setting": the rate is out of range, or `hand` has no method read().)")
      .def(
          "__init__",
          [](PythonPen* self, nb::object hand, double rate, double force, double torque, double continuous) {
            new (self) PythonPen(std::move(hand), {rate, {force, torque}, continuous});
          },
          nb::arg("hand"), nb::arg("rate") = PythonDeviceSettings().rate, nb::kw_only(),
          nb::arg("max_force") = WrenchLimits().force, nb::arg("max_torque") = WrenchLimits().torque,
          nb::arg("continuous_force") = PythonDeviceSettings().continuous_force,
          nb::sig("def __init__(self, hand: typing.Any, rate: float = 1000.0, *, max_force: float = 8.5, max_torque: "
                  "float = 0.188, continuous_force: float = 1.4) -> None"))
      .def_prop_ro(
          "rate", [](const PythonPen& p) { return p.hand().rate(); },
          "Rate that Python reached in the last quarter of a second or so, Hz; 0 before that. Any thread may read it.")
      .def_prop_ro(
          "samples", [](const PythonPen& p) { return p.hand().samples(); },
          "Number of poses read since the rig started. Any thread may read it.");
}

}  // namespace

void bind_pens(nb::module_& m) {
  nb::class_<Pen>(m, "Pen",
                  "Base class of pens, which move the held part and render the force: ScriptPen and PythonPen.");
  bind_script_pen(m);
  bind_python_pen(m);
}

}  // namespace tegotae::python
