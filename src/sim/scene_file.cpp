#include "tegotae/sim/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "resolve/resolver.hpp"
#include "sim/contact_loop.hpp"
#include "sim/toml_table.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

/// Runs `f`; an Error it throws becomes one about `key`.
template <typename F>
auto about(const TomlTable& t, const char* key, F f) {
  try {
    return f();
  } catch (const Error& e) {
    t.fail(key, e.what());
  }
}

/// The path under `key`, relative to the folder of the scene file; it must be a file.
std::string file_under(const TomlTable& t, const char* key, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / t.text(key);
  if (!std::filesystem::exists(file)) t.fail(key, file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file)) t.fail(key, file.string() + ": not a file");
  return file.string();
}

/// R = Rz(yaw) Ry(pitch) Rx(roll), angles in degrees.
Quat from_roll_pitch_yaw(const std::vector<double>& rpy_deg) {
  const double to_rad = std::acos(-1.0) / 180;
  return (Eigen::AngleAxisd(rpy_deg[2] * to_rad, Vec3::UnitZ()) *
          Eigen::AngleAxisd(rpy_deg[1] * to_rad, Vec3::UnitY()) * Eigen::AngleAxisd(rpy_deg[0] * to_rad, Vec3::UnitX()))
      .normalized();
}

/// Length (m) of the unit under "unit".
double read_unit(const TomlTable& t, const char* fallback) {
  const std::string name = t.text("unit", fallback);
  return about(t, "unit", [&] { return unit_length(name); });
}

Pose read_pose(const TomlTable& t) {
  Pose X;
  if (t.has("position")) X.p = Vec3(t.numbers("position", 3).data());
  if (t.has("orientation") && t.has("rpy_deg")) t.fail("rpy_deg", "give either orientation or rpy_deg");
  if (t.has("rpy_deg")) X.q = from_roll_pitch_yaw(t.numbers("rpy_deg", 3));
  if (t.has("orientation")) {
    const std::vector<double> q = t.numbers("orientation", 4);
    X.q = Quat(q[0], q[1], q[2], q[3]);
    const double norm = X.q.norm();
    if (!(norm > 0) || !std::isfinite(norm)) t.fail("orientation", "must be a quaternion w, x, y, z other than zero");
    X.q.coeffs() /= norm;
  }
  return X;
}

void read_parts(const TomlTable& top, const std::filesystem::path& folder, const MeshLoader& load, Scene& scene) {
  const double default_unit = read_unit(top, "m");
  std::map<std::pair<std::string, double>, std::shared_ptr<const TriangleMesh>> meshes;
  std::set<std::string> names;
  std::string held;
  for (const TomlTable& t :
       top.tables("part", {"name", "mesh", "unit", "held", "position", "orientation", "rpy_deg"})) {
    Part part;
    part.name = t.text("name");
    if (!names.insert(part.name).second) t.fail("name", "another part is named " + part.name);
    part.held = t.flag("held", false);
    if (part.held && !held.empty()) t.fail("held", "part " + held + " is held already; exactly one part is");
    if (part.held) held = part.name;
    part.pose = read_pose(t);
    const double unit = t.has("unit") ? read_unit(t, "m") : default_unit;
    const std::string file = file_under(t, "mesh", folder);
    auto& mesh = meshes[{file, unit}];
    if (!mesh) about(t, "mesh", [&] { mesh = std::make_shared<TriangleMesh>(load(file, unit)); });
    part.mesh = mesh;
    scene.parts.push_back(std::move(part));
  }
  if (scene.parts.empty()) top.fail("part", "the scene has no [[part]]");
  if (held.empty()) top.fail("part", "no part is held; give one of them held = true");
}

std::string one_of(const TomlTable& t, const char* key, const std::string& otherwise,
                   const std::vector<std::string>& known) {
  const std::string value = t.text(key, otherwise);
  if (std::find(known.begin(), known.end(), value) != known.end()) return value;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  t.fail(key, "unknown " + std::string(key) + " " + value + " (known: " + list + ")");
}

void read_contact(const TomlTable& t, ContactSettings& s) {
  s.l_min = t.positive("l_min", s.l_min);
  s.l_0 = t.positive("l_0", s.l_0);
  s.density = t.positive("density", s.density);
  s.tick_budget = t.positive("tick_budget", s.tick_budget);
  s.resolver = one_of(t, "resolver", s.resolver, resolver_names());
  s.narrowphase = one_of(t, "narrowphase", s.narrowphase, narrowphase_names());
}

void read_coupling(const TomlTable& t, CouplingSettings& s) {
  s.stiffness = t.positive("stiffness", s.stiffness);
  s.damping = t.at_least_zero("damping", s.damping);
  s.torsional_stiffness = t.positive("torsional_stiffness", s.torsional_stiffness);
  s.torsional_damping = t.at_least_zero("torsional_damping", s.torsional_damping);
}

SimulatedDeviceSettings read_device(const TomlTable& t) {
  SimulatedDeviceSettings s;
  const std::string type = t.text("type", "simulated");
  if (type != "simulated") t.fail("type", "unknown device type " + type + " (known: simulated)");
  const TomlTable hand =
      t.table("hand", {"stiffness", "damping", "torsional_stiffness", "torsional_damping", "mass", "inertia"});
  s.hand.stiffness = hand.positive("stiffness", s.hand.stiffness);
  s.hand.damping = hand.at_least_zero("damping", s.hand.damping);
  s.hand.torsional_stiffness = hand.positive("torsional_stiffness", s.hand.torsional_stiffness);
  s.hand.torsional_damping = hand.at_least_zero("torsional_damping", s.hand.torsional_damping);
  s.hand.mass = hand.at_least_zero("mass", s.hand.mass);
  s.hand.inertia = hand.at_least_zero("inertia", s.hand.inertia);
  return s;
}

}  // namespace

SceneFile load_scene(const std::string& path, const MeshLoader& load) {
  const toml::table parsed = parse_toml(path);
  const TomlTable top(parsed, path, "", {"unit", "part", "contact", "coupling", "device"});
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  Scene scene;
  // Settings first: a mistake in them need not wait for large meshes.
  read_contact(top.table("contact", {"l_min", "l_0", "resolver", "narrowphase", "tick_budget", "density"}),
               scene.contact);
  read_coupling(top.table("coupling", {"stiffness", "damping", "torsional_stiffness", "torsional_damping"}),
                scene.coupling);
  const TomlTable device = top.table("device", {"type", "hand", "script"});
  const SimulatedDeviceSettings settings = read_device(device);
  const std::string script_file = file_under(device, "script", folder);
  StylusScript script = about(device, "script", [&] { return read_script(script_file); });
  read_parts(top, folder, load, scene);
  return {path, std::move(scene), settings, std::move(script)};
}

}  // namespace tegotae
