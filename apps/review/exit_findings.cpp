#include "review/exit_findings.hpp"

#include <algorithm>
#include <limits>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "plan/exit.hpp"
#include "shared/clearance_probe.hpp"

namespace tegotae::review {
namespace {

std::vector<std::size_t> inside_of(const Scene& scene, const Vec3& center, double radius, const Pose& X) {
  std::vector<std::size_t> out;
  std::vector<apps::Clearance> all;
  apps::ClearanceProbe(scene).at(X, std::numeric_limits<double>::infinity(), all);  // the nearest first
  for (const apps::Clearance& c : all) {
    if (!out.empty() && c.distance > Exit::margin(radius)) break;
    Scene two;
    two.parts = {held_part(scene), scene.parts[c.part]};
    if (!Exit(two, center, radius).is_out(X)) out.push_back(c.part);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

ExitFindings find_exit(const Scene& scene, const Vec3& center, const Pose& first, const Pose& goal, const Pose& end) {
  if (scene.parts.size() < 2) return {true, true, true, {}};
  const double radius = radius_about(*held_part(scene).mesh, center);
  const Exit exit(scene, center, radius);
  ExitFindings out{exit.is_out(first), exit.is_out(goal), exit.is_out(end), {}};
  // A goal may be no farther out than Exit asks for, and a part that stops within the tolerance of it a little less.
  out.at_end |= out.at_goal && exit.is_beside(end);
  if (!out.at_end) out.inside = inside_of(scene, center, radius, end);
  return out;
}

}  // namespace tegotae::review
