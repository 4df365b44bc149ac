#include "study/routes.hpp"

#include <algorithm>
#include <cmath>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"
#include "plan/exit.hpp"
#include "shared/clearance_probe.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::study {
namespace {

// Of the held part's radius: between two poses that are looked at on a line, how far they are looked at, and the
// clearance at which the part counts as out.
constexpr double kStep = 1.0 / 25, kFarthest = 6, kOutShare = 0.05;
constexpr int kContactSteps = 2;  // at a tight end the part may touch for so many of them
// Of the radius: how far a part goes on that is out. A hand that is not led by a hole any more misses its goal by
// tenths of a millimeter, and a goal that is nearer than that has no tolerance for it.
constexpr double kFartherOut = 2;
constexpr double kHoverShare = 0.1, kMaxHover = 4e-3;  // over the rim: of the radius, at most (m)
constexpr double kSameDirection = 0.996;               // cosine of 5 degrees

struct Direction {
  std::string name;
  Vec3 along;  // unit, world: the way that the part goes
};

/// Adds those along the axes of the world and of a part that is turned by `turn`, but for those that are there.
void add_axes(const Quat& turn, std::vector<Direction>& out) {
  const auto add = [&out](const std::string& name, const Vec3& along) {
    if (std::none_of(out.begin(), out.end(), [&](const Direction& d) { return d.along.dot(along) > kSameDirection; }))
      out.push_back({name, along});
  };
  for (const bool own : {false, true})
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        const Vec3 unit = sign * Vec3::Unit(axis);
        const std::string letter = std::string(sign < 0 ? "-" : "") + "xyz"[axis];
        add(own ? "along the part's " + letter : "along " + letter, own ? Vec3(turn * unit) : unit);
      }
}

class RouteFinder {
 public:
  RouteFinder(const Scene& scene, const Pose& goal, const Vec3& center)
      : start_(held_part(scene).pose),
        goal_(goal),
        center_(center),
        mesh_(*held_part(scene).mesh),
        radius_(radius_about(mesh_, center)),
        probe_(scene) {
    way_ = goal * center - start_ * center;
    if (way_.norm() < 1e-6) throw Error("the goal is where the held part starts; there is nothing to try");
    pulls_ = clearance(start_) < clearance(goal);
  }

  /// How much of the straight way is blocked, m: poses looked at that intersect.
  double blocked() {
    const double step = kStep * radius_;
    const auto n = static_cast<int>(way_.norm() / step);
    double length = 0;
    for (int i = kContactSteps + 1; i <= n; ++i)
      if (clearance({start_.q, start_.p + i * step * way_.normalized()}) == 0) length += step;
    return length;
  }

  /// The straight one.
  Route straight() {
    bool free = true;
    const Direction d = directions().front();
    const double depth = engaged(d.along, free);
    return pulls_ ? pull(d, depth) : push(d, depth);
  }

  std::vector<Route> routes() {
    std::vector<Route> out;
    for (const Direction& d : directions()) {
      bool free = true;
      const double depth = engaged(d.along, free);
      // The straight way is tried whatever is in it.
      if (!out.empty() && !free) continue;
      out.push_back(pulls_ ? pull(d, depth) : push(d, depth));
    }
    return out;
  }

 private:
  double clearance(const Pose& X) {
    probe_.at(X, 0, near_);
    return near_.empty() ? INFINITY : near_.front().distance;
  }

  std::vector<Direction> directions() const {
    std::vector<Direction> out = {{"straight", way_.normalized()}};
    add_axes((pulls_ ? start_ : goal_).q, out);
    return out;
  }

  /// How far from its tight end (the goal, or the start when it is pulled out) the part goes along a line until it is
  /// out, m. `free`: no pose looked at on the way intersects, the tight end itself left out.
  double engaged(const Vec3& along, bool& free) {
    const Pose& tight = pulls_ ? start_ : goal_;
    const double sign = pulls_ ? 1 : -1;
    free = true;
    for (double s = kStep; s < kFarthest; s += kStep) {
      const double gap = clearance({tight.q, tight.p + sign * s * radius_ * along});
      if (gap >= kOutShare * radius_) return s * radius_;
      if (gap == 0 && s > kContactSteps * kStep) free = false;
      if (!free && along != way_.normalized()) break;
    }
    free = false;
    return std::min(kFarthest * radius_, way_.norm());
  }

