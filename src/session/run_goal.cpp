#include "session/run_goal.hpp"

#include <charconv>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"

namespace tegotae {

namespace {

// Of the script's way and of the held part's radius: what a spring between hand and part leaves when the script ends a
// little inside an obstacle.
constexpr double kEndTolerance = 0.02;
constexpr double kEndRotationTolerance = 0.1;  // rad

}  // namespace

std::string exact_text(double x) {
  char number[32];
  return {number, std::to_chars(number, number + sizeof number, x).ptr};
}

std::string goal_text(const Pose& X) {
  std::string text;
  for (const double x : {X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z()})
    text += (text.empty() ? "" : ",") + exact_text(x);
  return text;
}

RunGoal::RunGoal(const SceneFile& file, const Vec3& center)
    : center_(center),
      end_(file.script.pose(file.script.end())),
      from_(file.script.pose(file.script.begin()) * center) {
  // The part goes `scale` times the pen's way.
  end_ = displaced(end_, center, {(file.scene.scale - 1) * (end_ * center - from_), Vec3::Zero()});
  const Vec3 way = end_ * center - from_;
  if (way.norm() > 0) direction_ = way.normalized();
  const SimulatedDeviceSettings& pen = file.device;
  tolerance_ = kEndTolerance * (way.norm() + radius_about(*held_part(file.scene).mesh, center)) +
               pen.friction / pen.hand.stiffness + pen.position_resolution;
}

bool RunGoal::reached(const Pose& X) const {
  const Displacement d = missing(X);
  return d.dp.norm() <= tolerance_ && d.dr.norm() <= kEndRotationTolerance;
}

}  // namespace tegotae
