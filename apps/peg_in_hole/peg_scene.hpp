#pragma once

#include <string>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::apps {

// Range in which fits differ and still have clearance: at 0.9995 the radial clearance is 5 µm.
inline constexpr double kLoosestRatio = 0.5;
inline constexpr double kTightestRatio = 0.9995;
/// Height of the peg's tip above the block's top face where the script starts, m.
inline constexpr double kStartHeight = 0.02;

/// Facets around peg and hole: finer fits get more, so that the facets' height stays below the clearance.
int facets(double ratio);

/// "0.94"
std::string ratio_text(double ratio);

/// Writes a peg over its hole of 20 mm, and the script of the hand that carries it in, to `folder`: the scene file, two
/// meshes (mm) and a CSV file. `ratio` is the diameter of the peg by that of the hole. Returns the path of the scene
/// file. Throws Error for a ratio out of range and when a file cannot be written.
std::string write_peg_scene(double ratio, const std::string& folder);

/// The scene as a run of those files, which go when they are read: a run of the program and one of its files are the
/// same run, single-precision mesh reading and all.
SceneFile make_peg_scene(double ratio);

}  // namespace tegotae::apps
