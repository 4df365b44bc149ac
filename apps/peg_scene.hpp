#pragma once

#include <string>
#include <vector>

#include "tegotae/sim/scene_file.hpp"

namespace tegotae::apps {

// Fits that can be told from each other and still fit: at 0.9995 the radial clearance is 5 µm.
inline constexpr double kLoosestRatio = 0.5;
inline constexpr double kTightestRatio = 0.9995;

/// A peg over its hole of 20 mm, and the hand that carries it in.
struct PegScene {
  double ratio;                         ///< diameter of the peg by that of the hole
  double start_height;                  ///< of the peg's tip above the block's top face, m
  std::vector<StylusScript::Key> keys;  ///< of the script
  SceneFile file;
};

/// Throws Error for a ratio out of range. Meshes and script are rounded to what write_peg_scene() writes: the files and
/// the program give the same run.
PegScene make_peg_scene(double ratio);

/// "0.94"
std::string ratio_text(double ratio);

/// Writes `folder`/peg_in_hole_R.toml, the two meshes (mm) and the script. Throws Error when that fails.
void write_peg_scene(const PegScene& scene, const std::string& folder);

}  // namespace tegotae::apps
