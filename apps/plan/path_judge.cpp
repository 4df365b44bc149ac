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
// time that it spares fewer steps than kWorth, and beyond the longest way that it is to spare (m) it is not needed.
constexpr int kPatience = 8, kMaxPatience = 256, kWorth = 8;
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

}  // namespace

/// FCL of one thread about a pose of the held part among the others.
class PathJudge::Asked {
 public:
  explicit Asked(const Scene& scene) : scene_(scene), held_(held_part(scene)) {}

  bool intersects(const Pose& X) {
    return std::any_of(scene_.parts.begin(), scene_.parts.end(), [&](const Part& part) {
      return !part.held && fcl_.intersect(*held_.mesh, *part.mesh, part.pose.inverse() * X);
    });
  }

  /// Of surfaces that do not intersect, m; kFarthest when it is more.
  double distance(const Pose& X) {
    double least = kFarthest;
    FclPairs::Faces faces;
    for (const Part& part : scene_.parts)
      if (!part.held)
        least = std::min(least, fcl_.distance_below(least, *held_.mesh, *part.mesh, part.pose.inverse() * X, faces));
    return least;
  }

 private:
  const Scene& scene_;
  const Part& held_;
  FclPairs fcl_;
};

PathJudge::PathJudge(const Scene& scene, const Vec3& center) : scene_(scene), center_(center) {
  for (const Vec3& v : held_part(scene).mesh->vertices) points_.push_back(v - center);
  const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 0; i < processors; ++i) fcl_.push_back(std::make_unique<Asked>(scene));
}

PathJudge::~PathJudge() = default;

PathVerdict PathJudge::ask(const std::vector<Pose>& path) {
  struct Run {
    Motion* motion;
    int first, last;
  };
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
  std::vector<std::int64_t> found(runs.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&](int processor) {
    for (std::size_t i = next++; i < runs.size(); i = next++)
      found[i] = intersecting(*runs[i].motion, runs[i].first, runs[i].last, *fcl_[static_cast<std::size_t>(processor)]);
  };
  parallel_for(static_cast<int>(fcl_.size()), 0, work, {});
  for (std::size_t i = 0; i < runs.size(); ++i) runs[i].motion->intersecting += found[i];
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

std::int64_t PathJudge::intersecting(const Motion& m, int first, int last, Asked& fcl) const {
  std::int64_t found = 0;
  int patience = kPatience, since = 0;
  for (int k = first; k <= last; ++k) {
    const Pose X = displaced(m.from, center_, static_cast<double>(k) / m.steps * m.d);
    if (fcl.intersects(X)) {
      ++found;
      continue;
    }
    if (++since < patience) continue;
    since = 0;
    // As long as no point has gone that far, nothing is met.
    const int spared = static_cast<int>(kShare * fcl.distance(X) / (m.way / m.steps));
    patience = spared < kWorth ? std::min(2 * patience, kMaxPatience) : kPatience;
    k += spared;
  }
  return found;
}

}  // namespace tegotae::plan
