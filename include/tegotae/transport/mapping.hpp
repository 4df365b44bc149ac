#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/device/shm.h"

namespace tegotae TEGOTAE_EXPORT {

/// Which part of the pen's motion the held part does not follow.
enum class Clutch : std::uint32_t {
  none = TEGOTAE_SHM_CLUTCH_NONE,                ///< the part follows all of it
  translation = TEGOTAE_SHM_CLUTCH_TRANSLATION,  ///< the part turns with the pen but stays in its place
  all = TEGOTAE_SHM_CLUTCH_ALL,                  ///< the part does not move
};

/// Effect of the pen's buttons on the mapping from pen to part.
struct MappingSettings {
  std::uint32_t clutch_buttons = 0;       ///< bit i: button i clutches the pen while it is pressed; 0: no button does
  Clutch clutch_by_button = Clutch::all;  ///< which part of the motion they clutch
};

/// Smallest scale that an application may set: meters of the world for a meter of the pen.
inline constexpr double kMinScale = 0.01;
/// Largest scale that an application may set.
inline constexpr double kMaxScale = 100;

}  // namespace tegotae
