#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/device/shm.h"

namespace tegotae TEGOTAE_EXPORT {

/// What of the pen's motion the held part does not follow.
enum class Clutch : std::uint32_t {
  none = TEGOTAE_SHM_CLUTCH_NONE,
  translation = TEGOTAE_SHM_CLUTCH_TRANSLATION,  ///< it turns with the pen but stays in its place
  all = TEGOTAE_SHM_CLUTCH_ALL,                  ///< it stays as it is
};

/// What the pen's buttons do to the mapping from pen to part.
struct MappingSettings {
  std::uint32_t clutch_buttons = 0;       ///< while one of these is pressed the pen is clutched; 0: none is
  Clutch clutch_by_button = Clutch::all;  ///< what of it
};

/// The least that an application may ask for: meters of the world for a meter of the pen.
inline constexpr double kMinScale = 0.01;
/// The most that an application may ask for.
inline constexpr double kMaxScale = 100;

}  // namespace tegotae