  Route push(const Direction& d, double depth) {
    InsertionTask t;
    t.start = start_;
    t.goal = goal_;
    t.tip = tip(d.along);
    t.inward = d.along;
    t.depth = depth;
    t.hover = std::min(kHoverShare * radius_, kMaxHover);
    return {d.name, {t}, false, goal_};
  }

  Route pull(const Direction& d, double depth) {
    InsertionTask t;
    t.start = start_;
    t.tip = center_;
    t.inward = d.along;
    t.hover = 0;
    t.own_errors = false;
    const Vec3 straight = way_.normalized();
    if (d.along == straight && start_.q.angularDistance(goal_.q) < 1e-9) {
      t.goal = goal_;
      t.depth = way_.norm();
      return {d.name, {t}, true, goal_};
    }
    t.goal = {start_.q, start_.p + depth * d.along};
    t.depth = depth;
    InsertionTask carry = t;
    carry.start = t.goal;
    carry.goal = goal_;
    const Vec3 rest = goal_ * center_ - t.goal * center_;
    carry.depth = rest.norm();
    carry.inward = carry.depth > 0 ? Vec3(rest.normalized()) : d.along;
    if (carry.depth < 1e-6) return {d.name, {t}, true, goal_};
    return {d.name, {t, carry}, true, goal_};
  }

  /// On the line through the center, as far along the way as the part reaches; file frame.
  Vec3 tip(const Vec3& along) const {
    const Vec3 own = goal_.q.conjugate() * along;
    double farthest = 0;
    for (const Vec3& v : mesh_.vertices) farthest = std::max(farthest, own.dot(v - center_));
    return center_ + farthest * own;
  }

  Pose start_, goal_;
  Vec3 center_, way_;
  const TriangleMesh& mesh_;
  double radius_;
  apps::ClearanceProbe probe_;
  std::vector<apps::Clearance> near_;
  bool pulls_ = false;
};

}  // namespace

std::vector<Route> find_routes(const Scene& scene, const Pose& goal, const Vec3& center) {
  return RouteFinder(scene, goal, center).routes();
}

std::vector<Route> find_routes_out(const Scene& scene, const Vec3& center) {
  const Part& held = held_part(scene);
  const double radius = radius_about(*held.mesh, center);
  const Exit exit(scene, center, radius);
  if (exit.is_out(held.pose))
    throw Error(held.name + " is out of all other parts where it starts; there is nothing to try");
  std::vector<Direction> directions;
  add_axes(held.pose.q, directions);
  struct WayOut {
    double blocked, length;
    Route route;
  };
  std::vector<WayOut> ways;
  for (Pose goal : exit.straight_out(held.pose)) {
    const Vec3 along = (goal.p - held.pose.p).normalized();
    goal.p += kFartherOut * radius * along;
    const auto known = std::find_if(directions.begin(), directions.end(),
                                    [&](const Direction& d) { return d.along.dot(along) > kSameDirection; });
    if (known == directions.end()) continue;  // so near to another one that it has no name of its own
    RouteFinder finder(scene, goal, center);
    const double blocked = finder.blocked();
    ways.push_back({blocked, (goal.p - held.pose.p).norm(), finder.straight()});
    ways.back().route.name = known->name;
    directions.erase(known);
  }
  std::stable_sort(ways.begin(), ways.end(), [](const WayOut& a, const WayOut& b) {
    return a.blocked != b.blocked ? a.blocked < b.blocked : a.length < b.length;
  });
  std::vector<Route> out;
  for (WayOut& way : ways)
    if (out.empty() || way.blocked == 0) out.push_back(std::move(way.route));
  return out;
}

}  // namespace tegotae::study
