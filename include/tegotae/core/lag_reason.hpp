#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Why the held part is not where the pen wants it at the end of a tick. The numbers are those of recordings.
enum class LagReason : std::uint8_t {
  none = 0,      ///< it is there; or the resolver lets it trail by itself ("impulse" has inertia)
  contact = 1,   ///< contacts are in the way: they allow no motion that would take off what is left of the lag
  time = 2,      ///< the tick's time, or the work of one tick, ended first; the part goes on in the next tick
  capacity = 3,  ///< time was left, but no motion could be proved free and no contact is in the way: a capacity of the
                 ///< certificate was used up
  suspended = 4  ///< the tick did not follow the pen: its pose was not one that a pen can have, or another part has
                 ///< just been taken up
};

/// How many reasons there are.
inline constexpr int kLagReasons = 5;

/// One word: "none", "contact", "time", "capacity", "suspended".
constexpr const char* to_string(LagReason reason) {
  constexpr const char* words[kLagReasons] = {"none", "contact", "time", "capacity", "suspended"};
  const auto i = static_cast<unsigned>(reason);
  return i < kLagReasons ? words[i] : "unknown";
}

}  // namespace tegotae
