#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/loop/clash.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Whether the held part is kept out of a fixed part that it touched or overlapped at the start.
enum class InitialContactState : std::uint8_t {
  active,   ///< yes
  shrunk,   ///< of a copy of the fixed part that is smaller by InitialContact::relief
  filtered  ///< no
};

/// A fixed part that the held part touches or overlaps at the start.
struct InitialContact {
  /// No number in the order of coming free: not yet.
  static constexpr std::uint32_t kNotYet = 0xffffffffu;

  std::size_t part = 0;  ///< the fixed part, index into Scene::parts
  Clash clash;           ///< where the scene puts the held part: touch or overlap, gap or depth, place
  double relief = 0;     ///< m: by how much the fixed part's faces are moved inwards while the pair is relieved
  InitialContactState state = InitialContactState::active;  ///< by the last tick
  /// When it came free, counted from 1 over the pairs that did after the first tick began; 0: before, kNotYet: not yet.
  std::uint32_t freed = 0;
};

/// How the held part starts, and what has become of it.
struct InitialContactReport {
  std::vector<InitialContact> pairs;  ///< that were not free, in the order of the scene's parts
  /// m: how far the point of the held part that went farthest was moved to part the pairs that touch.
  double shift = 0;
};

}  // namespace tegotae
