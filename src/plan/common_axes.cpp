#include "plan/common_axes.hpp"

#include <algorithm>

#include "loop/scene_parts.hpp"
#include "narrowphase/axis_pairs.hpp"
#include "narrowphase/patch_cache.hpp"

namespace tegotae {
namespace {

// Axes are one line when they lean from each other by less than this (rad) and pass at less than this part of the
// smaller surface's radius: more than the play of a fit, less than what stands beside it.
constexpr double kLean = 0.1, kApart = 0.1;

struct Line {
  Vec3 origin, direction;
};

Line line_of(const ProfileTree& profile) {
  return {profile.frame().origin, profile.frame().R.col(2)};
}

Line placed(const Pose& X, const Line& line) {
  return {X * line.origin, X.q * line.direction};
}

/// Whether the surfaces lie about one line, and beside each other along it.
bool is_one(const Line& a, const ProfileTree& of_a, const Line& b, const ProfileTree& of_b) {
  if (a.direction.cross(b.direction).norm() > kLean) return false;
  const Vec3 apart = a.origin - b.origin;
  if (apart.cross(b.direction).norm() > kApart * std::min(of_a.r_max(), of_b.r_max())) return false;
  const double sense = a.direction.dot(b.direction) < 0 ? -1 : 1, along = apart.dot(b.direction);
  const double low = along + std::min(sense * of_a.z_min(), sense * of_a.z_max());
  const double high = along + std::max(sense * of_a.z_min(), sense * of_a.z_max());
  return low < of_b.z_max() && high > of_b.z_min();
}

Line in_world(const CommonAxis& axis, const Pose& X) {
  return axis.with_held ? placed(X, {axis.origin, axis.direction}) : Line{axis.origin, axis.direction};
}

}  // namespace

Pose CommonAxis::turned(const Pose& X, double angle) const {
  const Line line = in_world(*this, X);
  const Quat turn(Eigen::AngleAxisd(angle, line.direction));
  return {(turn * X.q).normalized(), line.origin + turn * (X.p - line.origin) + rise * angle * line.direction};
}

Pose CommonAxis::shifted(const Pose& X, double way) const {
  return {X.q, X.p + way * in_world(*this, X).direction};
}

double CommonAxis::distance(const Pose& X, const Vec3& point) const {
  const Line line = in_world(*this, X);
  return (X * point - line.origin).cross(line.direction).norm();
}

std::vector<CommonAxis> common_axes(const Scene& scene, const Pose& X) {
  const SceneParts parts(scene);
  AxisPairing pairing(cached_patch_tree(parts.held->mesh));
  std::vector<CommonAxis> out;
  for (const Part* part : parts.fixed)
    for (const AxisPair& pair : *pairing.with(cached_patch_tree(part->mesh))) {
      const Line a = line_of(*pair.a), b = line_of(*pair.b);
      if (!is_one(placed(X, a), *pair.a, placed(part->pose, b), *pair.b)) continue;
      // A long thread is the guide of a short one: about the axis of that it would go astray where they lean.
      const bool with_held = pair.a->z_max() - pair.a->z_min() > pair.b->z_max() - pair.b->z_min();
      const Line line = with_held ? a : placed(part->pose, b);
      out.push_back({line.origin, line.direction, pair.b->frame().rise, with_held});
    }
  return out;
}

}  // namespace tegotae
