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
  nb::class_<ScriptPen, Pen> c(m, "ScriptPen", R"(A pen without hardware: a body that a hand holds and the force pushes.

The hand follows a script: between two times its position goes linearly and its rotation at a constant rate. Each rig
begins at the script's first time. Same script, settings and steps give the same bits.

Parameters
----------
times : (n,) array of float
    s, increasing.
poses : (n, 4, 4) array of float
    X_WF, m: where the hand wants the held part's own frame to be.

Raises
------
Error
    Another shape, numbers that are not finite, no rotations, times that do not increase.)");
  c.def(
       "__init__",
       [](ScriptPen* self, nb::handle times, nb::handle poses) { new (self) ScriptPen({}, script_of(times, poses)); },
       nb::arg("times"), nb::arg("poses"),
       nb::sig("def __init__(self, times: numpy.typing.ArrayLike, poses: numpy.typing.ArrayLike) -> None"))
      .def_static(
          "read", [](const std::filesystem::path& path) { return ScriptPen({}, read_script(path.string())); },
          nb::arg("path"), nb::sig("def read(path: str | os.PathLike[str]) -> ScriptPen"),
          "The script of a CSV file with the columns t,px,py,pz,qw,qx,qy,qz (s, m). Raises Error with file and line.")
      .def_prop_ro(
          "begin", [](const ScriptPen& p) { return p.script.begin(); }, "s, of the script.")
      .def_prop_ro(
          "end", [](const ScriptPen& p) { return p.script.end(); }, "s, of the script.")
      .def(
          "target", [](const ScriptPen& p, double t) { return to_array(p.script.pose(t)); }, nb::arg("t"),
          "(4, 4) float64, X_WF, m: where the hand wants the part at `t` (s).");
  number(
      c, "hand_stiffness", [](auto& s) -> auto& { return s.hand.stiffness; }, "N/m, of the hand's grip.");
  number(
      c, "hand_damping", [](auto& s) -> auto& { return s.hand.damping; }, "N s/m.");
  number(
      c, "hand_torsional_stiffness", [](auto& s) -> auto& { return s.hand.torsional_stiffness; }, "N m/rad.");
  number(
      c, "hand_torsional_damping", [](auto& s) -> auto& { return s.hand.torsional_damping; }, "N m s/rad.");
  number(
      c, "hand_mass", [](auto& s) -> auto& { return s.hand.mass; }, "kg, that moves with the pen.");
  number(
      c, "mass", [](auto& s) -> auto& { return s.mass; }, "kg, apparent, of the pen.");
  number(
      c, "friction", [](auto& s) -> auto& { return s.friction; }, "N, Coulomb friction of the pen.");
  number(
      c, "continuous_force", [](auto& s) -> auto& { return s.continuous_force; },
      "N, what its motors stand for long; 0: not limited.");
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
  nb::class_<PythonPen, Pen>(m, "PythonPen", nb::type_slots(kSlots), R"(A pen that is written in Python.

In real time a Python thread of its own calls `hand.write(wrench)` and `hand.read()` in turn, up to `rate` times a
second, and meets the servo in a mailbox: the servo goes on at 1 kHz with the newest pose and never waits for Python.
`rate` then tells what was reached. Without a new pose for 20 ms the force fades out. In simulated time both are called
once a servo tick, in the thread that steps.

What they raise ends the pen: the force goes off, and the rig's next step(), run() or stop() raises it.

Parameters
----------
hand : object
    With `read() -> (4, 4)`: X_WF, m, where the pen wants the held part's own frame; and, for a pen that renders force,
    `write(wrench)`: (6,) float64, force (N) and torque (N m) on the pen at the held part's center of mass, world axes.
rate : float
    Hz, 50 to 4000: how often Python is asked at most.
max_force, max_torque : float
    N and N m, peak, that it renders.
continuous_force : float
    N, that it renders for long; 0: not limited.)")
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
          "Hz at which Python answered in the last quarter of a second or so; 0 before that. From any thread.")
      .def_prop_ro(
          "samples", [](const PythonPen& p) { return p.hand().samples(); },
          "Poses read since the rig started. From any thread.");
}

}  // namespace

void bind_pens(nb::module_& m) {
  nb::class_<Pen>(m, "Pen", "What moves the held part and renders the force: ScriptPen, PythonPen.");
  bind_script_pen(m);
  bind_python_pen(m);
}

}  // namespace tegotae::python
