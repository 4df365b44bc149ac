// Scenes in memory and in files.
#include "python/scenes.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <filesystem>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/loading.hpp"
#include "python/mesh.hpp"
#include "python/pen.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/resolve/kind.hpp"

namespace tegotae::python {

SceneFile read_scene_file(nb::handle path, const std::string& hold, bool trusted) {
  const std::string name = nb::cast<std::filesystem::path>(path).string();
  SceneOptions how;
  how.hold = hold;
  how.load = mesh_loader(trusted);
  const nb::gil_scoped_release others_go_on;
  return load_scene(name, how);
}

namespace {

Part& find(Scene& scene, const std::string& name) {
  for (Part& part : scene.parts)
    if (part.name == name) return part;
  std::string known;
  for (const Part& part : scene.parts) known += (known.empty() ? "" : ", ") + part.name;
  throw Error(ErrorKind::setting, "there is no part \"" + name + "\"; there are: " + known, {{}, 0, {}, name});
}

int add(Scene& scene, const std::string& name, const Mesh& mesh, nb::handle pose, bool held,
        std::optional<double> mass = {}) {
  Part part{name, mesh.shared, pose_of(pose, "pose"), held};
  part.mass = mass;
  scene.parts.push_back(std::move(part));
  return static_cast<int>(scene.parts.size()) - 1;
}

}  // namespace

void hold(Scene& scene, const std::string& name) {
  find(scene, name);
  for (Part& part : scene.parts) part.held = part.name == name;
}

namespace {

/// A number of the scene: read and written.
template <class Class, class Get>
void number(Class& c, const char* name, Get get, const char* doc) {
  using Value = std::remove_reference_t<decltype(get(std::declval<Scene&>()))>;
  c.def_prop_rw(
      name, [get](Scene& s) -> Value { return get(s); }, [get](Scene& s, Value value) { get(s) = value; }, doc);
}

void bind_adding(nb::class_<Scene>& c) {
  c.def(nb::init<>())
      .def(
          "add_fixed",
          [](Scene& s, const std::string& name, const Mesh& mesh, nb::handle pose) {
            return add(s, name, mesh, pose, false);
          },
          nb::arg("name"), nb::arg("mesh"), nb::arg("pose") = nb::none(),
          nb::sig("def add_fixed(self, name: str, mesh: Mesh, pose: numpy.typing.ArrayLike | None = None) -> int"),
          "Adds a fixed part at `pose`, (4, 4) X_WF, m (None: the identity). `name` is unique in the scene. Returns\n"
          "the part's number, which contacts have in their field `part`. Raises Error (kind \"setting\") when the\n"
          "pose is not rigid, not finite, or beyond 10 km.")
      .def(
          "add_held",
          [](Scene& s, const std::string& name, const Mesh& mesh, nb::handle pose, std::optional<double> mass) {
            return add(s, name, mesh, pose, true, mass);
          },
          nb::arg("name"), nb::arg("mesh"), nb::arg("pose") = nb::none(), nb::arg("mass") = nb::none(),
          nb::sig("def add_held(self, name: str, mesh: Mesh, pose: numpy.typing.ArrayLike | None = None, mass: float | "
                  "None = None) -> int"),
          "Adds the part that the pen holds; it starts at `pose`, (4, 4) X_WF, m (None: the identity). `name` is\n"
          "unique in the scene. `mass` (kg) is for `weight`; None: from volume and `density`. Returns the part's\n"
          "number. Raises Error (kind \"setting\") when the pose is not rigid, not finite, or beyond 10 km.");
}

void bind_parts(nb::class_<Scene>& c) {
  c.def_prop_ro(
       "parts",
       [](const Scene& s) {
         std::vector<std::string> names;
         for (const Part& part : s.parts) names.push_back(part.name);
         return names;
       },
       "Names of the parts, in the order of their numbers.")
      .def_prop_ro(
          "held",
          [](const Scene& s) -> std::optional<std::string> {
            for (const Part& part : s.parts)
              if (part.held) return part.name;
            return std::nullopt;
          },
          "Name of the part that the pen holds. None: the scene holds no part yet.")
      .def("hold", &hold, nb::arg("name"),
           "Makes the pen hold the part `name` instead. Raises Error when there is no such part.")
      .def(
          "pose", [](Scene& s, const std::string& name) { return to_array(find(s, name).pose); }, nb::arg("name"),
          "Returns the pose X_WF of the part `name`, (4, 4) float64, m. Raises Error when there is no such part.")
      .def(
          "mesh", [](Scene& s, const std::string& name) { return Mesh(find(s, name).mesh); }, nb::arg("name"),
          "Returns the mesh of the part `name`. Raises Error when there is no such part.")
      .def(
          "move",
          [](Scene& s, const std::string& name, nb::handle pose) { find(s, name).pose = pose_of(pose, "pose"); },
          nb::arg("name"), nb::arg("pose"), nb::sig("def move(self, name: str, pose: numpy.typing.ArrayLike) -> None"),
          "Moves the part `name` to `pose`, (4, 4) X_WF, m. Raises Error when there is no such part, or the pose is\n"
          "not rigid, not finite, or beyond 10 km.")
      .def(
          "remove",
          [](Scene& s, const std::string& name) {
            const Part* const part = &find(s, name);
            s.parts.erase(s.parts.begin() + (part - s.parts.data()));
          },
          nb::arg("name"),
          "Removes the part `name`. The numbers of the parts after it decrease by one. Raises Error when there is no\n"
          "such part.")
      .def(
          "copy", [](const Scene& s) { return Scene(s); }, "Returns an independent scene. The two share their meshes.");
}

void bind_contact_settings(nb::class_<Scene>& c) {
  number(
      c, "l_min", [](Scene & s) -> auto& { return s.contact.l_min; },
      "m: a pair with a gap below this is a contact, and the loop keeps half of it. None: the loop adapts it, 4 to\n"
      "20 um, to the clearance that it finds.");
  number(
      c, "tick_budget", [](Scene & s) -> auto& { return s.contact.tick_budget; },
      "s: time that a tick may take in real time; the next tick does what remains. Has no effect in simulated time.");
  number(
      c, "helper_threads", [](Scene & s) -> auto& { return s.contact.helper_threads; },
      "Threads, 0 to 64, that share the work of a tick in real time where thousands of triangles lie on others. None:\n"
      "one fewer than the processors that the process may use, at most 7. Has no effect in simulated time.");
  number(
      c, "touch_tolerance", [](Scene & s) -> auto& { return s.contact.touch_tolerance; },
      "m: parts with a gap or an overlap of up to this at the start touch.");
  number(
      c, "density", [](Scene & s) -> auto& { return s.contact.density; }, "Density of the held part, kg/m3.");
  c.def_prop_rw(
       "resolver", [](const Scene& s) { return to_string(s.contact.resolver); },
       [](Scene& s, const std::string& name) { s.contact.resolver = resolver_kind(name); },
       "Method that resolves contacts: \"qp\", \"lp\" (the paper's linear program), or the baselines \"impulse\" and\n"
       "\"penalty\". Raises Error when it is set to another name.")
      .def_prop_rw(
          "ignore_initial_overlap", [](const Scene& s) { return s.contact.initial_overlap == InitialOverlap::ignore; },
          [](Scene& s, bool on) { s.contact.initial_overlap = on ? InitialOverlap::ignore : InitialOverlap::refuse; },
          "Treatment of a part that the held part overlaps at the start. True: nothing keeps the two apart until\n"
          "they have once separated. False: a rig raises Error (kind \"overlap\").");
}

void bind_feel(nb::class_<Scene>& c) {
  number(
      c, "friction", [](Scene & s) -> auto& { return s.friction.mu; },
      "Coulomb's coefficient of friction of pairs that set_friction() does not name, 0 to 10 (resolver \"qp\").");
  c.def(
      "set_friction",
      [](Scene& s, const std::string& a, const std::string& b, double mu) {
        find(s, a);
        find(s, b);
        s.friction.pairs.push_back({a, b, mu});
      },
      nb::arg("a"), nb::arg("b"), nb::arg("mu"),
      "Sets Coulomb's coefficient of friction of the parts `a` and `b`, 0 to 10. The last call for a pair counts.\n"
      "Raises Error when there is no such part.");
  number(
      c, "stiffness", [](Scene & s) -> auto& { return s.coupling.stiffness; },
      "Stiffness of the spring between part and pen, N/m.");
  number(
      c, "damping", [](Scene & s) -> auto& { return s.coupling.damping; }, "Damping between part and pen, N s/m.");
  number(
      c, "torsional_stiffness", [](Scene & s) -> auto& { return s.coupling.torsional_stiffness; },
      "Torsional stiffness between part and pen, N m/rad. Has no effect while `max_torsional_stiffness` is set.");
  number(
      c, "torsional_damping", [](Scene & s) -> auto& { return s.coupling.torsional_damping; },
      "Torsional damping between part and pen, N m s/rad.");
  number(
      c, "max_torsional_stiffness", [](Scene & s) -> auto& { return s.max_torsional_stiffness; },
      "N m/rad: when this is set, the loop fits the torsional stiffness to the held part, up to this value.");
  number(
      c, "scale", [](Scene & s) -> auto& { return s.scale; },
      "Meters that the part moves for a meter of the pen, 0.01 to 100.");
  number(
      c, "weight", [](Scene & s) -> auto& { return s.weight.on; },
      "Whether the hand feels the held part's weight (resolver \"qp\").");
  c.def_prop_rw(
      "gravity", [](const Scene& s) { return to_array(s.weight.gravity); },
      [](Scene& s, nb::handle g) { s.weight.gravity = vector_of(g, "gravity"); },
      nb::for_getter(nb::rv_policy::automatic),
      nb::for_setter(nb::sig("def gravity(self, value: numpy.typing.ArrayLike) -> None")),
      "Gravity, (3,) float64, m/s2, world.");
}

}  // namespace

void bind_scenes(nb::module_& m) {
  nb::class_<Scene> scene(m, "Scene", R"(Parts of a mock-up, and the settings of its loops.

The pen holds one part; the others are fixed. Poses are (4, 4) arrays X_WF, from the part's own frame to the world, with
lengths in m. Rigs and runs copy the scene, so you may change it and use it again. They also check the settings: a value
out of range raises Error (kind "setting") there. Use a scene in one thread at a time.)");
  bind_adding(scene);
  bind_parts(scene);
  bind_contact_settings(scene);
  bind_feel(scene);
  nb::class_<SceneFile>(m, "SceneFile", "Contents of a scene file: the scene, the pen, and what moves it.")
      .def_ro("path", &SceneFile::path, "Path of the file.")
      .def_rw("scene", &SceneFile::scene, "Parts and settings. Changes to it change this object.")
      .def_ro("files", &SceneFile::files,
              "Paths of all files that were read: the scene file itself, the meshes, the script.")
      .def_prop_ro(
          "duration", [](const SceneFile& f) { return f.script.end() - f.script.begin(); },
          "Duration of the script, s.")
      .def(
          "pen", [](const SceneFile& f) { return ScriptPen(f.device, f.script); },
          "Returns the simulated pen of the file. Its hand follows the file's script.");
  m.def(
      "load_scene",
      [](nb::handle path, const std::string& hold, bool trusted) { return read_scene_file(path, hold, trusted); },
      nb::arg("path"), nb::kw_only(), nb::arg("hold") = "", nb::arg("trusted") = false,
      nb::sig("def load_scene(path: str | os.PathLike[str], *, hold: str = '', trusted: bool = False) -> SceneFile"),
      R"(Reads a scene file (TOML) and the meshes that it names.

Other Python threads continue meanwhile.

Parameters
----------
path : str or os.PathLike
hold : str
    Name of the part to hold instead of the file's; empty: the file's.
trusted : bool
    As in load_mesh().

Returns
-------
SceneFile

Raises
------
Error
    kind "file", with `file`, `line` and `key`: an unknown key, a wrong type, a missing file, an impossible value, or a
    mesh that cannot be used.)");
}

}  // namespace tegotae::python
