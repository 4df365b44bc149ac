#pragma once

#include "bench/measure_loop.hpp"

namespace tegotae::bench {

/// FCL's collide with all contacts: every intersecting pair of triangles, without contact points or normals, which is
/// the cheapest way to ask for all.
struct FclFigures {
  LatencySummary us{};
  double pairs = 0;         ///< intersecting triangle pairs, mean
  std::size_t poses = 0;    ///< asked
  std::size_t overlap = 0;  ///< of them, how many do intersect
};

/// Asks about the scene's jam poses; a scene without them takes the run's own poses in contact, moved towards the pen
/// until some point has gone 0 to `scene.overlap`. Every part whose bounding sphere is near is asked.
FclFigures measure_fcl(const BenchScene& scene, const Vec3& center, const LoopTrace& trace, int poses);

}  // namespace tegotae::bench
