#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/nonblocking.hpp"
#include "coupling/local_model.hpp"
#include "coupling/passivity.hpp"
#include "coupling/pen_steps.hpp"
#include "servo/pen_mapping.hpp"
#include "servo/safety_chain.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/channel.hpp"

namespace tegotae {

/// One tick of the servo, without its schedule: pen in, mapping, local model, coupling, passivity, safety chain, wrench
/// out, pen state to the application.
class ServoTick {
 public:
  /// Keeps references. Throws Error for a setting out of range.
  ServoTick(Device& device, Channel& channel, const ServoSettings& settings);
  /// Never allocates, waits, locks or throws.
  void run(std::int64_t now_ns) noexcept TEGOTAE_NONBLOCKING;

  std::uint64_t ticks() const noexcept { return ticks_; }
  const std::array<std::uint64_t, TEGOTAE_SHM_REASONS>& force_off() const noexcept { return force_off_; }

 private:
  void read_application() noexcept;
  /// Tells the device how far it is ahead of the part while an application is there.
  void report_tracking_error(std::int64_t now_ns) noexcept;
  /// Wrench on the pen that the coupling asks for; sets what its springs store.
  Wrench coupling(double& stored) noexcept;
  /// Accounts for the way that the load of the part made.
  void lift(const ProxyState& x) noexcept;
  void follow_pen(const DeviceState& pen, SafetyInput& in) noexcept;
  void publish(const DeviceState& pen, const SafetyOutput& out, std::int64_t now_ns) noexcept;
  void describe_device(tegotae_shm_device& out) const noexcept;

  Device& device_;
  Channel& channel_;
  const ServoSettings settings_;
  const DeviceInfo info_;
  const SafetySettings safety_;
  SafetyChain chain_;
  PenWatch watch_;
  PenMapping mapping_;
  LocalModel local_;
  Passivity passivity_;
  PenSteps steps_;

  tegotae_shm_application application_{};
  bool attached_ = false;
  bool valid_ = false;  // what the application says can be
  CouplingSettings coupling_;
  MappingCommand command_;
  std::optional<Vec3> held_center_;  // what the device was told last
  double lifted_ = 0;                // J that moving the part against its load has stored since it has one
  bool carries_ = false;
  Pose carried_at_;  // its pose then

  bool started_ = false;  // a valid pen has been seen
  Pose pen_;              // raw, last
  Displacement moved_;    // since the last tick, of the pen's center
  Wrench rendered_;
  bool unmodified_ = false;
  std::uint32_t flags_ = 0;  // of this tick, beside the chain's
  ForceOff reason_ = ForceOff::none;
  std::int64_t last_ns_ = 0;
  std::uint64_t ticks_ = 0;
  std::array<std::uint64_t, TEGOTAE_SHM_REASONS> force_off_{};
};

}  // namespace tegotae
