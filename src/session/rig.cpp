#include "tegotae/session/rig.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "loop/scene_parts.hpp"
#include "servo/loop_priority.hpp"
#include "session/guide_pull.hpp"
#include "session/pen_port.hpp"
#include "session/step_schedule.hpp"
#include "session/weight_ramp.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

constexpr double kMinPeriod = 1e-5, kMaxPeriod = 1;  // s

std::int64_t nanoseconds(double seconds) {
  return std::llround(1e9 * seconds);
}

const RigSettings& checked(const RigSettings& settings) {
  if (!(settings.period >= kMinPeriod && settings.period <= kMaxPeriod))
    throw Error(ErrorKind::setting, "rig: the period must be from 1e-5 to 1 s, not " + std::to_string(settings.period),
                {{}, 0, "period", {}});
  return settings;
}

/// In simulated time a budget in seconds would let the load of the machine decide what a tick does.
Scene in_its_time(Scene scene, RigClock clock) {
  if (clock == RigClock::simulated) scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  return scene;
}

Scene without_parts(Scene scene) {
  scene.parts.clear();
  return scene;
}

}  // namespace

struct Rig::State {
  RigSettings settings;
  HapticLoop loop;
  std::unique_ptr<PenPort> pen;  ///< before start() too
  int servo_ticks = 1;           ///< in a step of simulated time
  bool running = false;
  PenSample sample;
  bool connected = false;
  std::uint64_t steps = 0;
  std::int64_t begin_ns = 0, now_ns = 0;  ///< of start() and of the last step, the clock's
  std::atomic<bool> stop_requested{false};
  StepSchedule schedule;
  WeightRamp carried;
  GuidePull pulled;
  Scene rules;          ///< of the scene in force when changes were last taken, without its parts
  std::mutex changing;  ///< guards `rules` and `changes`
  std::vector<std::pair<SceneChange, Scene>> changes;  ///< later than `rules`, each with its rules
  std::optional<LoopPriority> priority;                ///< in run()
  std::string missing;

  State(const Scene& scene, const RigSettings& settings_in)
      : settings(settings_in),
        loop(in_its_time(scene, settings.clock)),
        schedule(nanoseconds(settings.period)),
        rules(without_parts(scene)) {}

  /// Returns the scene in force, without its parts. The pen is mapped with the first scene's scale throughout. `next`
  /// is a change that has been asked for. Any thread may call it.
  Scene take_changes(std::optional<std::pair<SceneChange, Scene>> next = {}) {
    const std::lock_guard<std::mutex> lock(changing);
    if (next) changes.push_back(std::move(*next));
    const auto is_pending = [](const auto& change) { return change.first.state() == ChangeState::pending; };
    const auto done = std::stable_partition(changes.begin(), changes.end(), is_pending);
    for (auto at = done; at != changes.end(); ++at) {
      if (at->first.state() != ChangeState::in_force) continue;
      at->second.scale = rules.scale;
      rules = std::move(at->second);
    }
    changes.erase(done, changes.end());
    return rules;
  }

  bool simulated() const { return settings.clock == RigClock::simulated; }
  std::int64_t servo_period() const { return nanoseconds(settings.period) / servo_ticks; }

  /// Another part is held: the pen comes to mean it where it is.
  void grasp() noexcept {
    const Pose& X = loop.report().proxy.X;
    pen->grasp(loop.center(), loop.coupling(), X);
    pulled.end();
    sample.state.pose = X;
    sample.state.velocity = {};
  }

  void follow(double dt) noexcept {
    const std::int64_t answered = now_ns;
    connected = pen->read(sample, now_ns);
    if (connected) {
      const double share = carried.update(sample, dt);
      loop.carry(share);
      const Wrench pull = pulled.update(sample.state.pose, dt);
      loop.pull({share * pull.force, share * pull.torque});
      const TickReport& report = loop.step(sample.state.pose, dt);
      if (report.flags.part_changed) grasp();
      pen->publish(report.proxy, report.planes, steps, sample.state.sequence, simulated() ? answered : monotonic_ns());
    } else {
      // There is no pen to follow: the part stays, and the servo hears that this loop lives.
      ProxyState still = loop.report().proxy;
      still.velocity = {};
      pen->publish(still, {}, steps, sample.state.sequence, answered);
    }
    ++steps;
  }
};

Rig::Rig(const Scene& scene, Device& device, const RigSettings& settings)
    : state_(std::make_unique<State>(scene, checked(settings))) {
  State& s = *state_;
  s.servo_ticks = std::max(1, static_cast<int>(std::lround(settings.period * settings.servo.rate_hz)));
  s.pen = make_local_pen(device, settings.servo, !s.simulated(), scene.scale, s.loop);
}

