#include "view/follower.hpp"

#include <algorithm>
#include <limits>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::view {
namespace {

// The part is led this far (m) towards where the pen was.
constexpr double kPush = 5e-5;
// A part that is led and stays this far (m) behind the recording is held back by something that was not there.
constexpr double kAstray = 1e-4;
// A recording that begins this near (m, of the center of mass) to where the scene holds the part began there: parts
// that touch are eased off each other from there, not from a pose at which they already were.
constexpr double kSameStart = 5e-4, kSameTurn = 0.02;

HapticLoop led_loop(Scene& scene, const std::string& path, const Pose& first) try {
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  for (Part& part : scene.parts) {
    if (!part.held) continue;
    const Displacement d = displacement(part.pose, first, bounding_sphere(*part.mesh).center);
    if (d.dp.norm() > kSameStart || d.dr.norm() > kSameTurn) part.pose = first;
  }
  return HapticLoop(scene);
} catch (const Error& e) {
  throw Error(path + ": does not fit this scene: " + e.what());
}

}  // namespace

Follower::Follower(Scene scene, const std::string& path, const Pose& first)
    : loop_(led_loop(scene, path, first)), radius_(radius_about(*held_part(scene).mesh, loop_.center())) {}

void Follower::step(const RecordFrame& row) {
  const Displacement push = displacement(row.x, row.y, loop_.center());
  const double size = push.dp.norm() + radius_ * push.dr.norm();
  loop_.step(displaced(row.x, loop_.center(), (size > kPush ? kPush / size : 1) * push), 1e-3);
  astray_ = displacement(loop_.report().proxy.X, row.x, loop_.center()).dp.norm() > kAstray;
  strayed_ += astray_ ? 1 : 0;
}

}  // namespace tegotae::view
