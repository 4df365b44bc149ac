#pragma once

#include <array>
#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/latency_histogram.hpp"
#include "tegotae/device/shm.h"
#include "tegotae/transport/channel.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Statistics of a servo since its construction.
struct ServoStatistics {
  std::uint64_t ticks = 0;    ///< number of ticks
  std::uint64_t missed = 0;   ///< periods of the schedule that had no tick
  double rate_hz = 0;         ///< achieved, mean; 0 before the second tick
  LatencySummary late_us;     ///< µs, wake-up minus schedule
  LatencySummary compute_us;  ///< µs, the servo's own work in a tick
  double recent_late_us = 0;  ///< µs, the largest lateness in the last tenth of a second
  /// How often the force went off, or stayed off for a new reason; the index is ForceOff.
  std::array<std::uint64_t, TEGOTAE_SHM_REASONS> force_off{};
};

/// Returns the newest statistics of the servo at the other end of `channel`; zeros before the first.
ServoStatistics servo_statistics(const ChannelReader& channel) noexcept;

}  // namespace tegotae
