#include "tegotae/scene_file/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "core/name_list.hpp"
#include "core/valid_pose.hpp"
#include "import/file_check.hpp"
#include "import/gltf_buffers.hpp"
#include "loop/contact_loop.hpp"
#include "loop/held_weight.hpp"
#include "loop/scene_parts.hpp"
#include "scene_file/mesh_files.hpp"
#include "scene_file/scene_friction.hpp"
#include "scene_file/toml_table.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/coupling/stability.hpp"
#include "tegotae/resolve/resolver.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/mapping.hpp"

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

/// The path under `key`, relative to the folder of the scene file; it must be a file. Added to `files`.
std::string file_under(const TomlTable& t, const char* key, const std::filesystem::path& folder,
                       std::vector<std::string>& files) {
  const std::filesystem::path file = folder / t.text(key);
  if (!std::filesystem::exists(file)) t.fail(key, file.string() + ": no such file");
  if (!std::filesystem::is_regular_file(file)) t.fail(key, file.string() + ": not a file");
  files.push_back(file.string());
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
  if (!within_reach(X.p)) t.fail("position", "lies beyond 10 km; positions are in m");
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

std::optional<Color> read_color(const TomlTable& t) {
  if (!t.has("color")) return std::nullopt;
  const std::vector<double> given = t.numbers("color", 3, 4);
  Color color = {0, 0, 0, 1};
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (!(given[i] >= 0 && given[i] <= 1)) t.fail("color", "each number must be between 0 and 1");
    color[i] = given[i];
  }
  return color;
}

void read_parts(const TomlTable& top, const std::filesystem::path& folder, const SceneOptions& options, Scene& scene,
                std::vector<std::string>& files) {
  const double default_unit = read_unit(top, "m");
  MeshFiles meshes;
  std::set<std::string> names;
  std::string held;
  const std::vector<TomlTable> tables = top.tables(
      "part", {"name", "mesh", "unit", "held", "position", "orientation", "rpy_deg", "path", "color", "mass"});
  for (const TomlTable& t : tables) {
    Part part;
    part.name = t.text("name");
    if (!names.insert(part.name).second) t.fail("name", "another part is named " + part.name);
    part.held = t.flag("held", false);
    if (!options.hold.empty()) part.held = part.name == options.hold;
    if (part.held && !held.empty()) t.fail("held", "part " + held + " is already held; exactly one part may be");
    if (part.held) held = part.name;
    part.pose = read_pose(t);
    part.path = t.texts("path");
    part.color = read_color(t);
    if (t.has("mass")) part.mass = t.positive("mass", 0);
    const double unit = t.has("unit") ? read_unit(t, "m") : default_unit;
    meshes.add(scene.parts.size(), t, file_under(t, "mesh", folder, files), unit);
    scene.parts.push_back(std::move(part));
  }
  if (scene.parts.empty()) top.fail("part", "the scene has no [[part]]");
  if (held.empty() && !options.hold.empty())
    top.fail("part", "no part is named " + options.hold + " (there are " + name_list(part_names(scene)) + ")");
  if (held.empty() && options.held_needed)
    top.fail("part", "no part is held; give one of them held = true, or name one with --hold NAME (there are " +
                         name_list(part_names(scene)) + ")");
  meshes.read(options, scene.parts);
  const std::set<std::string> named(files.begin(), files.end());
  for (const std::string& file : named) {
    const std::string extension = lower_extension(file);
    if (extension != ".gltf" && extension != ".glb") continue;
    for (std::string& buffer : gltf_buffer_files(file)) files.push_back(std::move(buffer));
  }
}

std::string one_of(const TomlTable& t, const char* key, const std::string& otherwise,
                   const std::vector<std::string>& known) {
  const std::string value = t.text(key, otherwise);
  if (std::find(known.begin(), known.end(), value) != known.end()) return value;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  t.fail(key, "unknown " + std::string(key) + " " + value + " (known: " + list + ")");
}

UpAxis read_up(const TomlTable& t) {
  const std::string axis = one_of(t, "up", to_string(UpAxis::z), {"x", "y", "z"});
  return axis == "x" ? UpAxis::x : axis == "y" ? UpAxis::y : UpAxis::z;
}

void read_contact(const TomlTable& t, ContactSettings& s) {
  if (t.has("l_min")) s.l_min = t.positive("l_min", 0);
  if (t.has("l_0")) s.l_0 = t.positive("l_0", 0);
  s.density = t.positive("density", s.density);
  s.tick_budget = t.positive("tick_budget", s.tick_budget);
  if (t.has("helper_threads")) s.helper_threads = t.whole("helper_threads", 0, ContactSettings::kMostHelpers);
  s.resolver = resolver_kind(one_of(t, "resolver", to_string(s.resolver), resolver_names()));
  s.narrowphase = one_of(t, "narrowphase", "patch", {"patch", "fcl"}) == "fcl" ? NarrowPhase::fcl : NarrowPhase::patch;
  s.touch_tolerance = t.at_least_zero("touch_tolerance", s.touch_tolerance);
  const bool ignore = one_of(t, "initial_overlap", "refuse", {"refuse", "ignore"}) == "ignore";
  s.initial_overlap = ignore ? InitialOverlap::ignore : InitialOverlap::refuse;
  const TomlTable impulse = t.table("impulse", {"restitution", "micro_speed", "substep"});
  s.impulse.restitution = impulse.at_least_zero("restitution", s.impulse.restitution);
  if (s.impulse.restitution > 1) impulse.fail("restitution", "must be at most 1");
  s.impulse.micro_speed = impulse.at_least_zero("micro_speed", s.impulse.micro_speed);
  s.impulse.substep = impulse.positive("substep", s.impulse.substep);
  const TomlTable penalty = t.table("penalty", {"stiffness", "damping"});
  s.penalty.stiffness = penalty.positive("stiffness", s.penalty.stiffness);
  s.penalty.damping = penalty.at_least_zero("damping", s.penalty.damping);
}

