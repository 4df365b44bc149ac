#include "tegotae/transport/servo_statistics.hpp"

#include <algorithm>
#include <iterator>

#include "transport/shm_convert.hpp"

namespace tegotae {

ServoStatistics servo_statistics(const ChannelReader& channel) noexcept {
  tegotae_shm_statistics s;
  if (!channel.read(s)) return {};
  ServoStatistics out;
  out.ticks = s.ticks;
  out.missed = s.missed;
  out.rate_hz = s.rate_hz;
  out.late_us = latencies(s.late_us);
  out.compute_us = latencies(s.compute_us);
  out.recent_late_us = s.recent_late_us;
  std::copy(std::begin(s.force_off), std::end(s.force_off), out.force_off.begin());
  return out;
}

}  // namespace tegotae
