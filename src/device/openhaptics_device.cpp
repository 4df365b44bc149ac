#include "tegotae/device/openhaptics_device.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "device/hdapi.hpp"
#include "device/mailbox.hpp"
#include "device/velocity_filter.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// The servo's command, or the scheduler's sample, is not believed when it is older: either side may have died.
constexpr std::int64_t kStaleNs = 20'000'000;
// Force stays off for so long after an error: the amplifiers toggle and ramp, and a fault that lasts is told in every
// frame.
constexpr std::int64_t kErrorHoldNs = 500'000'000;
constexpr int kMaxErrors = 8;  // the library stacks them
// In which the scheduler renders the last, zero command before it is stopped.
constexpr std::chrono::milliseconds kLastFrames(5);
constexpr double kVelocityCutoffHz = 50.0;
constexpr double kMmPerM = 1e3, kMilliPerUnit = 1e3;

struct Sample {
  double position[3];     // m, world axes
  double orientation[4];  // w, x, y, z
  double velocity[3], angular_velocity[3];
  std::int64_t time_ns;
  std::uint64_t sequence;
  std::uint64_t buttons;
};

struct Command {
  double force[3];   // N, device axes
  double torque[3];  // mN·m, device axes
  std::int64_t time_ns;
};

ForceOff reason_of(unsigned int error) {
  switch (error) {
    case HdApi::kWarmMotors:
      return ForceOff::thermal;
    case HdApi::kExceededForce:
    case HdApi::kExceededImpulse:
    case HdApi::kForceError:
      return ForceOff::force_exceeded;
    case HdApi::kExceededVelocity:
      return ForceOff::velocity;
    case HdApi::kCommError:
    case HdApi::kCommConfigError:
      return ForceOff::disconnected;
    default:
      return ForceOff::device_fault;
  }
}

void store(const Vec3& v, double (&out)[3]) {
  for (int i = 0; i < 3; ++i) out[i] = v[i];
}

}  // namespace

Quat desktop_axes() {
  return {std::sqrt(0.5), std::sqrt(0.5), 0, 0};  // a quarter turn about x: up becomes z, toward the user -y
}

struct OpenHapticsDevice::Impl {
  explicit Impl(const OpenHapticsSettings& settings_in)
      : settings(settings_in),
        to_world(settings.axes.normalized()),
        velocity(kVelocityCutoffHz, info.position_resolution, 0) {}

  OpenHapticsSettings settings;
  Quat to_world;
  DeviceInfo info;
  std::optional<HdApi> hd;
  HdApi::Handle handle = HdApi::kInvalidHandle;
  unsigned long callback = 0;

  Mailbox<Sample> samples;    // scheduler to servo
  Mailbox<Command> commands;  // servo to scheduler
  std::atomic<ForceOff> error{ForceOff::none};
  std::atomic<std::int64_t> error_ns{0};  // of the newest error

  // The scheduler's thread only.
  VelocityFilter velocity;
  std::uint64_t frames = 0;

  // The servo's thread only.
  bool started = false;
  Sample newest{};
  bool sampled = false;

  bool faulty(std::int64_t now) const {
    return error.load(std::memory_order_acquire) != ForceOff::none &&
           now - error_ns.load(std::memory_order_relaxed) < kErrorHoldNs;
  }

  void note(unsigned int code, std::int64_t now) {
    error_ns.store(now, std::memory_order_relaxed);
    error.store(reason_of(code), std::memory_order_release);
  }

  void frame() noexcept {
    const std::int64_t now = monotonic_ns();
    double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    int buttons = 0;
    hd->begin_frame(handle);
    hd->get_doubles(HdApi::kCurrentTransform, transform);
    hd->get_integers(HdApi::kCurrentButtons, &buttons);
    render(now);
    hd->end_frame(handle);
    bool good = true;
    for (int i = 0; i < kMaxErrors; ++i) {
      const HdApi::ErrorInfo info_now = hd->get_error();
      if (info_now.code == HdApi::kSuccess) break;
      note(info_now.code, now);
      good = good && reason_of(info_now.code) != ForceOff::disconnected;
    }
    if (good) publish(transform, buttons, now);  // what a lost device says of its pose is not a sample
  }

  void render(std::int64_t now) noexcept {
    Command command{};
    if (!commands.read(command) || now - command.time_ns > kStaleNs || faulty(now)) command = {};
    hd->set_doubles(HdApi::kCurrentForce, command.force);
    if (info.force_freedom == 6) hd->set_doubles(HdApi::kCurrentTorque, command.torque);
  }

  void publish(const double (&transform)[16], int buttons, std::int64_t now) noexcept {
    const Mat3 rotation = Eigen::Map<const Eigen::Matrix4d>(transform).topLeftCorner<3, 3>();
    const Vec3 point = to_world * (Vec3(transform[12], transform[13], transform[14]) / kMmPerM);
    // The frame of the pen at rest is that of the world: both sides of the rotation change axes.
    const Quat turned = (to_world * Quat(rotation).normalized() * to_world.conjugate()).normalized();
    velocity.add(point, turned, now);
    Sample sample{};
    store(point, sample.position);
    sample.orientation[0] = turned.w();
    for (int i = 0; i < 3; ++i) sample.orientation[i + 1] = turned.vec()[i];
    store(velocity.velocity().v, sample.velocity);
    store(velocity.velocity().w, sample.angular_velocity);
    sample.time_ns = now;
    sample.sequence = frames++;
    sample.buttons = static_cast<unsigned int>(buttons);
    samples.write(sample);
  }

