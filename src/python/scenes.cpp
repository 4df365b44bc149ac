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
          "Adds a part that stands at `pose`, (4, 4) X_WF in m (None: the identity). Returns its number, which "
          "contacts\n"
          "have in their field `part`.")
      .def(
          "add_held",
          [](Scene& s, const std::string& name, const Mesh& mesh, nb::handle pose, std::optional<double> mass) {
            return add(s, name, mesh, pose, true, mass);
          },
          nb::arg("name"), nb::arg("mesh"), nb::arg("pose") = nb::none(), nb::arg("mass") = nb::none(),
          nb::sig("def add_held(self, name: str, mesh: Mesh, pose: numpy.typing.ArrayLike | None = None, mass: float | "
                  "None = None) -> int"),
          "Adds the part that the pen holds, which starts at `pose`, (4, 4) X_WF in m. `mass` in kg, for `weight`; "
          "None:\n"
          "by volume and `density`.");
}

void bind_parts(nb::class_<Scene>& c) {
  c.def_prop_ro(
       "parts",
       [](const Scene& s) {
         std::vector<std::string> names;
         for (const Part& part : s.parts) names.push_back(part.name);
         return names;
       },
       "Names, in the order of their numbers.")
      .def_prop_ro(
          "held",
          [](const Scene& s) -> std::optional<std::string> {
            for (const Part& part : s.parts)
              if (part.held) return part.name;
            return std::nullopt;
          },
          "Name of the part that the pen holds; None: none yet.")
      .def("hold", &hold, nb::arg("name"), "The pen holds this part instead.")
      .def(
          "pose", [](Scene& s, const std::string& name) { return to_array(find(s, name).pose); }, nb::arg("name"),
          "(4, 4) float64, X_WF, m, of the part `name`.")
      .def(
          "mesh", [](Scene& s, const std::string& name) { return Mesh(find(s, name).mesh); }, nb::arg("name"),
          "Of the part `name`.")
      .def(
          "move",
          [](Scene& s, const std::string& name, nb::handle pose) { find(s, name).pose = pose_of(pose, "pose"); },
          nb::arg("name"), nb::arg("pose"), nb::sig("def move(self, name: str, pose: numpy.typing.ArrayLike) -> None"),
          "Puts the part `name` at `pose`, (4, 4) X_WF in m.")
      .def(
          "remove",
          [](Scene& s, const std::string& name) {
            const Part* const part = &find(s, name);
            s.parts.erase(s.parts.begin() + (part - s.parts.data()));
          },
          nb::arg("name"), "Takes the part `name` out; the numbers of those behind it are less by one.")
      .def(
          "copy", [](const Scene& s) { return Scene(s); }, "A scene of its own; meshes are shared.");
}

void bind_contact_settings(nb::class_<Scene>& c) {
  number(
      c, "l_min", [](Scene & s) -> auto& { return s.contact.l_min; },
      "m: contact below this gap, half of it is kept. None: 4 to 20 um, by the clearance that is found.");
  number(
      c, "tick_budget", [](Scene & s) -> auto& { return s.contact.tick_budget; },
      "s that a tick in real time may take; what is not done by then is left for the next one.");
  number(
      c, "touch_tolerance", [](Scene & s) -> auto& { return s.contact.touch_tolerance; },
      "m: parts apart or overlapping by up to this at the start touch.");
  number(
      c, "density", [](Scene & s) -> auto& { return s.contact.density; }, "kg/m3, of the held part.");
  c.def_prop_rw(
       "resolver", [](const Scene& s) { return to_string(s.contact.resolver); },
       [](Scene& s, const std::string& name) { s.contact.resolver = resolver_kind(name); },
       "\"qp\", \"lp\" (the paper's), or the baselines \"impulse\" and \"penalty\".")
      .def_prop_rw(
          "ignore_initial_overlap", [](const Scene& s) { return s.contact.initial_overlap == InitialOverlap::ignore; },
          [](Scene& s, bool on) { s.contact.initial_overlap = on ? InitialOverlap::ignore : InitialOverlap::refuse; },
          "Whether a part that the held one overlaps at the start is ignored until the two have come apart, instead "
          "of\n"
          "an Error.");
}

