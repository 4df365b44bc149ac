#pragma once

#include <vector>

#include "tegotae/device/script.hpp"

namespace tegotae::apps {

/// What the insertion has to do with, m. World z points up out of the hole; z = 0 is the block's top face.
struct PegTask {
  Vec3 tip = Vec3::Zero();  ///< center of the peg's lower face, peg's file frame (its axis is z)
  double start = 0;         ///< height of the tip at the start of the script
  double depth = 0;         ///< of the hole
};

/// A hand that misses the hole: comes down two millimeters off and three degrees tilted, hits the rim, slides, goes in
/// tilted until it jams, straightens up, and rocks its way down to the bottom. It begins and ends upright over the
/// hole's axis.
std::vector<StylusScript::Key> insertion_script(const PegTask& task);

}  // namespace tegotae::apps