Rig::Rig(const Scene& scene, const std::string& device) : state_(std::make_unique<State>(scene, RigSettings())) {
  state_->pen = make_remote_pen(device, scene.scale, state_->loop);
}

Rig::~Rig() {
  try {
    stop();
  } catch (const std::exception&) {  // a destructor cannot tell; stop() can
  }
}

void Rig::start() {
  State& s = *state_;
  if (s.running) return;
  s.pen->start();
  s.running = true;
  s.stop_requested = false;
  s.steps = 0;
  s.begin_ns = s.now_ns = s.simulated() ? 0 : monotonic_ns();
  s.schedule.begin(s.begin_ns);
}

void Rig::stop() {
  State& s = *state_;
  if (!s.running) return;
  s.running = false;
  s.pen->stop();
}

const TickReport& Rig::step() noexcept {
  State& s = *state_;
  if (!s.running) return s.loop.report();
  if (!s.simulated()) {
    const std::int64_t now = monotonic_ns();
    const double dt = s.steps == 0 ? s.settings.period : 1e-9 * static_cast<double>(now - s.now_ns);
    s.now_ns = now;
    s.follow(dt);
    return s.loop.report();
  }
  s.now_ns = static_cast<std::int64_t>(s.steps) * nanoseconds(s.settings.period);
  const std::int64_t begin = s.now_ns;
  for (int i = 0; i < s.servo_ticks; ++i) {
    s.pen->tick_servo(begin + i * s.servo_period());
    if (i == 0) s.follow(s.settings.period);
    s.pen->advance(1e-9 * static_cast<double>(s.servo_period()));
  }
  return s.loop.report();
}

bool Rig::wait_for_step(double seconds) noexcept {
  State& s = *state_;
  if (!s.running || s.stop_requested.load(std::memory_order_relaxed)) return false;
  if (s.simulated()) return static_cast<double>(s.steps) * s.settings.period < seconds - 1e-9;
  if (s.steps > 0) s.schedule.done(s.now_ns, monotonic_ns());
  return 1e-9 * static_cast<double>(s.schedule.wait() - s.begin_ns) < seconds;
}

void Rig::request_stop() noexcept {
  state_->stop_requested.store(true, std::memory_order_relaxed);
}

Rig::Pace::Pace(Rig& rig) : rig_(rig) {
  State& s = *rig_.state_;
  if (s.simulated()) return;
  s.priority.emplace();
  s.missing = s.priority->missing();
  s.schedule.begin(monotonic_ns());
}

Rig::Pace::~Pace() {
  rig_.state_->priority.reset();
}

SceneChange Rig::change(Scene next) {
  State& s = *state_;
  Part& part = held_part(next);
  if (part.name == s.loop.held()) part.pose = s.loop.latest();
  Scene rules = without_parts(next);
  SceneChange change = s.loop.change(in_its_time(std::move(next), s.settings.clock));
  s.take_changes(std::make_pair(change, std::move(rules)));
  return change;
}

void Rig::guide(const std::vector<Pose>& path) {
  State& s = *state_;
  s.pulled.set(path.empty() ? std::nullopt : std::make_optional(guide_along(path, s.take_changes(), s.loop)));
}

double Rig::time() const noexcept {
  return 1e-9 * static_cast<double>(state_->now_ns - state_->begin_ns);
}
std::uint64_t Rig::steps() const noexcept {
  return state_->steps;
}
Pose Rig::part() const noexcept {
  return state_->loop.latest();
}
const PenSample& Rig::pen() const noexcept {
  return state_->sample;
}
bool Rig::connected() const noexcept {
  return state_->connected;
}
const TickReport& Rig::report() const {
  return state_->loop.report();
}
const std::vector<ContactPoint>& Rig::contacts() const {
  return state_->loop.contacts();
}
const std::vector<ContactEvent>& Rig::contact_events() const {
  return state_->loop.contact_events();
}
const InitialContactReport& Rig::start_report() const {
  return state_->loop.start();
}
const HapticLoop& Rig::loop() const noexcept {
  return state_->loop;
}
ServoStatistics Rig::servo_statistics() const noexcept {
  return state_->pen->statistics();
}
std::string Rig::missing_realtime() const {
  const std::string servo = state_->pen->missing_realtime();
  return servo.empty() ? state_->missing : servo;
}
std::string Rig::stability() const {
  return state_->pen->stability();
}

}  // namespace tegotae
