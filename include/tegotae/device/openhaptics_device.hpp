#pragma once

#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Returns the rotation from the device's axes (right, up, toward the user) to those of a world whose z points up and y
/// away from the user.
Quat desktop_axes();

/// Which of the vendor's devices to use, and how it stands.
struct OpenHapticsSettings {
  std::string library = "libHD.so";  ///< of the vendor's runtime; loaded by start()
  std::string device;                ///< its name in the vendor's set-up; empty: the default device
  Quat axes = desktop_axes();        ///< from the device's axes to the world's
};

/// A pen of 3D Systems (PHANTOM Premium, Touch and others) through OpenHaptics' HDAPI, which is loaded at run time. Its
/// reference point is the gimbal, the origin of the pen's frame.
///
/// The vendor's scheduler calls back at its own rate (1 kHz). read() and write() exchange data with it through
/// mailboxes and never wait. A command that is older than 20 ms is not rendered. After an error of the device no force
/// is rendered for half a second.
class OpenHapticsDevice final : public Device {
 public:
  /// Loads and connects nothing yet; start() does.
  explicit OpenHapticsDevice(const OpenHapticsSettings& settings = {});
  ~OpenHapticsDevice() override;  ///< stops

  /// Returns what the vendor's library reports of the device; the defaults before start().
  DeviceInfo info() const override;
  /// Throws Error when the library or a function of it is missing, or when the device cannot be used.
  void start() override;
  void stop() override;
  DeviceState read() noexcept override;
  void write(const Wrench& wrench) noexcept override;
  DeviceStatus status() const noexcept override;
  ForceOff reason() const noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
