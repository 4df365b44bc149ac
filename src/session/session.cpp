#include "tegotae/session/session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/number_text.hpp"
#include "loop/held_weight.hpp"
#include "loop/lag.hpp"
#include "loop/mesh_structures.hpp"
#include "loop/scene_parts.hpp"
#include "servo/loop_priority.hpp"
#include "session/fit_watch.hpp"
#include "session/hand_guide.hpp"
#include "session/pen_port.hpp"
#include "session/run_check.hpp"
#include "session/run_goal.hpp"
#include "session/run_length.hpp"
#include "session/run_segments.hpp"
#include "session/step_schedule.hpp"
#include "session/torsion.hpp"
#include "session/weight_ramp.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae {

namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;  // of the servo, and at most of the contact loop
constexpr double kPeriod = 1e-9 * kPeriodNs;

HapticLoop make_loop(const SceneFile& file, const RunSettings& settings) try {
  std::optional<MeshStructures> made;  // first, and with words; the loop then finds them
  if (settings.on_build) {
    made.emplace(file.scene.parts, file.scene.contact.narrowphase,
                 [&](std::size_t done, std::size_t total) { settings.on_build("building hierarchies", done, total); });
    settings.on_build("looking for contacts at the start", 0, 0);
  }
  return HapticLoop(in_its_time(file.scene, settings.real_time));
} catch (const Error& e) {
  ErrorPlace place = e.place();
  place.file = file.path;
  throw Error(e.kind(), file.path + ": " + e.what(), place);
}

/// The scene's simulated device; null where the run has that of another process.
std::unique_ptr<SimulatedDevice> make_device(const SceneFile& file, const RunSettings& settings,
                                             const HapticLoop& loop) {
  if (!settings.device.empty()) return nullptr;
  auto device = settings.hand ? std::make_unique<SimulatedDevice>(file.device, *settings.hand, loop.center())
                              : std::make_unique<SimulatedDevice>(file.device, file.script, loop.center());
  if (settings.guide) device->follow(*settings.guide);
  return device;
}

std::unique_ptr<PenPort> make_pen(SimulatedDevice* device, const SceneFile& file, const RunSettings& settings,
                                  const HapticLoop& loop) {
  if (device == nullptr) {
    if (!settings.real_time)
      throw Error(ErrorKind::setting, "a device in another process has its own clock; it cannot run in virtual time");
    return make_remote_pen(settings.device, file.scene.scale, loop);
  }
  ServoSettings servo;
  servo.safety = file.safety;
  return make_local_pen(*device, servo, settings.real_time, file.scene.scale, loop);
}

/// `file` for the device that it is run with.
SceneFile for_device(SceneFile file, const RunSettings& settings) {
  file.scene = bounded_by(std::move(file.scene), settings.device);
  return file;
}

/// How long to run, s. Throws Error when a script of damaged or other times would run for years.
double duration(const SceneFile& file, const RunSettings& settings) {
  if (settings.seconds > 0) return settings.seconds;
  // What another process's hand does is not known.
  if (!settings.device.empty()) return std::numeric_limits<double>::infinity();
  const double length = script_length(file);
  if (length > kMaxRunSeconds) {
    throw Error(ErrorKind::setting,
                "the stylus script lasts " + number_text(length, 6) + " s, more than the " +
                    number_text(kMaxRunSeconds, 6) +
                    " s of the longest run: are its times in s? Give the seconds to run to end before");
  }
  return length + kSettleTime;
}

class Session {
 public:
  Session(const SceneFile& file, const RunSettings& settings)
      : file_(for_device(file, settings)),
        settings_(settings),
        loop_(make_loop(file_, settings)),
        device_(make_device(file_, settings, loop_)),
        pen_(make_pen(device_.get(), file_, settings, loop_)),
        guide_(make_guide(file_, settings, loop_)),
        goal_(file_, loop_.center()),
        duration_(duration(file_, settings)),
        check_(settings.check_all, settings.real_time),
        segments_(file_, settings, loop_, check_, goal_) {
    if (settings.progress) settings.progress->duration = duration_;
    summary_.held_fast.parts.reserve(file.scene.parts.size());
    summary_.stability = pen_->stability();
    if (settings.on_start)
      settings.on_start({loop_.start(), summary_.stability, torsion_text(file_.scene, loop_),
                         weight_text(file_.scene, loop_),
                         guide_ ? guide_text(*guide_, loop_.report().proxy.X) : std::string()});
  }

