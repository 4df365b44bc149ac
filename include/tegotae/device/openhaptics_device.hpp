#pragma once

#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// The device's axes (right, up, toward the user) as those of a world whose z points up and y away from the user.
Quat desktop_axes();

/// Which device of the vendor, and how it stands.
struct OpenHapticsSettings {
  std::string library = "libHD.so";  ///< of the vendor's runtime; loaded by start()
  std::string device;                ///< its name in the vendor's set-up; empty: the default device
  Quat axes = desktop_axes();        ///< from the device's axes to the world's
};

/// A pen of 3D Systems (PHANTOM Premium, Touch and others) through OpenHaptics' HDAPI, found at run time. Its
/// reference point is the gimbal, the origin of the pen's frame.
///
/// The vendor's scheduler calls back at its own rate (1 kHz); read() and write() meet it in mailboxes and never wait.
/// A command that is older than 20 ms is not rendered, and after an error of the device nothing is for half a second.
class OpenHapticsDevice final : public Device {
 public:
  /// Nothing is loaded or connected before start().
  explicit OpenHapticsDevice(const OpenHapticsSettings& settings = {});
  ~OpenHapticsDevice() override;  ///< stops

  /// What the vendor's library tells of the device; the defaults before start().
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
