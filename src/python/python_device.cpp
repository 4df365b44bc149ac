#include "python/python_device.hpp"

#include <nanobind/stl/string.h>

#include <chrono>
#include <string>
#include <utility>

#include "python/arrays.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::python {
namespace {

/// Slower than this the safety chain takes the pen for silent now and then; faster than this no servo is.
constexpr double kMinRate = 50, kMaxRate = 4000;  // Hz
constexpr double kVelocityCutoff = 50;            // Hz, as of the simulated pen
constexpr std::int64_t kCountNs = 250'000'000;    // over which the rate is the mean

double checked(double rate) {
  if (!(rate >= kMinRate && rate <= kMaxRate))
    throw Error(ErrorKind::setting, "PythonPen: the rate must be from 50 to 4000 Hz, not " + std::to_string(rate));
  return rate;
}

}  // namespace

PythonDevice::PythonDevice(nb::object hand, const PythonDeviceSettings& settings)
    : hand_(std::move(hand)), settings_(settings), velocity_(kVelocityCutoff, 0, 0) {
  checked(settings.rate);
  if (!nb::hasattr(hand_, "read")) throw Error(ErrorKind::setting, "PythonPen: the hand has no method read()");
  renders_ = nb::hasattr(hand_, "write");
  info_.name = nb::cast<std::string>(hand_.type().attr("__name__"));
  info_.force_freedom = renders_ ? 6 : 0;
  info_.limits = settings.limits;
  info_.continuous_force = settings.continuous_force;
  info_.friction = 0;
  info_.position_resolution = 0;
}

PythonDevice::~PythonDevice() {
  // Destroyed by Python, with the GIL; a rig that ran it has stopped it.
  stop();
}

void PythonDevice::exchange(std::int64_t now_ns) {
  Force force;
  if (renders_ && force_.read(force)) {
    const double* w = force.wrench;
    hand_.attr("write")(to_array(Wrench{Vec3(w[0], w[1], w[2]), Vec3(w[3], w[4], w[5])}));
  }
  const nb::object given = hand_.attr("read")();
  const Pose X = pose_of(numbers(given, {4, 4}, "the pose that read() returned").data, "the pose that read() returned");
  velocity_.add(X.p, X.q, now_ns);
  const Twist& v = velocity_.velocity();
  const std::uint64_t sequence = samples_.load(std::memory_order_relaxed) + 1;
  pose_.write({{X.q.w(), X.q.x(), X.q.y(), X.q.z(), X.p.x(), X.p.y(), X.p.z()},
               {v.v.x(), v.v.y(), v.v.z(), v.w.x(), v.w.y(), v.w.z()},
               now_ns,
               sequence});
  samples_.store(sequence);
  count(now_ns);
}

void PythonDevice::count(std::int64_t now_ns) noexcept {
  if (samples_ == 1) counted_ns_ = now_ns, counted_ = 1;
  if (now_ns - counted_ns_ < kCountNs) return;
  reached_ = 1e9 * static_cast<double>(samples_ - counted_) / static_cast<double>(now_ns - counted_ns_);
  counted_ns_ = now_ns;
  counted_ = samples_;
}

void PythonDevice::fail(std::exception_ptr why) noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  failure_ = std::move(why);
  failed_ = true;
  first_.notify_all();
}

void PythonDevice::work() {
  const nb::gil_scoped_acquire python;
  if (!python.is_valid()) return;
  try {
    ask_until_stopped();
  } catch (...) {
    fail(std::current_exception());
  }
}

void PythonDevice::ask_until_stopped() {
  const auto period = static_cast<std::int64_t>(1e9 / settings_.rate);
  std::int64_t next_ns = monotonic_ns();
  while (running_) {
    exchange(monotonic_ns());
    if (samples_ == 1) {
      const std::lock_guard<std::mutex> lock(mutex_);
      first_.notify_all();
    }
    const nb::gil_scoped_release others_go_on;
    next_ns += period;
    const std::int64_t now_ns = monotonic_ns();
    if (next_ns < now_ns) next_ns = now_ns;
    std::this_thread::sleep_for(std::chrono::nanoseconds(next_ns - now_ns));
  }
}

void PythonDevice::start() {
  if (running_) throw Error(ErrorKind::device, "another rig uses this PythonPen until that rig stops");
  failed_ = false;
  failure_ = nullptr;
  samples_ = 0;
  reached_ = 0;
  now_ns_ = 0;
  velocity_ = VelocityFilter(kVelocityCutoff, 0, 0);
  force_.write({});
  running_ = true;
  if (!wall_clock_) {
    const nb::gil_scoped_acquire python;
    try {
      exchange(0);
    } catch (...) {
      running_ = false;
      throw;
    }
    return;
  }
  thread_ = std::thread([this] { work(); });
  std::unique_lock<std::mutex> lock(mutex_);
  first_.wait(lock, [this] { return failed_ || samples_ > 0; });
  lock.unlock();
  if (!failed_) return;
  stop();
  const nb::gil_scoped_acquire python;
  rethrow();
}

void PythonDevice::stop() {
  running_ = false;
  if (!thread_.joinable()) return;
  if (PyGILState_Check() != 0) {
    const nb::gil_scoped_release others_go_on;
    thread_.join();
  } else {
    thread_.join();
  }
}

void PythonDevice::rethrow() {
  std::exception_ptr why;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    why = std::exchange(failure_, nullptr);
  }
  if (why) std::rethrow_exception(why);
}

DeviceState PythonDevice::read() noexcept {
  DeviceState state;
  Sample s;
  if (!pose_.read(s)) return state;
  state.pose = {Quat(s.pose[0], s.pose[1], s.pose[2], s.pose[3]), Vec3(s.pose[4], s.pose[5], s.pose[6])};
  state.velocity.w = Vec3(s.velocity[3], s.velocity[4], s.velocity[5]);
  state.velocity.v = Vec3(s.velocity[0], s.velocity[1], s.velocity[2]) + state.velocity.w.cross(state.pose.q * center_);
  state.time_ns = s.time_ns;
  state.sequence = s.sequence;
  return state;
}

void PythonDevice::write(const Wrench& w) noexcept {
  force_.write({{w.force.x(), w.force.y(), w.force.z(), w.torque.x(), w.torque.y(), w.torque.z()}});
}

DeviceStatus PythonDevice::status() const noexcept {
  if (!running_ || failed_) return DeviceStatus::uninitialized;
  return renders_ ? DeviceStatus::enabled : DeviceStatus::ready;
}

ForceOff PythonDevice::reason() const noexcept {
  if (!running_ || failed_) return ForceOff::disconnected;
  return renders_ ? ForceOff::none : ForceOff::no_force;
}

void PythonDevice::advance(double dt) noexcept {
  if (!running_ || failed_) return;
  now_ns_ += static_cast<std::int64_t>(1e9 * dt + 0.5);
  const nb::gil_scoped_acquire python;
  try {
    exchange(now_ns_);
  } catch (...) {
    fail(std::current_exception());
  }
}

}  // namespace tegotae::python
