#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Why the held part is not where the pen wants it at the end of a tick. Recordings store these numbers.
enum class LagReason : std::uint8_t {
  none = 0,     ///< the part is there, or the resolver itself lets it trail ("impulse" has inertia)
  contact = 1,  ///< contacts block the part: they allow no motion that would reduce the remaining lag
  time = 2,     ///< the tick ran out of time or work; the part continues in the next tick
  /// Time was left and no contact blocks the part, but no motion could be certified: a capacity of the certificate was
  /// exhausted.
  capacity = 3,
  /// The tick did not follow the pen: the pen's pose was invalid, or the pen has just grasped another part.
  suspended = 4
};

/// Number of lag reasons.
inline constexpr int kLagReasons = 5;

/// Returns one word: "none", "contact", "time", "capacity", "suspended".
constexpr const char* to_string(LagReason reason) {
  constexpr const char* words[kLagReasons] = {"none", "contact", "time", "capacity", "suspended"};
  const auto i = static_cast<unsigned>(reason);
  return i < kLagReasons ? words[i] : "unknown";
}

}  // namespace tegotae
