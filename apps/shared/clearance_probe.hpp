#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "broadphase/bounding_spheres.hpp"
#include "feature/surface_distance.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae::apps {

/// How far the held part is from another one at a pose.
struct Clearance {
  std::size_t part = 0;           ///< index into Scene::parts
  double distance = 0;            ///< of the two surfaces, m; 0 when they intersect
  Vec3 on_held_W = Vec3::Zero();  ///< the points nearest to each other, m
  Vec3 on_other_W = Vec3::Zero();
};

/// Distances from the held part of a scene to the others, by their triangles. For one thread.
class ClearanceProbe {
 public:
  /// Keeps a reference to `scene`.
  explicit ClearanceProbe(const Scene& scene);

  /// The part nearest to the held one at `X`, and all others that are nearer than `reach` (m), the nearest first. Poses
  /// along a path, in order, are asked fastest. Distances are exact to within NearFront::kTolerance.
  void at(const Pose& X, double reach, std::vector<Clearance>& out);

 private:
  struct Other {
    std::size_t part;
    Sphere ball_W;
    std::optional<SurfaceDistance> surfaces;  ///< from when it is first asked on
    double until = 0;                         ///< way at which it may touch the held part, by what was measured
  };
  bool measure(Other& other, const Pose& X, double limit, Clearance& out);
  void go_to(const Pose& X);

  const Scene& scene_;
  const Part& held_;
  Sphere ball_;
  std::vector<Other> others_;
  std::vector<std::pair<double, std::size_t>> order_;  ///< least possible distance, index into others_
  Pose last_;
  double way_ = 0;  ///< m, that no point of the held part has gone farther than
};

}  // namespace tegotae::apps
