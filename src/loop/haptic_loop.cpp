#include "tegotae/loop/haptic_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/deadline.hpp"
#include "core/latest_value.hpp"
#include "core/valid_pose.hpp"
#include "loop/contact_list.hpp"
#include "loop/lag.hpp"
#include "loop/scene_changes.hpp"
#include "loop/tick_reserve.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Share of the tick's budget for the test whether the held part can continue in a changed scene.
constexpr double kChangeShare = 0.25;
// Distances divided by less time (s) are not velocities; no loop ticks so often.
constexpr double kMinTime = 1e-6;

bool is_valid_time(double dt) {
  return dt == 0 || (dt >= kMinTime && std::isfinite(dt));
}

}  // namespace

struct HapticLoop::State {
  std::unique_ptr<RunningScene> now;
  std::shared_ptr<SceneChanges> changes;
  Pose Y;              // of the pen; the springs draw the part to target(), which also has the load
  double carried = 0;  // of the weight, 0 to 1
  Wrench pulled;       // see pull()
  TickReport report;
  ContactList contacts;
  LagCounter lag;
  TickReserve touching, in_air;  // where nothing touches there are no forces to work out, and looks take all they get
  Pose last_X;                   // after the last tick
  LatestValue<7> latest;         // p, q

  explicit State(const Scene& scene)
      : now(std::make_unique<RunningScene>(scene)),
        changes(std::make_shared<SceneChanges>(*now)),
        Y(now->loop->pose()) {
    report.substeps.reserve(kMaxSubsteps);
    begin();
  }

  void publish() noexcept {
    const Pose& X = report.proxy.X;
    latest.write({X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z()});
  }

  Wrench load() const noexcept { return {carried * now->weight.force + pulled.force, pulled.torque}; }

  /// Where the springs and the load draw the part: off the pen by as much as the load stretches them.
  Pose target() const noexcept { return loaded(Y, now->mass.center, now->coupling, now->scale, load()); }

  /// Ends a tick that began at `now_ns`: how far X is behind the pen, and for how long it has been so without a
  /// contact.
  const TickReport& finish(std::int64_t now_ns) noexcept {
    const auto size = [this](const Displacement& d) { return d.dp.norm() + now->radius * d.dr.norm(); };
    const double moved = size(displacement(last_X, report.proxy.X, now->mass.center));
    last_X = report.proxy.X;
    report.proxy.load = load();
    report.lag = size(displacement(report.proxy.X, target(), now->mass.center));
    lag.add(report.lag, moved, tegotae::lag_bound(now->radius), report.lag_reason);
    report.unexplained_lag_ticks = lag.ticks();
    // The clock is read last, so that nothing that the tick did hides its lateness.
    report.flags.timed_out |= past(deadline_after(now_ns, now->settings.tick_budget));
    return report;
  }

  /// Ends the tick that switches to another held part. It does not follow the pen, which is still at the old part.
  const TickReport& suspend(std::int64_t now_ns) noexcept {
    report.flags.scene_changed = report.flags.part_changed = true;
    report.lag_reason = LagReason::suspended;
    return finish(now_ns);
  }

  /// The report before the first tick with a held part.
  void begin() noexcept {
    reset(report);
    report.substeps.push_back(now->loop->pose());
    report.proxy.X = last_X = now->loop->pose();
    publish();
    for (const InitialContact& pair : now->loop->start().pairs) {
      report.filtered += pair.state == InitialContactState::filtered ? 1 : 0;
      report.shrunk += pair.state == InitialContactState::shrunk ? 1 : 0;
    }
  }