  RunSummary run() {
    const std::int64_t begin = monotonic_ns();
    pen_->start();
    settings_.real_time ? run_real_time() : run_virtual_time();
    pen_->stop();
    segments_.end();
    check_.end(1e-9 * static_cast<double>(monotonic_ns() - begin), settings_.stop_check,
               settings_.progress ? &settings_.progress->checked : nullptr);
    summary_.poses = check_.poses();
    summary_.checked = check_.checked();
    summary_.penetrating = check_.intersecting();
    summary_.record_dropped = segments_.dropped();
    summary_.recordings = segments_.recordings();
    summary_.record_failure = segments_.failure();
    summary_.servo = pen_->statistics();
    summary_.missing_realtime = pen_->missing_realtime();
    if (summary_.missing_realtime.empty()) summary_.missing_realtime = missing_;
    summary_.device_losses = pen_->losses();
    summary_.tick_us = tegotae::summary(tick_times_);
    const bool script_over = !follows_script(settings_) || summary_.seconds >= script_length(file_);
    summary_.depth_m = goal_.depth(X_);
    summary_.completed = script_over && holds_first_ && goal_.reached(X_) && !lagging_;
    summary_.start = segments_.start();
    return summary_;
  }

 private:
  bool stopped() const { return settings_.stop && settings_.stop->load(std::memory_order_relaxed); }

  void run_virtual_time() {
    const auto ticks = static_cast<std::int64_t>(std::ceil(duration_ / kPeriod - 1e-6));
    for (std::int64_t i = 0; i < ticks; ++i) {
      const std::int64_t now = i * kPeriodNs;
      if (settings_.observer) settings_.observer->before_tick(1e-9 * static_cast<double>(now));
      if (stopped()) break;
      pen_->tick_servo(now);
      tick(static_cast<double>(i) * kPeriod, kPeriod, now);
      pen_->advance(kPeriod);
      summary_.seconds = static_cast<double>(i + 1) * kPeriod;
    }
  }

  void run_real_time() {
    const LoopPriority priority;
    missing_ = priority.missing();
    const std::int64_t start = monotonic_ns();
    std::int64_t last = start - kPeriodNs;
    StepSchedule schedule(kPeriodNs);
    schedule.begin(start);
    while (!stopped()) {
      const std::int64_t now = schedule.wait();
      summary_.seconds = 1e-9 * static_cast<double>(now - start);
      if (summary_.seconds >= duration_) break;
      tick(summary_.seconds, 1e-9 * static_cast<double>(now - last), now);
      last = now;
      schedule.done(now, monotonic_ns());
    }
  }

  void tick(double t, double dt, std::int64_t now) {
    PenSample pen;
    if (!pen_->read(pen, now)) return wait(now);
    const std::int64_t begin = monotonic_ns();
    load(pen, dt);
    const TickReport& report = loop_.step(pen.state.pose, dt);
    const std::int64_t took = monotonic_ns() - begin;
    const std::string& held = segments_.now().held;
    if (segments_.follow() && segments_.now().held != held) grasp(pen);
    const std::uint64_t number = static_cast<std::uint64_t>(summary_.ticks++);
    pen_->publish(report.proxy, report.planes, number, pen.state.sequence, settings_.real_time ? monotonic_ns() : now);
    sequence_ = pen.state.sequence;

    tick_times_.add(took);
    summary_.ignored += report.flags.input_ignored ? 1 : 0;
    summary_.deepest_m = std::max(summary_.deepest_m, report.depth);
    summary_.contacts_max = std::max(summary_.contacts_max, report.contacts);
    count_lag(report);
    summary_.force_max_n = std::max(summary_.force_max_n, pen.wrench.force.norm());
    summary_.torque_max_nm = std::max(summary_.torque_max_nm, pen.wrench.torque.norm());
    RunSegment& segment = segments_.now();
    for (const Pose& X : report.substeps) segment.check->add(X, static_cast<std::uint32_t>(segment.freed));
    if (holds_first_) X_ = report.proxy.X;
    const double tick_us = settings_.real_time ? 1e-3 * static_cast<double>(took) : 0.0;
    if (segment.recorder) record(number, t, pen, report, tick_us);
    if (settings_.observer) observe(number, t, pen, tick_us);
    if (report.shrunk > 0) watch_.update(loop_, pen.state.pose, dt, summary_.held_fast);
    if (settings_.progress) show(t, pen, report);
  }

