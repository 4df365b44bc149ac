#include "tegotae/sim/session.hpp"

#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>
#include <optional>

#include "broadphase/bounding_spheres.hpp"
#include "sim/pose_check.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/record/recorder.hpp"
#include "tegotae/servo/contact_link.hpp"
#include "tegotae/sim/haptic_loop.hpp"

namespace tegotae {

namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;  // of the servo, and at most of the contact loop
constexpr double kPeriod = 1e-9 * kPeriodNs;

// RunSummary::completed. Of the script's way and of the held part's radius: what a spring between hand and part leaves
// when the script ends a little inside an obstacle.
constexpr double kEndTolerance = 0.02;
constexpr double kEndRotationTolerance = 0.1;  // rad

const Part& held_part(const Scene& scene) {
  return *std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; });
}

HapticLoop make_loop(const SceneFile& file, bool real_time) try {
  Scene scene = file.scene;
  // A budget in seconds would let the load of the machine decide what a run in virtual time does.
  if (!real_time) scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  return HapticLoop(scene);
} catch (const Error& e) {
  throw Error(file.path + ": " + e.what());
}

SimulatedDeviceSettings with_clock(SimulatedDeviceSettings settings, bool wall_clock) {
  settings.wall_clock = wall_clock;
  return settings;
}

void sleep_until(std::int64_t time_ns) {
  const timespec t = {static_cast<time_t>(time_ns / 1'000'000'000), static_cast<long>(time_ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

class Session {
 public:
  Session(const SceneFile& file, const RunSettings& settings)
      : file_(file),
        settings_(settings),
        loop_(make_loop(file, settings.real_time)),
        device_(with_clock(file.device, settings.real_time), file.script, loop_.center()),
        channel_(Channel::create()),
        servo_(device_, channel_),
        link_(channel_, file.scene.coupling, loop_.center()),
        script_seconds_(file.script.end() - file.script.begin()),
        duration_(settings.seconds > 0 ? settings.seconds : script_seconds_ + kSettleTime) {
    const Pose first = file.script.pose(file.script.begin()), last = file.script.pose(file.script.end());
    from_ = first * loop_.center();
    const Vec3 way = last * loop_.center() - from_;
    way_ = way.norm();
    if (way_ > 0) direction_ = way / way_;
    if (!settings.record.empty())
      recorder_.emplace(settings.record, settings.real_time ? RecordMode::threaded : RecordMode::synchronous, info());
    if (settings.progress) settings.progress->duration = duration_;
  }

  RunSummary run() {
    device_.start();
    settings_.real_time ? run_real_time() : run_virtual_time();
    device_.stop();
    if (recorder_) {
      recorder_->close();
      summary_.record_dropped = recorder_->dropped();
    }
    summary_.servo = servo_.statistics();
    summary_.tick_us = tegotae::summary(tick_times_);
    summary_.depth_m = depth(loop_.report().proxy.X);
    summary_.completed = summary_.seconds >= script_seconds_ && at_end(loop_.report().proxy.X);
    summary_.penetrating = check_.count_intersecting(file_.scene);
    return summary_;
  }

 private:
  bool stopped() const { return settings_.stop && settings_.stop->load(std::memory_order_relaxed); }

  void run_virtual_time() {
    const auto ticks = static_cast<std::int64_t>(std::ceil(duration_ / kPeriod - 1e-6));
    for (std::int64_t i = 0; i < ticks && !stopped(); ++i) {
      const std::int64_t now = i * kPeriodNs;
      servo_.tick(now);
      tick(static_cast<double>(i) * kPeriod, kPeriod, now);
      device_.advance(kPeriod);
      summary_.seconds = static_cast<double>(i + 1) * kPeriod;
    }
  }

  void run_real_time() {
    servo_.start();
    const std::int64_t start = monotonic_ns();
    std::int64_t last = start - kPeriodNs, next = start;
    while (!stopped()) {
      sleep_until(next);
      const std::int64_t now = monotonic_ns();
      summary_.seconds = 1e-9 * static_cast<double>(now - start);
      if (summary_.seconds >= duration_) break;
      tick(summary_.seconds, 1e-9 * static_cast<double>(now - last), now);
      last = now;
      // A tick that took longer than a period is followed at once, not by a burst that makes up for it.
      next = std::max(next + kPeriodNs, monotonic_ns());
    }
    servo_.stop();
  }

  void tick(double t, double dt, std::int64_t now) {
    PenSample pen;
    if (!link_.read(pen)) return;  // the servo has not begun
    const std::int64_t begin = monotonic_ns();
    const TickReport& report = loop_.step(pen.state.pose, dt);
    const std::int64_t took = monotonic_ns() - begin;
    const std::uint64_t number = static_cast<std::uint64_t>(summary_.ticks++);
    link_.publish(report.proxy, number, pen.state.sequence, settings_.real_time ? monotonic_ns() : now);

    tick_times_.add(took);
    summary_.contacts_max = std::max(summary_.contacts_max, report.contacts);
    summary_.force_max_n = std::max(summary_.force_max_n, pen.wrench.force.norm());
    summary_.torque_max_nm = std::max(summary_.torque_max_nm, pen.wrench.torque.norm());
    for (const Pose& X : report.pieces) check_.add(X);
    if (recorder_) record(number, t, pen, report, settings_.real_time ? 1e-3 * static_cast<double>(took) : 0.0);
    if (settings_.progress) show(t, pen, report);
  }

  RecordingInfo info() const {
    return {file_.path, held_part(file_.scene).name, file_.scene.contact.resolver, settings_.program};
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
    for (const Pose& X : report.pieces) {
      frame.x = X;
      recorder_->push(frame);
      ++frame.substep;
    }
  }

  void show(double t, const PenSample& pen, const TickReport& report) {
    RunProgress& p = *settings_.progress;
    p.t.store(t, std::memory_order_relaxed);
    p.depth.store(depth(report.proxy.X), std::memory_order_relaxed);
    p.contacts.store(report.contacts, std::memory_order_relaxed);
    p.force.store(pen.wrench.force.norm(), std::memory_order_relaxed);
  }

  double depth(const Pose& X) const { return direction_.dot(X * loop_.center() - from_); }

  bool at_end(const Pose& X) const {
    const Pose end = file_.script.pose(file_.script.end());
    const Displacement d = displacement(X, end, loop_.center());
    const SimulatedDeviceSettings& pen = file_.device;
    const double tolerance = kEndTolerance * (way_ + radius_about(*held_part(file_.scene).mesh, loop_.center())) +
                             pen.friction / pen.hand.stiffness + pen.position_resolution;
    return d.dp.norm() <= tolerance && d.dr.norm() <= kEndRotationTolerance;
  }

  const SceneFile& file_;
  const RunSettings& settings_;
  HapticLoop loop_;
  SimulatedDevice device_;
  Channel channel_;
  Servo servo_;
  ContactLink link_;
  std::optional<Recorder> recorder_;
  double script_seconds_;
  double duration_;
  Vec3 from_ = Vec3::Zero();       // center of mass where the script starts
  Vec3 direction_ = Vec3::Zero();  // from there to where the script ends; zero when it ends where it starts
  double way_ = 0;
  PoseCheck check_;
  LatencyHistogram tick_times_;
  RunSummary summary_;
};

}  // namespace

RunSummary run_session(const SceneFile& file, const RunSettings& settings) {
  return Session(file, settings).run();
}

}  // namespace tegotae
