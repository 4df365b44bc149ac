#pragma once

#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::shapes {

/// A part to be taken out of another one, and what is known of the way by construction.
struct Puzzle {
  std::string name;
  TriangleMesh held, fixed;  ///< file frames; the fixed part's is the world
  Pose start;                ///< of the held part
  /// A way out: poses of the held part between which its `pivot` goes straight and it turns at a constant rate. Empty:
  /// there is none.
  std::vector<Pose> known;
  Vec3 pivot = Vec3::Zero();  ///< m, held part's file frame
  double least_turn = 0;      ///< rad: by less than that no way out turns the part in sum
  double least_way = 0;       ///< m: nor does its center of mass go less than that

  Scene scene() const;
};

/// loose, straight, l-shaped, screw, burr, bent-bar, key, and locked-in, which has no way out.
std::vector<Puzzle> puzzles();
/// The one of that name. Throws tegotae::Error.
Puzzle puzzle(const std::string& name);

}  // namespace tegotae::shapes