  /// What the hand carries beside the contacts: the weight of the part, and the pull of a guide along its path.
  void load(const PenSample& pen, double dt) noexcept {
    const double share = carried_.update(pen, dt);
    loop_.carry(share);
    if (!guide_ || !holds_first_) return;
    const Wrench pull = guide_->pull(pen.state.pose, dt);
    loop_.pull({share * pull.force, share * pull.torque});
  }

  void observe(std::uint64_t number, double t, const PenSample& pen, double tick_us) {
    const ServoStatistics servo = settings_.real_time ? pen_->statistics() : ServoStatistics();
    settings_.observer->after_tick(
        {number, t, pen, loop_, segments_.now().number, tick_us, pen_->servo_late_us(), servo});
  }

  /// Another part is held: the pen comes to mean it where it is.
  void grasp(PenSample& pen) noexcept {
    const Pose& X = loop_.report().proxy.X;
    watch_.begin(X);
    pen_->grasp(loop_.center(), loop_.coupling(), X);
    pen.state.pose = X;
    pen.state.velocity = {};
    holds_first_ = segments_.now().held == held_part(file_.scene).name;
  }

  /// There is no pen to follow: the part stays, and the servo hears that this loop lives.
  void wait(std::int64_t now) {
    ProxyState still = loop_.report().proxy;
    still.velocity = {};
    pen_->publish(still, {}, static_cast<std::uint64_t>(summary_.ticks), sequence_, now);
    if (settings_.progress) settings_.progress->device.store(pen_->connected(), std::memory_order_relaxed);
  }

  void record(std::uint64_t number, double t, const PenSample& pen, const TickReport& report, double tick_us) {
    RecordFrame frame;
    frame.tick = number;
    frame.t = t;
    frame.y = pen.state.pose;
    frame.wrench = pen.wrench;
    frame.contacts = report.contacts;
    frame.gap = report.gap;
    frame.tick_us = tick_us;
    frame.lag_reason = report.lag_reason;
    frame.forces = report.forces;
    for (const Pose& X : report.substeps) {
      frame.x = X;
      segments_.now().recorder->push(frame);
      ++frame.substep;
    }
  }

  void count_lag(const TickReport& report) {
    LagSummary& lag = summary_.lag;
    lagging_ = held_up(report.lag, loop_.lag_bound(), report.lag_reason);
    lag.max_m = std::max(lag.max_m, report.lag);
    if (report.lag > loop_.lag_bound()) ++lag.ticks[static_cast<std::size_t>(report.lag_reason)];
    lag.unexplained = report.unexplained_lag_ticks;
  }

  void show(double t, const PenSample& pen, const TickReport& report) {
    RunProgress& p = *settings_.progress;
    p.t.store(t, std::memory_order_relaxed);
    p.depth.store(goal_.depth(X_), std::memory_order_relaxed);
    p.contacts.store(report.contacts, std::memory_order_relaxed);
    p.force.store(pen.wrench.force.norm(), std::memory_order_relaxed);
    p.lag_reason.store(report.lag > loop_.lag_bound() ? report.lag_reason : LagReason::none, std::memory_order_relaxed);
    p.device.store(true, std::memory_order_relaxed);
    p.held.store(watch_.held(), std::memory_order_relaxed);
  }

  const SceneFile file_;
  const RunSettings& settings_;
  HapticLoop loop_;
  std::unique_ptr<SimulatedDevice> device_;  // null: another process's
  std::unique_ptr<PenPort> pen_;
  std::optional<PathGuide> guide_;
  RunGoal goal_;
  double duration_;
  RunCheck check_;
  RunSegments segments_;
  Pose X_ = loop_.report().proxy.X;  // of the part that the file holds
  bool holds_first_ = true;          // that part is held
  bool lagging_ = false;             // at the end of the last tick, over the bound and not for a contact
  FitWatch watch_{loop_, file_.scene};
  WeightRamp carried_;
  std::uint64_t sequence_ = 0;  // of the pen's sample that the last tick answered
  LatencyHistogram tick_times_;
  std::string missing_;  // of real time, for the contact loop
  RunSummary summary_;
};

}  // namespace

RunSummary run_session(const SceneFile& file, const RunSettings& settings) {
  return Session(file, settings).run();
}

}  // namespace tegotae
