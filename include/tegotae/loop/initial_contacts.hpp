#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/loop/clash.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Whether the contact loop keeps the held part out of a fixed part that it touched or overlapped at the start.
enum class InitialContactState : std::uint8_t {
  active,   ///< yes
  shrunk,   ///< it keeps it out of a copy that is smaller by InitialContact::inward_offset
  filtered  ///< no
};

/// A fixed part that the held part touches or overlaps at the start.
struct InitialContact {
  /// Value of `freed` of a pair that has not separated yet.
  static constexpr std::uint32_t kNotYet = 0xffffffffu;

  std::size_t part = 0;      ///< the fixed part, index into Scene::parts
  Clash clash;               ///< at the held part's pose in the scene: touch or overlap, gap or depth, place
  double inward_offset = 0;  ///< m: how far the fixed part's faces are moved inward while the pair is shrunk
  InitialContactState state = InitialContactState::active;  ///< after the last tick
  /// Order in which the pairs separated, counted from 1 over those that separated after the first tick began. 0:
  /// separated before; kNotYet: not separated yet.
  std::uint32_t freed = 0;
};

/// How the held part starts, and the state of its initial contacts since.
struct InitialContactReport {
  std::vector<InitialContact> pairs;  ///< pairs that were not free at the start, in the order of the scene's parts
  /// m: how far any point of the held part moved at most when the loop separated the pairs that touch.
  double shift = 0;
};

}  // namespace tegotae
