#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::bench {

/// What a scene is to reach; the ratio is against the median of FCL's all-contacts query.
struct Targets {
  double p50_us;         ///< infinite: none
  double p999_us;        ///< infinite: none
  double fcl_ratio = 0;  ///< 0: none
};

/// What a scene with a seat is to reach besides.
struct SeatTargets {
  double rest_p50_us;  ///< median of the ticks at rest
  double arrival_ms;   ///< after the pen
  double slide_mm_s;   ///< 0: none, the seat does not let the part slide
  double off_ms;       ///< after the pen
};

/// A pen that comes straight down on a seat, presses, rests, goes aside and lifts.
struct SeatPen {
  Vec3 seat;                  ///< position of the held part, turned as the world, where it touches its seat, m
  double above;               ///< where the pen starts and ends, over the seat, m
  double below;               ///< how far under the seat it presses, m
  Vec3 slide = Vec3::Zero();  ///< how far it goes aside there, m
  SeatTargets targets;
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
  /// Or a pen that follows the clock (s, at hand speed) for so long; a fast one does the same in half of the time.
  std::function<Pose(double t)> pen;
  double pen_seconds = 0;
  bool all_ticks = false;  ///< also ticks without contact count: the part is near everywhere
  /// Pegs: a point whose deepest z says how far they went in (file frame, m).
  std::optional<Vec3> tip;
  double depth = 0;  ///< pegs: of the hole, m
  /// Deepest overlap at which FCL is asked, m.
  double overlap = 1e-4;
  /// Pegs: poses of the held part with a two-sided overlap of 0 to `overlap`. Others are taken from the run.
  std::vector<Pose> jam_poses;
  std::optional<SeatPen> seat;  ///< parts that mate over an area
  /// About so many ticks of a run keep their poses for the check after it, and at most so many are asked in FCL's own
  /// measurement: it takes milliseconds for each on large scenes, and seconds where they mate.
  int most_fcl_poses = 400;
};

/// Rounds of a pen differ by this turn (rad), the golden angle: no two alike.
inline constexpr double kRoundTurn = 2.39996323;

inline std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// Adds a part to the scene, and its triangles to the counts.
void add_part(BenchScene& bench, const std::string& name, std::shared_ptr<const TriangleMesh> mesh, const Pose& pose,
              bool held);

/// The names of all scenes, smallest first.
const std::vector<std::string>& scene_names();

/// Throws Error for an unknown name. `jams` is the number of jam poses wanted.
BenchScene make_scene(const std::string& name, int jams);

}  // namespace tegotae::bench