  static unsigned int on_frame(void* impl) {
    static_cast<Impl*>(impl)->frame();
    return HdApi::kCallbackContinue;
  }

  /// Throws when the library has noted an error.
  void check(const std::string& what) {
    const HdApi::ErrorInfo found = hd->get_error();
    if (found.code == HdApi::kSuccess) return;
    const char* text = hd->error_string(found.code);
    throw Error(ErrorKind::device, "OpenHaptics: " + what + ": " + (text != nullptr ? text : "error") + " (code " +
                                       std::to_string(found.code) + ")");
  }

  void ask_info() {
    const char* model = hd->get_string(HdApi::kModelType);
    if (model != nullptr && *model != '\0') info.name = model;
    hd->get_integers(HdApi::kInputFreedom, &info.motion_freedom);
    hd->get_integers(HdApi::kOutputFreedom, &info.force_freedom);
    hd->get_doubles(HdApi::kMaxForce, &info.limits.force);
    hd->get_doubles(HdApi::kContinuousForce, &info.continuous_force);
    check("the device does not report its properties");
    info.force_freedom = info.force_freedom >= 6 ? 6 : 3;
    info.motion_freedom = info.motion_freedom >= 6 ? 6 : 3;
    if (info.force_freedom == 3) info.limits.torque = 0;
  }

  void shut_down() noexcept {
    if (callback != 0) {
      hd->stop_scheduler();
      hd->unschedule(callback);
    }
    callback = 0;
    if (handle != HdApi::kInvalidHandle) hd->disable_device(handle);
    handle = HdApi::kInvalidHandle;
  }

  void connect() {
    handle = hd->init_device(settings.device.empty() ? nullptr : settings.device.c_str());
    check("the device " + (settings.device.empty() ? "" : settings.device + " ") + "cannot be initialized");
    if (handle == HdApi::kInvalidHandle) throw Error(ErrorKind::device, "OpenHaptics: no device");
    hd->make_current_device(handle);
    ask_info();
    hd->enable(HdApi::kForceOutput);
    check("force output cannot be enabled");
    callback = hd->schedule_asynchronous(on_frame, this, HdApi::kDefaultPriority);
    check("the callback cannot be scheduled");
    hd->start_scheduler();
    check("the scheduler cannot be started");
  }
};

OpenHapticsDevice::OpenHapticsDevice(const OpenHapticsSettings& settings) : impl_(std::make_unique<Impl>(settings)) {}

OpenHapticsDevice::~OpenHapticsDevice() {
  if (impl_->started) impl_->shut_down();
}

DeviceInfo OpenHapticsDevice::info() const {
  return impl_->info;
}

void OpenHapticsDevice::start() {
  if (!impl_->hd) impl_->hd.emplace(impl_->settings.library);
  write({});
  try {
    impl_->connect();
  } catch (const Error&) {
    impl_->shut_down();
    throw;
  }
  impl_->started = true;
}

void OpenHapticsDevice::stop() {
  if (!impl_->started) return;
  impl_->started = false;
  write({});
  std::this_thread::sleep_for(kLastFrames);
  for (int i = 0; i < kMaxErrors && impl_->hd->get_error().code != HdApi::kSuccess; ++i) {  // of the past
  }
  impl_->shut_down();
  impl_->check("the device cannot be left in a safe state");
}

DeviceState OpenHapticsDevice::read() noexcept {
  impl_->sampled = impl_->samples.read(impl_->newest) || impl_->sampled;
  const Sample& s = impl_->newest;
  if (!impl_->sampled) return {};
  return {{Quat(s.orientation[0], s.orientation[1], s.orientation[2], s.orientation[3]), Vec3(s.position)},
          {Vec3(s.velocity), Vec3(s.angular_velocity)},
          static_cast<std::uint32_t>(s.buttons),
          s.time_ns,
          s.sequence};
}

void OpenHapticsDevice::write(const Wrench& wrench) noexcept {
  const Wrench safe = saturated(wrench, impl_->info.limits);
  const Quat to_device = impl_->to_world.conjugate();
  Command command{};
  store(to_device * safe.force, command.force);
  store(kMilliPerUnit * (to_device * safe.torque), command.torque);
  command.time_ns = monotonic_ns();
  impl_->commands.write(command);
}

DeviceStatus OpenHapticsDevice::status() const noexcept {
  if (!impl_->started || !impl_->sampled) return DeviceStatus::uninitialized;
  return reason() == ForceOff::none ? DeviceStatus::enabled : DeviceStatus::ready;
}

ForceOff OpenHapticsDevice::reason() const noexcept {
  if (!impl_->started) return ForceOff::software;
  const std::int64_t now = monotonic_ns();
  if (impl_->faulty(now)) return impl_->error.load(std::memory_order_relaxed);
  if (!impl_->sampled || now - impl_->newest.time_ns > kStaleNs) return ForceOff::disconnected;
  return ForceOff::none;
}

}  // namespace tegotae