void read_coupling(const TomlTable& t, CouplingSettings& s) {
  s.stiffness = t.positive("stiffness", s.stiffness);
  s.damping = t.at_least_zero("damping", s.damping);
  s.torsional_stiffness = t.positive("torsional_stiffness", s.torsional_stiffness);
  s.torsional_damping = t.at_least_zero("torsional_damping", s.torsional_damping);
}

void read_safety(const TomlTable& t, SafetySettings& s) {
  s.limits.force = t.at_least_zero("force_limit", s.limits.force);
  s.limits.torque = t.at_least_zero("torque_limit", s.limits.torque);
  s.continuous_force = t.at_least_zero("continuous_force", s.continuous_force);
  s.slew.force = t.positive("force_slew", s.slew.force);
  s.slew.torque = t.positive("torque_slew", s.slew.torque);
  s.velocity_limit = t.positive("velocity_limit", s.velocity_limit);
  s.heartbeat_timeout = t.positive("heartbeat_timeout", s.heartbeat_timeout);
  if (s.heartbeat_timeout > kMaxTimeout) t.fail("heartbeat_timeout", "must be at most 1 s");
}

double read_scale(const TomlTable& t) {
  const double scale = t.positive("scale", 1.0);
  if (scale < kMinScale || scale > kMaxScale) t.fail("scale", "must be from 0.01 to 100");
  return scale;
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

/// Of a torsional stiffness that the file leaves open, N·m/rad.
double torsion_bound(const SimulatedDeviceSettings& device, const CouplingSettings& coupling) {
  const DeviceInfo info = device_info(device);
  const StabilityReport report = stability(info, coupling, ServoSettings().rate_hz);
  return torsional_stiffness_bound(report.torsional_stiffness_limit, info.limits.torque);
}

void read_weight(const TomlTable& top, const SimulatedDeviceSettings& device, const SafetySettings& safety,
                 Scene& scene) {
  scene.weight.on = top.flag("weight", scene.weight.on);
  if (top.has("gravity")) scene.weight.gravity = Vec3(top.numbers("gravity", 3).data());
  if (scene.weight.on && scene.contact.resolver != ResolverKind::qp)
    top.fail("weight", "the resolver " + to_string(scene.contact.resolver) + " does not support weight; qp does");
  double stands = device_info(device).continuous_force;
  if (safety.continuous_force > 0)
    stands = stands > 0 ? std::min(stands, safety.continuous_force) : safety.continuous_force;
  scene.weight.max_force = weight_bound(stands);
}

/// A script of a hand that stays where the held part starts.
StylusScript rest(const Scene& scene) {
  const auto held = std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; });
  return StylusScript({{0, held == scene.parts.end() ? Pose() : held->pose}});
}

/// A part file would be "not valid TOML" in its second line, a recording in its first.
void check_is_scene(const std::string& path) {
  const std::string ending = lower_extension(path);
  if ((ending == ".csv" || ending == ".mcap") && std::filesystem::exists(path))
    throw Error(ErrorKind::file,
                path + ": is a recording or a script, not a scene; `tegotae view " + path + "` shows a recording",
                {path, 0, {}, {}});
  if (!is_file_of_parts(path) || !std::filesystem::exists(path)) return;
  throw Error(ErrorKind::file,
              path + ": is a file of parts, not a scene; `tegotae import " + path + " -o FOLDER` makes a scene of it",
              {path, 0, {}, {}});
}

}  // namespace

SceneFile load_scene(const std::string& path, const SceneOptions& options) {
  check_is_scene(path);  // before all of it is read
  std::string text = read_file(path);
  const toml::table parsed = parse_toml(text, path);
  const TomlTable top(
      parsed, path, "",
      {"unit", "up", "weight", "gravity", "part", "contact", "friction", "coupling", "safety", "device"});
  const UpAxis up = read_up(top);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::vector<std::string> files = {path};
  Scene scene;
  // Settings first: a mistake in them need not wait for large meshes.
  read_contact(top.table("contact", {"l_min", "l_0", "resolver", "narrowphase", "tick_budget", "helper_threads",
                                     "touch_tolerance", "initial_overlap", "density", "impulse", "penalty"}),
               scene.contact);
  const TomlTable coupling =
      top.table("coupling", {"stiffness", "damping", "torsional_stiffness", "torsional_damping"});
  read_coupling(coupling, scene.coupling);
  SafetySettings safety;
  read_safety(top.table("safety", {"force_limit", "torque_limit", "continuous_force", "force_slew", "torque_slew",
                                   "velocity_limit", "heartbeat_timeout"}),
              safety);
  const TomlTable device = top.table("device", {"type", "hand", "script", "scale"});
  const SimulatedDeviceSettings settings = read_device(device);
  std::optional<StylusScript> script;
  if (device.has("script")) {
    const std::string script_file = file_under(device, "script", folder, files);
    script = about(device, "script", [&] { return read_script(script_file); });
  }
  read_parts(top, folder, options, scene, files);
  read_friction(top, scene);
  read_weight(top, settings, safety, scene);
  if (!script) script = rest(scene);
  scene.scale = read_scale(device);
  if (!coupling.has("torsional_stiffness")) scene.max_torsional_stiffness = torsion_bound(settings, scene.coupling);
  return {path, std::move(scene), settings, std::move(*script), safety, std::move(text), std::move(files), up};
}

}  // namespace tegotae
