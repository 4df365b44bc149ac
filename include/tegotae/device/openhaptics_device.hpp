#pragma once

#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Returns the rotation from the device's axes (right, up, toward the user) to those of a world whose z points up and
/// whose y points away from the user.
Quat desktop_axes();

/// Which device of the vendor to use, and how its axes lie in the world.
struct OpenHapticsSettings {
  std::string library = "libHD.so";  ///< library of the vendor's runtime, which start() loads
  std::string device;                ///< its name in the vendor's setup; empty: the default device
  Quat axes = desktop_axes();        ///< from the device's axes to the world's
};

/// A pen of 3D Systems (PHANTOM Premium, Touch and others) through OpenHaptics' HDAPI, which start() loads. Its
/// reference point is the gimbal, the origin of the pen's frame.
///
/// The vendor's scheduler calls back at its own rate (1 kHz). read() and write() exchange data with it through
/// mailboxes and never wait. A command that is older than 20 ms is not rendered. After an error of the device no force
/// is rendered for half a second.
class OpenHapticsDevice final : public Device {
 public:
  /// Stores the settings. Loads and connects nothing; start() does.
  explicit OpenHapticsDevice(const OpenHapticsSettings& settings = {});
  ~OpenHapticsDevice() override;  ///< stops

  /// Returns the properties that the vendor's library reports; before start(), the defaults of DeviceInfo.
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
