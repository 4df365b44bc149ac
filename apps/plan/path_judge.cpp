#include "plan/path_judge.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include "core/parallel_for.hpp"
#include "loop/scene_parts.hpp"
#include "narrowphase/fcl_pairs.hpp"

namespace tegotae::plan {
namespace {

constexpr double kStep = 20e-6;  // m
// Steps that one job asks about.
constexpr int kRun = 500;
// A distance takes FCL several times as long as a collision. It is asked for after so many steps, twice as many each
// time that it spares fewer than kWorth, and at once where the last one was worth it. Beyond the longest way that it is
// to spare (m) it is not needed.
constexpr int kPatience = 8, kMaxPatience = 256, kWorth = 3;
constexpr double kFarthest = 5e-3;
// FCL rounds distances.
constexpr double kShare = 0.9;

std::array<double, 14> key_of(const Pose& from, const Pose& to) {
  std::array<double, 14> key;
  double* next = key.data();
  for (const Pose* X : {&from, &to}) {
    next = std::copy_n(X->p.data(), 3, next);
    next = std::copy_n(X->q.coeffs().data(), 4, next);
  }
  return key;
}

/// When a distance is asked for.
class Patience {
 public:
  bool is_over() { return ++since_ > patience_; }
  void learn(double spared) {
    if (spared >= kWorth)
      patience_ = 0;
    else
      patience_ = std::clamp(2 * patience_, kPatience, kMaxPatience);
    since_ = 0;
  }

 private:
  int patience_ = kPatience, since_ = 0;
};

}  // namespace

/// FCL of one thread about a pose of the held part among the others.
class PathJudge::Asked {
 public:
  explicit Asked(const Scene& scene) : scene_(scene), held_(held_part(scene)) {}

  bool intersects(const Pose& X) {
    ++count;
    return std::any_of(scene_.parts.begin(), scene_.parts.end(), [&](const Part& part) {
      return !part.held && fcl_.intersect(*held_.mesh, *part.mesh, part.pose.inverse() * X);
    });
  }

  /// Of surfaces that do not intersect, m; kFarthest when it is more.
  double distance(const Pose& X) {
    ++count;
    double least = kFarthest;
    FclPairs::Faces faces;
    for (const Part& part : scene_.parts)
      if (!part.held)
        least = std::min(least, fcl_.distance_below(least, *held_.mesh, *part.mesh, part.pose.inverse() * X, faces));
    return least;
  }

  std::int64_t count = 0;  ///< of both questions

 private:
  const Scene& scene_;
  const Part& held_;
  FclPairs fcl_;
};

PathJudge::PathJudge(const Scene& scene, const Vec3& center) : center_(center) {
  for (const Vec3& v : held_part(scene).mesh->vertices) points_.push_back(v - center);
  const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < processors; ++i) fcl_.push_back(std::make_unique<Asked>(scene));
}

PathJudge::~PathJudge() = default;

std::int64_t PathJudge::asked() const {
  std::int64_t sum = 0;
  for (const auto& fcl : fcl_) sum += fcl->count;
  return sum;
}

PathVerdict PathJudge::ask(const std::vector<Pose>& path) {
  std::vector<Run> runs;
  std::vector<const Motion*> motions;
  for (std::size_t i = 0; i < path.size(); ++i) {
    // The first one is the pose that the path begins at.
    const auto [known, added] = asked_about_.try_emplace(key_of(path[i == 0 ? 0 : i - 1], path[i]));
    Motion& m = known->second;
    motions.push_back(&m);
    if (!added) continue;
    m = motion(path[i == 0 ? 0 : i - 1], path[i]);
    for (int first = 1; first <= m.steps; first += kRun)
      runs.push_back({&m, first, std::min(first + kRun - 1, m.steps)});
  }
  std::atomic<std::size_t> next{0};
  const auto work = [&](int processor) {
    for (std::size_t i = next++; i < runs.size(); i = next++)
      look_at(runs[i], *fcl_[static_cast<std::size_t>(processor)]);
  };
  parallel_for(static_cast<int>(fcl_.size()), 0, work, {});
  for (const Run& run : runs) {
    run.motion->intersecting += run.intersecting;
    clear_.insert(clear_.end(), run.clear.begin(), run.clear.end());
  }
  PathVerdict out;
  for (const Motion* m : motions) {
    out.poses += m->steps;
    out.intersecting += m->intersecting;
  }
  return out;
}

PathJudge::Motion PathJudge::motion(const Pose& from, const Pose& to) const {
  Motion m{from, displacement(from, to, center_), 0, 1, 0};
  // A point goes around the axis of the turn through the center, and along with that.
  double around = 0;
  for (const Vec3& p : points_) around = std::max(around, m.d.dr.cross(from.q * p).norm());
  m.way = m.d.dp.norm() + around;
  m.steps = std::max(1, static_cast<int>(std::ceil(m.way / kStep)));
  return m;
}

double PathJudge::spared(const Vec3& center, const Mat3& turn, std::size_t& near) const {
  for (std::size_t i = 0; i < clear_.size(); ++i) {
    // Paths go by in their order: the one that was near, and those after it, come first.
    const std::size_t at = (near + i) % clear_.size();
    const Clear& known = clear_[at];
    const Vec3 gone = center - known.center;
    if (gone.norm() >= known.reach) continue;
    const Mat3 turned = turn - known.turn;
    double farthest = 0;
    for (const Vec3& p : points_) {
      farthest = std::max(farthest, (gone + turned * p).norm());
      if (farthest >= known.reach) break;
    }
    if (farthest >= known.reach) continue;
    near = at;
    return known.reach - farthest;
  }
  return 0;
}

void PathJudge::look_at(Run& run, Asked& fcl) const {
  const Motion& m = *run.motion;
  Patience patience;
  std::size_t near = 0;
  for (int k = run.first; k <= run.last; ++k) {
    const Pose X = displaced(m.from, center_, static_cast<double>(k) / m.steps * m.d);
    const Vec3 center = X * center_;
    const Mat3 turn = X.q.toRotationMatrix();
    double left = spared(center, turn, near);
    if (left == 0 && patience.is_over()) {
      const double distance = kShare * fcl.distance(X);
      patience.learn(distance / kStep);
      // Of less than a step it may be rounding: whether triangles meet there, the collision says.
      if (distance >= kStep) {
        left = distance;
        run.clear.push_back({center, turn, left});
      }
    }
    if (left == 0 && fcl.intersects(X)) ++run.intersecting;
    // As long as no point has gone that far, nothing is met.
    if (left > 0 && m.way > 0) k += static_cast<int>(std::min(left * m.steps / m.way, 1.0 * m.steps));
  }
}

}  // namespace tegotae::plan
