#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>

#include "device/mailbox.hpp"
#include "device/velocity_filter.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae::python {

/// How a PythonDevice runs, and what it says of itself.
struct PythonDeviceSettings {
  double rate = 1000;             ///< Hz at which Python is asked, at most
  WrenchLimits limits;            ///< as DeviceInfo
  double continuous_force = 1.4;  ///< as DeviceInfo
};

/// A device whose pose an object in Python tells, and that tells it the wrench. A Python thread of its own asks the
/// object, as often as it can up to the set rate, and meets the servo in two mailboxes: the servo never waits for
/// Python. In simulated time the object is asked by advance(), once a servo tick, in the thread that steps.
///
/// Like a simulated pen its body is the held part itself: the pose is that of the part's file frame.
class PythonDevice final : public Device {
 public:
  /// `hand`: with read() -> (4, 4) and, for a pen that renders force, write((6,)). With the GIL held. Throws Error.
  PythonDevice(nanobind::object hand, const PythonDeviceSettings& settings);
  ~PythonDevice() override;

  DeviceInfo info() const override { return info_; }
  void start() override;
  void stop() override;
  DeviceState read() noexcept override;
  void write(const Wrench& wrench) noexcept override;
  DeviceStatus status() const noexcept override;
  ForceOff reason() const noexcept override;
  Vec3 reference_point() const noexcept override { return center_; }
  void set_held_center(const Vec3& center) noexcept override { center_ = center; }
  void use_wall_clock(bool on) noexcept override { wall_clock_ = on; }
  void advance(double dt) noexcept override;

  double rate() const noexcept { return reached_.load(); }            ///< Hz that Python reached lately
  std::uint64_t samples() const noexcept { return samples_.load(); }  ///< since start()
  bool failed() const noexcept { return failed_.load(); }             ///< read() or write() raised
  void rethrow();                                                     ///< what they raised, once; with the GIL held
  const nanobind::object& hand() const { return hand_; }
  void forget() { hand_ = nanobind::object(); }  ///< for the garbage collector

 private:
  struct Sample {
    double pose[7], velocity[6];  // q as w, x, y, z, then p; v of the file frame's origin, then w
    std::int64_t time_ns;
    std::uint64_t sequence;
  };
  struct Force {
    double wrench[6];
  };

  void exchange(std::int64_t now_ns);
  void work();
  void ask_until_stopped();
  void fail(std::exception_ptr why) noexcept;
  void count(std::int64_t now_ns) noexcept;

  nanobind::object hand_;
  const PythonDeviceSettings settings_;
  DeviceInfo info_;
  bool renders_ = false, wall_clock_ = true;
  Vec3 center_ = Vec3::Zero();  // the servo's thread alone
  Mailbox<Sample> pose_;
  Mailbox<Force> force_;

  // Of who asks Python.
  VelocityFilter velocity_;
  std::int64_t now_ns_ = 0;  // of simulated time
  std::int64_t counted_ns_ = 0;
  std::uint64_t counted_ = 0;
  std::thread thread_;

  std::atomic<bool> running_{false}, failed_{false};
  std::atomic<double> reached_{0};
  std::atomic<std::uint64_t> samples_{0};
  std::mutex mutex_;  // of the next two
  std::condition_variable first_;
  std::exception_ptr failure_;
};

}  // namespace tegotae::python