  /// Switches to a changed scene if one is pending and the held part is free in it; true when it holds another part.
  bool adopt(std::int64_t now_ns) noexcept {
    RunningScene* changed = changes->take();
    if (changed == nullptr) return false;
    const bool same = changed->held == now->held;
    // The held part is free of what was there before, where the old loop keeps it out and every pair is active.
    const bool known = changed->fresh_since == now->number && now->keeps_out && changed->held_mesh == now->held_mesh &&
                       report.filtered + report.shrunk == 0;
    const std::int64_t until = deadline_after(now_ns, kChangeShare * now->settings.tick_budget);
    if (same && !changed->loop->take_over(report, target(), known ? &changed->fresh : nullptr, until)) {
      changes->put_back(changed);
      return false;
    }
    RunningScene* before = now.release();
    now.reset(changed);
    if (!same) {
      Y = now->loop->pose();  // where the pen wanted the old part says nothing about the new one
      pulled = {};
      begin();
    }
    contacts.clear();
    changes->come_into_force(*changed, before);
    return !same;
  }
};

HapticLoop::HapticLoop(const Scene& scene) : state_(std::make_unique<State>(scene)) {}
HapticLoop::~HapticLoop() = default;

const TickReport& HapticLoop::step(const Pose& Y, double dt) noexcept {
  State& s = *state_;
  const std::int64_t now_ns = monotonic_ns();
  const std::uint64_t before = s.changes->in_force();
  if (s.adopt(now_ns)) return s.suspend(now_ns);
  TickReserve& reserve = s.report.contacts > 0 ? s.touching : s.in_air;
  reset(s.report);
  s.report.flags.scene_changed = s.changes->in_force() != before;
  const bool placed = is_valid(Y), timed = is_valid_time(dt);
  s.report.flags.input_ignored = !(placed && timed);
  if (placed) s.Y = {Y.q.normalized(), Y.p};
  const std::int64_t stop_ns = reserve.stop_after(now_ns, s.now->settings.tick_budget);
  s.now->loop->step(s.target(), timed ? dt : 0, stop_ns, s.report);
  if (!placed) s.report.lag_reason = LagReason::suspended;
  s.contacts.update(s.now->loop->constraints(), s.report, s.report.proxy.X * s.now->mass.center);
  s.publish();
  reserve.ended(stop_ns, monotonic_ns(), s.now->settings.tick_budget);
  return s.finish(now_ns);
}

SceneChange HapticLoop::change(
    const Scene& next, const std::function<void(std::uint64_t number, const InitialContactReport& start)>& ready) {
  return state_->changes->offer(next, ready);
}

std::uint64_t HapticLoop::change_in_force() const noexcept {
  return state_->changes->in_force();
}

std::string HapticLoop::held() const {
  return state_->changes->held();
}

Pose HapticLoop::latest() const noexcept {
  const LatestValue<7>::Values v = state_->latest.read();
  return {Quat(v[3], v[4], v[5], v[6]), Vec3(v[0], v[1], v[2])};
}

void HapticLoop::carry(double share) noexcept {
  state_->carried = share > 0 ? std::min(share, 1.0) : 0;
}

void HapticLoop::pull(const Wrench& wrench) noexcept {
  state_->pulled = wrench.force.allFinite() && wrench.torque.allFinite() ? wrench : Wrench();
}

const TickReport& HapticLoop::report() const {
  return state_->report;
}
const InitialContactReport& HapticLoop::start() const {
  return state_->now->loop->start();
}
const std::vector<ContactPoint>& HapticLoop::contacts() const {
  return state_->contacts.contacts();
}
const std::vector<ContactEvent>& HapticLoop::contact_events() const {
  return state_->contacts.events();
}
const std::vector<Contact>& HapticLoop::constraints() const {
  return state_->now->loop->constraints();
}
const Vec3& HapticLoop::center() const {
  return state_->now->mass.center;
}
double HapticLoop::radius_of_gyration() const {
  return tegotae::radius_of_gyration(state_->now->mass);
}
const CouplingSettings& HapticLoop::coupling() const {
  return state_->now->coupling;
}
double HapticLoop::lag_bound() const {
  return tegotae::lag_bound(state_->now->radius);
}
const ContactSettings& HapticLoop::contact() const {
  return state_->now->settings;
}
const HeldWeight& HapticLoop::weight() const {
  return state_->now->weight;
}

}  // namespace tegotae
