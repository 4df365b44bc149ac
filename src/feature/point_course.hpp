#pragma once

#include <cstdint>
#include <vector>

#include "narrowphase/patch_tree.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// Where a point comes nearest to a surface on its course.
struct NearPlace {
  double distance;        ///< m
  std::uint32_t place;    ///< number on the course
  std::uint32_t surface;  ///< whose `face` it is; set by who asks
  std::uint32_t face;
};

/// The places of a point along a path, with a hierarchy over them: each run of places lies along a chord. So a course
/// is held against a surface's hierarchy as a whole, and most of its places are never asked about. Mutable scratch of
/// one thread; allocates.
class PointCourse {
 public:
  /// The places (m, in order); call build() after they were set.
  std::vector<Vec3>& places() { return places_; }
  void build();

  /// Sets `best` to what is nearer on the surface of `tree`, whose file frame sees the places through `X_FW`, and
  /// returns whether there was any. Exact: distances of points and triangles in double precision.
  bool nearer(const PatchTree& tree, const Pose& X_FW, NearPlace& best);
  /// The same for one place and one face, to have a bound to begin with.
  bool nearer_there(const PatchTree& tree, const Pose& X_FW, std::uint32_t place, std::uint32_t face,
                    NearPlace& best) const;

 private:
  /// All places of a run are within `off` of the segment middle ± half, m.
  struct Run {
    Vec3 middle, half;
    double off;
  };
  /// A run and a node that may be nearer than what is known; the run in the tree's frame.
  struct Open {
    double bound;
    std::uint32_t level, run, node;
    Run at;
  };

  const Run& run(std::uint32_t level, std::uint32_t i) const { return runs_[starts_[level] + i]; }
  void consider(const PatchTree& tree, Open open, std::uint32_t node, double best);
  void split_run(const PatchTree& tree, const Open& open, double best);
  bool ask(const PatchTree& tree, const Open& open, NearPlace& best) const;

  std::vector<Vec3> places_;
  std::vector<Run> runs_;              // level after level, from single runs to all
  std::vector<std::uint32_t> starts_;  // of the levels in runs_, and the end
  std::vector<Open> open_;             // stack
  Mat3 R_;                             // of the question: from the places' frame to the tree's
  Vec3 t_;
};

}  // namespace tegotae
