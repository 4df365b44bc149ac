#include "study/task.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase/bounding_spheres.hpp"
#include "core/name_list.hpp"
#include "loop/scene_parts.hpp"
#include "review/verdict.hpp"
#include "scene_file/scene_text.hpp"
#include "shared/format.hpp"
#include "shared/pose_option.hpp"
#include "shared/status_line.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::study {
namespace {

const std::string kInward = "inward ";  // begins the name of an axis
// Of a part's radius: how far its faces may go.
constexpr double kMaxInward = 0.05;

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(const void* data, std::size_t size) {
    for (const auto* p = static_cast<const unsigned char*>(data); size-- > 0; ++p)
      value_ = (value_ ^ *p) * 0x100000001b3u;
  }
  void add(double x) { add(&x, sizeof x); }
  void add(const std::string& text) { add(text.data(), text.size() + 1); }
  void add(const Pose& X) {
    for (const double x : X.p) add(x);
    for (const double x : X.q.coeffs()) add(x);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

void add_scene(const SceneFile& file, Hash& hash) {
  for (const Part& part : file.scene.parts) {
    hash.add(part.name);
    hash.add(part.pose);
    hash.add(part.held ? 1.0 : 0.0);
    for (const Vec3& v : part.mesh->vertices)
      for (const double x : v) hash.add(x);
    for (const auto& t : part.mesh->triangles) hash.add(t.data(), sizeof t);
  }
  // What has a default that may change, as it is; and whatever the file sets, known here or not.
  const Scene& s = file.scene;
  hash.add(to_string(s.contact.resolver));
  hash.add(std::string(s.contact.narrowphase == NarrowPhase::fcl ? "fcl" : "patch"));
  for (const double x : {s.contact.l_min.value_or(-1), s.contact.l_0.value_or(-1), s.contact.density,
                         s.coupling.stiffness, s.coupling.damping, s.coupling.torsional_stiffness,
                         s.coupling.torsional_damping, s.max_torsional_stiffness.value_or(-1), file.safety.limits.force,
                         file.safety.limits.torque, file.safety.continuous_force})
    hash.add(x);
  hash.add(scene_settings(file));
  hash.add(file.script.pose(file.script.end()));
}

void check_name(const std::string& name, const SceneFile& file) {
  const std::vector<std::string> names = part_names(file.scene);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  throw Error(file.path + ": has no part " + name + ", which the study names (there are " + name_list(names) + ")");
}

/// Throws where the values of an axis are more than the faces of a part of that name can go.
void check_inward(const Axis& axis, const std::string& name, const SceneFile& file) {
  double most = std::max(std::abs(axis.low), std::abs(axis.high));
  for (const double by : axis.numbers) most = std::max(most, std::abs(by));
  for (const Part& part : file.scene.parts) {
    const double radius = bounding_sphere(*part.mesh).radius;
    if (part.name != name || most <= kMaxInward * radius) continue;
    throw Error(file.path + ": the faces of " + name + " cannot go inward by " + review::length_text(most) +
                ": it is only " + review::length_text(2 * radius) + " large");
  }
}

void check_order(const std::vector<std::string>& order, const SceneFile& file) {
  for (const std::string& part : order) check_name(part, file);
  if (order.size() >= file.scene.parts.size())
    throw Error(file.path + ": has no other parts than an order of the study takes out; leave one");
}

}  // namespace

Tasks::Tasks(const Study& study, std::vector<SceneFile> files) : study_(study), files_(std::move(files)) {
  for (const SceneFile& file : files_) {
    for (const std::vector<std::string>& order : study.orders) check_order(order, file);
    for (const Axis& axis : study.axes) {
      if (axis.name.rfind(kInward, 0) != 0) continue;
      const std::string name = axis.name.substr(kInward.size());
      check_name(name, file);
      check_inward(axis, name, file);
    }
    if (study.goal.empty() && !(file.script.end() > file.script.begin()))
      throw Error(file.path + ": its script does not move; give the part's goal with " +
                  (study.path.empty() ? "--goal" : "goal in " + study.path));
  }
}

const SceneFile& Tasks::file(const Case& c) const {
  const Value* scene = c.find("scene");
  return files_[scene == nullptr ? 0 : scene->index];
}

Task Tasks::make(std::size_t scene, std::size_t order, std::size_t step) const {
  SceneFile file = files_[scene];
  if (!study_.orders.empty()) {
    const std::vector<std::string>& parts = study_.orders[order];
    auto& all = file.scene.parts;
    const auto gone = parts.begin() + static_cast<std::ptrdiff_t>(step);
    all.erase(std::remove_if(all.begin(), all.end(),
                             [&](const Part& p) { return std::find(parts.begin(), gone, p.name) != gone; }),
              all.end());
    for (Part& part : all) part.held = part.name == parts[step];
  }
  const Vec3 center = HapticLoop(file.scene).center();  // throws when the scene is invalid
  std::vector<Route> routes;
  if (study_.goal == apps::kOut) {
    routes = find_routes_out(file.scene, center);
  } else {
    const Pose goal =
        study_.goal.empty() ? file.script.pose(file.script.end()) : apps::parse_pose(study_.goal, file.scene);
    routes = find_routes(file.scene, goal, center);
  }
  file.scene.scale = 1;
  return {std::move(file), center, std::move(routes)};
}

std::shared_ptr<const Task> Tasks::task(std::size_t scene, std::size_t order, std::size_t step) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<const Task>& made = made_[{scene, order, step}];
  if (!made) made = std::make_shared<const Task>(make(scene, order, step));
  return made;
}

std::vector<std::shared_ptr<const Task>> Tasks::of(const Case& c) {
  const Value* scene = c.find("scene");
  const Value* order = c.find("order");
  const std::size_t s = scene == nullptr ? 0 : scene->index, o = order == nullptr ? 0 : order->index;
  std::vector<std::shared_ptr<const Task>> out;
  for (std::size_t step = 0; step < (order == nullptr ? 1 : study_.orders[o].size()); ++step)
    out.push_back(task(s, o, step));
  return out;
}

std::string Tasks::fingerprint() const {
  Hash hash;
  for (const SceneFile& file : files_) add_scene(file, hash);
  hash.add(axes_text(study_));
  return apps::format("tegotae %s, seed %llu, task %016llx", TEGOTAE_VERSION_STRING,
                      static_cast<unsigned long long>(study_.seed), static_cast<unsigned long long>(hash.value()));
}

std::vector<std::string> Tasks::inputs() const {
  std::vector<std::string> out;
  if (!study_.path.empty()) out.push_back(study_.path);
  for (const SceneFile& file : files_) out.insert(out.end(), file.files.begin(), file.files.end());
  return out;
}

std::unique_ptr<Tasks> load_tasks(const Study& study, const MeshLoader& load) {
  std::vector<SceneFile> files;
  for (const std::string& scene : study.scenes) {
    SceneOptions how;
    how.hold = study.hold;
    how.held_needed = study.orders.empty();
    how.load = load;
    files.push_back(apps::load_with_progress(scene, how));
    apps::print_notes(files.back().scene);
  }
  return std::make_unique<Tasks>(study, std::move(files));
}

}  // namespace tegotae::study
