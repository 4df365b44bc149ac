#include "loop/running_scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "broadphase/bounding_spheres.hpp"
#include "core/usable_processors.hpp"
#include "core/valid_pose.hpp"
#include "loop/contact_loop.hpp"
#include "loop/friction_pairs.hpp"
#include "loop/held_weight.hpp"
#include "loop/scene_parts.hpp"
#include "mesh/surface.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// What l_min is when it is not set: this share of the held part's radius, within these bounds (m). The loop goes down
// to the lower one by itself where a fit has no more room.
constexpr double kLMinShare = 8e-4, kMinLMin = 4e-6, kMaxLMin = 2e-5;
// Back-off in units of l_min.
constexpr double kDefaultL0 = 10;
// Helper threads at most where their number is not set: the machine has other work, too.
constexpr int kDefaultHelpers = 7;

CouplingSettings fitted(const Scene& scene, const MassProperties& mass) {
  CouplingSettings coupling = scene.coupling;
  if (scene.max_torsional_stiffness)
    coupling.torsional_stiffness = fitted_torsional_stiffness(
        coupling.stiffness, radius_of_gyration(mass) / scene.scale, *scene.max_torsional_stiffness);
  return coupling;
}

Scene coupled_by(Scene scene, const CouplingSettings& coupling) {
  scene.coupling = coupling;
  return scene;
}

}  // namespace

ContactSettings completed(ContactSettings s, double radius) {
  const auto require = [](bool good, const char* name, const char* what, double value) {
    const std::string key = std::string("contact.") + name;
    if (!good) throw Error(ErrorKind::setting, key + what + ", not " + std::to_string(value), {{}, 0, key, {}});
  };
  const auto check = [&require](const char* name, double value) {
    require(std::isfinite(value) && value > 0, name, " must be a positive number", value);
  };
  const auto check_not_negative = [&require](const char* name, double value) {
    require(std::isfinite(value) && value >= 0, name, " must not be negative", value);
  };
  if (!s.l_min) s.l_min = std::clamp(kLMinShare * radius, kMinLMin, kMaxLMin);
  if (!s.l_0) s.l_0 = kDefaultL0 * *s.l_min;
  check("l_min", *s.l_min);
  check("l_0", *s.l_0);
  check("density", s.density);
  check("impulse.substep", s.impulse.substep);
  check("penalty.stiffness", s.penalty.stiffness);
  require(s.impulse.restitution >= 0 && s.impulse.restitution <= 1, "impulse.restitution", " must be from 0 to 1",
          s.impulse.restitution);
  check_not_negative("impulse.micro_speed", s.impulse.micro_speed);
  check_not_negative("penalty.damping", s.penalty.damping);
  require(s.tick_budget > 0, "tick_budget", " must be positive", s.tick_budget);
  if (!s.helper_threads) s.helper_threads = std::min(usable_processors() - 1, kDefaultHelpers);
  require(*s.helper_threads >= 0 && *s.helper_threads <= ContactSettings::kMostHelpers, "helper_threads",
          " must be from 0 to 64", *s.helper_threads);
  check_not_negative("touch_tolerance", s.touch_tolerance);
  return s;
}

const Scene& checked(const Scene& scene) {
  for (const Part& p : scene.parts) {
    if (!p.mesh || p.mesh->triangles.empty())
      throw Error(ErrorKind::setting, "part \"" + p.name + "\" has no triangles", {{}, 0, {}, p.name});
    if (!is_valid(p.pose))
      throw Error(ErrorKind::setting,
                  "part \"" + p.name + "\": its pose is not finite, not of unit length, or beyond 10 km",
                  {{}, 0, {}, p.name});
  }
  return scene;
}

MassProperties mass_of_held(const Scene& scene, double density) {
  const auto& mesh = held_part(scene).mesh;
  return mass_properties(*mesh, is_closed(cached_surface(mesh)->topology), density);
}

RunningScene::RunningScene(const Scene& scene)
    : held(held_part(checked(scene)).name),
      held_mesh(held_part(scene).mesh),
      settings(completed(scene.contact, bounding_sphere(*held_part(scene).mesh).radius)),
      mass(mass_of_held(scene, settings.density)),
      radius(radius_about(*held_mesh, mass.center)),
      coupling(fitted(scene, mass)),
      weight(held_weight(scene, mass)),
      scale(scene.scale),
      loop(make_proxy_loop(coupled_by(scene, coupling), settings, mass)) {
  std::vector<Obstacle> list;
  friction_of_parts(scene);  // refuses what the loop of another resolver would not look at
  for (const Part* p : SceneParts(scene).fixed) list.push_back({p->mesh, p->pose});
  obstacles = std::make_shared<const std::vector<Obstacle>>(std::move(list));
  keeps_out = settings.narrowphase == NarrowPhase::patch &&
              (settings.custom_resolver || settings.resolver != ResolverKind::penalty);
}

RunningScene::~RunningScene() {
  ChangeState pending = ChangeState::pending;
  if (change) change->state.compare_exchange_strong(pending, ChangeState::replaced, std::memory_order_acq_rel);
}

void RunningScene::compare(const std::vector<Obstacle>& old, std::uint64_t old_number) {
  // The same mesh may stand in many places; those of one place are the same obstacle.
  const auto before = [](const Obstacle& a, const Obstacle& b) {
    const auto key = [](const Obstacle& o) {
      const Vec3& p = o.pose.p;
      const auto& q = o.pose.q.coeffs();
      return std::make_tuple(o.mesh.get(), p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    };
    return key(a) < key(b);
  };
  const std::set<Obstacle, decltype(before)> known(old.begin(), old.end(), before);
  fresh.clear();
  for (const Obstacle& o : *obstacles) fresh.push_back(known.count(o) == 0);
  fresh_since = old_number;
}

void RunningScene::warm_up() {
  TickReport tick;
  reset(tick);
  loop->step(loop->pose(), 1e-3, kNoDeadline, tick);
  loop->take_over(tick, loop->pose(), nullptr, kNoDeadline);
}

}  // namespace tegotae
