#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tegotae/sim/scene.hpp"

namespace tegotae::bench {

/// What a scene is to reach; the ratio is against the median of FCL's all-contacts query.
struct Targets {
  double p50_us;
  double p999_us;
  double fcl_ratio = 0;  ///< 0: none
};

/// A scene to measure, with the way of its pen and the poses at which FCL is asked.
struct BenchScene {
  std::string name;
  Targets targets;
  Scene scene;
  std::size_t held_triangles = 0;
  std::size_t fixed_triangles = 0;  ///< of all fixed parts, instances counted
  /// One round of the pen; rounds follow each other.
  std::function<void(int round, std::vector<Pose>& way)> add_round;
  /// Pegs: a point whose deepest z says how far they went in (file frame, m).
  std::optional<Vec3> tip;
  double depth = 0;  ///< pegs: of the hole, m
  /// Deepest overlap at which FCL is asked, m.
  double overlap = 1e-4;
  /// Pegs: poses of the held part with a two-sided overlap of 0 to `overlap`. Others are taken from the run.
  std::vector<Pose> jam_poses;
};

/// The names of all scenes, smallest first.
const std::vector<std::string>& scene_names();

/// Throws Error for an unknown name. `jams` is the number of jam poses wanted.
BenchScene make_scene(const std::string& name, int jams);

}  // namespace tegotae::bench