void bind_feel(nb::class_<Scene>& c) {
  number(
      c, "friction", [](Scene & s) -> auto& { return s.friction.mu; },
      "Coulomb's coefficient, 0 to 10, of all pairs that set_friction() does not name (resolver \"qp\").");
  c.def(
      "set_friction",
      [](Scene& s, const std::string& a, const std::string& b, double mu) {
        find(s, a);
        find(s, b);
        s.friction.pairs.push_back({a, b, mu});
      },
      nb::arg("a"), nb::arg("b"), nb::arg("mu"), "Coulomb's coefficient, 0 to 10, of the parts `a` and `b`.");
  number(
      c, "stiffness", [](Scene & s) -> auto& { return s.coupling.stiffness; }, "N/m, of the spring to the pen.");
  number(
      c, "damping", [](Scene & s) -> auto& { return s.coupling.damping; }, "N s/m.");
  number(
      c, "torsional_stiffness", [](Scene & s) -> auto& { return s.coupling.torsional_stiffness; },
      "N m/rad; without effect where `max_torsional_stiffness` is set.");
  number(
      c, "torsional_damping", [](Scene & s) -> auto& { return s.coupling.torsional_damping; }, "N m s/rad.");
  number(
      c, "max_torsional_stiffness", [](Scene & s) -> auto& { return s.max_torsional_stiffness; },
      "N m/rad: when set, the torsional stiffness is fitted to the held part, up to this.");
  number(
      c, "scale", [](Scene & s) -> auto& { return s.scale; }, "m that the part moves for a m of the pen, 0.01 to 100.");
  number(
      c, "weight", [](Scene & s) -> auto& { return s.weight.on; }, "Whether the hand feels the held part's weight.");
  c.def_prop_rw(
      "gravity", [](const Scene& s) { return to_array(s.weight.gravity); },
      [](Scene& s, nb::handle g) { s.weight.gravity = vector_of(g, "gravity"); },
      nb::for_getter(nb::rv_policy::automatic),
      nb::for_setter(nb::sig("def gravity(self, value: numpy.typing.ArrayLike) -> None")),
      "(3,) float64, m/s2, world.");
}

}  // namespace

void bind_scenes(nb::module_& m) {
  nb::class_<Scene> scene(m, "Scene", R"(The parts of a mock-up and the settings of its loops.

One part is held by the pen, the others are fixed. Poses are (4, 4) arrays X_WF: from the part's own frame to the
world, lengths in m. Rigs and runs copy what they are given, so a scene may be changed and used again. One thread at a
time.)");
  bind_adding(scene);
  bind_parts(scene);
  bind_contact_settings(scene);
  bind_feel(scene);
  nb::class_<SceneFile>(m, "SceneFile", "What a scene file says: the scene, the pen, and what moves it.")
      .def_ro("path", &SceneFile::path, "Of the file.")
      .def_rw("scene", &SceneFile::scene, "Parts and settings; changes are made in place.")
      .def_ro("files", &SceneFile::files, "All that was read: the file itself, meshes, the script.")
      .def_prop_ro(
          "duration", [](const SceneFile& f) { return f.script.end() - f.script.begin(); }, "s, of the script.")
      .def(
          "pen", [](const SceneFile& f) { return ScriptPen(f.device, f.script); },
          "The simulated pen whose hand follows the file's script.");
  m.def(
      "load_scene",
      [](nb::handle path, const std::string& hold, bool trusted) { return read_scene_file(path, hold, trusted); },
      nb::arg("path"), nb::kw_only(), nb::arg("hold") = "", nb::arg("trusted") = false,
      nb::sig("def load_scene(path: str | os.PathLike[str], *, hold: str = '', trusted: bool = False) -> SceneFile"),
      R"(Reads a scene file (TOML) and the meshes that it names.

Other Python threads go on meanwhile.

Parameters
----------
path : str or os.PathLike
hold : str
    Name of the part to hold, instead of the file's.
trusted : bool
    As in load_mesh().

Raises
------
Error
    kind "file", with `file`, `line` and `key`: an unknown key, a wrong type, a missing file, an impossible value.)");
}

}  // namespace tegotae::python
