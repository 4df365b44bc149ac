#include "tegotae/sim/haptic_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "broadphase/bounding_spheres.hpp"
#include "sim/contact_loop.hpp"
#include "sim/proxy_loop.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

// What l_min is when it is not set: this share of the held part's radius, within these bounds (m). The loop goes down
// to the lower one by itself where a fit has no more room.
constexpr double kLMinShare = 8e-4, kLeastLMin = 4e-6, kMostLMin = 2e-5;
// Back-off in units of l_min.
constexpr double kDefaultL0 = 10;

ContactSettings completed(ContactSettings s, double radius) {
  const auto check = [](const char* name, double value) {
    if (!(std::isfinite(value) && value > 0))
      throw Error(std::string("contact.") + name + " must be a positive number, not " + std::to_string(value));
  };
  const auto check_not_negative = [](const char* name, double value) {
    if (!(std::isfinite(value) && value >= 0))
      throw Error(std::string("contact.") + name + " must not be negative, not " + std::to_string(value));
  };
  if (std::isnan(s.l_min)) s.l_min = std::clamp(kLMinShare * radius, kLeastLMin, kMostLMin);
  if (std::isnan(s.l_0)) s.l_0 = kDefaultL0 * s.l_min;
  check("l_min", s.l_min);
  check("l_0", s.l_0);
  check("density", s.density);
  check("impulse.substep", s.impulse.substep);
  check("penalty.stiffness", s.penalty.stiffness);
  if (!(s.impulse.restitution >= 0 && s.impulse.restitution <= 1))
    throw Error("contact.impulse.restitution must be from 0 to 1, not " + std::to_string(s.impulse.restitution));
  check_not_negative("impulse.micro_speed", s.impulse.micro_speed);
  check_not_negative("penalty.damping", s.penalty.damping);
  if (!(s.tick_budget > 0)) throw Error("contact.tick_budget must be positive, not " + std::to_string(s.tick_budget));
  check_not_negative("touch_tolerance", s.touch_tolerance);
  if (s.initial_overlap != "refuse" && s.initial_overlap != "ignore")
    throw Error("unknown initial_overlap \"" + s.initial_overlap + "\"; known are refuse, ignore");
  const auto& names = narrowphase_names();
  if (std::find(names.begin(), names.end(), s.narrowphase) == names.end())
    throw Error("unknown narrowphase \"" + s.narrowphase + "\"; known are patch, fcl");
  return s;
}

const Part& held_part(const Scene& scene) {
  const Part* held = nullptr;
  for (const Part& p : scene.parts) {
    if (!p.mesh || p.mesh->triangles.empty()) throw Error("part \"" + p.name + "\" has no triangles");
    if (!p.held) continue;
    if (held) throw Error("parts \"" + held->name + "\" and \"" + p.name + "\" are both held; exactly one may be");
    held = &p;
  }
  if (!held) throw Error("no part is held; exactly one must be");
  return *held;
}

}  // namespace

ContactSettings::ContactSettings()
    : l_min(std::numeric_limits<double>::quiet_NaN()), l_0(std::numeric_limits<double>::quiet_NaN()) {}

struct HapticLoop::State {
  ContactSettings settings;
  MassProperties mass;
  std::unique_ptr<ProxyLoop> loop;
  TickReport report;

  explicit State(const Scene& scene)
      : settings(completed(scene.contact, bounding_sphere(*held_part(scene).mesh).radius)),
        mass(mass_properties(*held_part(scene).mesh, tegotae::report(*held_part(scene).mesh).closed, settings.density)),
        loop(make_proxy_loop(scene, settings, mass)) {
    report.pieces.assign(1, loop->pose());
    report.proxy.X = loop->pose();
    report.gap = std::numeric_limits<double>::infinity();
    for (const StartPair& pair : loop->start().pairs) {
      report.suspended += pair.state == PairState::suspended ? 1 : 0;
      report.relieved += pair.state == PairState::relieved ? 1 : 0;
    }
  }
};

HapticLoop::HapticLoop(const Scene& scene) : state_(std::make_unique<State>(scene)) {}
HapticLoop::~HapticLoop() = default;

const TickReport& HapticLoop::step(const Pose& Y, double dt) noexcept {
  if (Y.p.allFinite() && Y.q.coeffs().allFinite() && Y.q.squaredNorm() > 0)
    state_->loop->step({Y.q.normalized(), Y.p}, dt, state_->report);
  return state_->report;
}

const TickReport& HapticLoop::report() const {
  return state_->report;
}
const StartReport& HapticLoop::start() const {
  return state_->loop->start();
}
const std::vector<Contact>& HapticLoop::limits() const {
  return state_->loop->limits();
}
const Vec3& HapticLoop::center() const {
  return state_->mass.center;
}
Mat3 HapticLoop::gyration() const {
  return state_->mass.inertia / state_->mass.mass;
}
const ContactSettings& HapticLoop::contact() const {
  return state_->settings;
}

}  // namespace tegotae
