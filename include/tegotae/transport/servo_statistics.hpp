#pragma once

#include <array>
#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/latency_histogram.hpp"
#include "tegotae/device/shm.h"
#include "tegotae/transport/channel.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What the servo has done since it was made.
struct ServoStatistics {
  std::uint64_t ticks = 0;    ///< made
  std::uint64_t missed = 0;   ///< periods of the schedule that had no tick
  double rate_hz = 0;         ///< achieved, mean; 0 before the second tick
  LatencySummary late_us;     ///< wake-up minus schedule
  LatencySummary compute_us;  ///< the servo's own work in a tick
  double recent_late_us = 0;  ///< the largest lateness in the last tenth of a second
  /// How often the force went off, or stayed off for a new reason, by ForceOff.
  std::array<std::uint64_t, TEGOTAE_SHM_REASONS> force_off{};
};

/// What the servo at the other end of `channel` last told of itself; zeros before it has.
ServoStatistics servo_statistics(const ChannelReader& channel) noexcept;

}  // namespace tegotae
