#pragma once

#include "tegotae/device/script.hpp"

namespace tegotae::apps {

/// What the insertion has to do with, m. World z points up out of the hole; z = 0 is the block's top face.
struct PegTask {
  Vec3 tip = Vec3::Zero();  ///< center of the peg's lower face, peg's file frame (its axis is z)
  double diameter = 0;      ///< of the peg
  double depth = 0;         ///< of the hole
};

/// Height of the tip above the block's top face at the start of the script, m.
double start_height(const PegTask& task);

/// A hand that misses the hole: comes down a millimeter off and three degrees tilted, hits the rim, slides, goes in
/// tilted until it jams, straightens up, and rocks its way down to the bottom. It begins and ends upright over the
/// hole's axis.
StylusScript insertion_script(const PegTask& task);

}  // namespace tegotae::apps
