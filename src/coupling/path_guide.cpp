#include "coupling/path_guide.hpp"

#include <algorithm>
#include <cmath>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Poses nearer to each other than this (m of the hand) are one.
constexpr double kSame = 1e-9;
// Segments to each side of the last place that are looked at in a tick, and how many when the hand is elsewhere.
constexpr std::size_t kWindow = 16, kSweep = 64;

}  // namespace

PathGuide::PathGuide(const std::vector<Pose>& path, const PathGuideSettings& settings)
    : settings_(settings),
      radius_(settings.coupling.stiffness > 0
                  ? std::sqrt(settings.coupling.torsional_stiffness / settings.coupling.stiffness)
                  : 0) {
  if (path.empty()) throw Error(ErrorKind::setting, "guide: a path needs a pose");
  double length = 0;
  Pose from = path.front();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Displacement step = displacement(from, path[i], settings_.center);
    const double way = whiten(step).norm();
    if (!(way > kSame)) continue;
    segments_.push_back({from, step, length, length + way});
    length += way;
    from = path[i];
  }
  if (segments_.empty()) segments_.push_back({from, {}, 0, 0});
  nearest_.distance = distance_ = kReach;
}

Vec6 PathGuide::whiten(const Displacement& d) const noexcept {
  Vec6 z;
  z << d.dp / settings_.scale, radius_ * d.dr;
  return z;
}

PathGuide::Place PathGuide::place_on(std::size_t segment, const Pose& Y) const noexcept {
  const Segment& s = segments_[segment];
  const Vec6 way = whiten(displacement(s.from, Y, settings_.center)), step = whiten(s.step);
  const double square = step.squaredNorm();
  const double share = square > 0 ? std::clamp(way.dot(step) / square, 0.0, 1.0) : 0;
  return {segment, s.begin + share * (s.end - s.begin), (way - share * step).norm()};
}

void PathGuide::search(std::size_t first, std::size_t count, const Pose& Y, Place& best) const noexcept {
  const std::size_t end = std::min(first + count, segments_.size());
  for (std::size_t i = first; i < end; ++i) {
    const Place place = place_on(i, Y);
    if (place.distance < best.distance) best = place;
  }
}

void PathGuide::follow(const Pose& Y) noexcept {
  Place best = place_on(nearest_.segment, Y);
  search(nearest_.segment > kWindow ? nearest_.segment - kWindow : 0, 2 * kWindow + 1, Y, best);
  if (best.distance > kReach) {
    search(sweep_, kSweep, Y, best);
    sweep_ = sweep_ + kSweep < segments_.size() ? sweep_ + kSweep : 0;
  }
  nearest_ = best;
  distance_ = best.distance;
}

Pose PathGuide::at(double along) const noexcept {
  const auto after = std::upper_bound(segments_.begin(), segments_.end(), along,
                                      [](double value, const Segment& s) { return value < s.end; });
  const Segment& s = after == segments_.end() ? segments_.back() : *after;
  const double share = s.end > s.begin ? std::min((along - s.begin) / (s.end - s.begin), 1.0) : 0;
  return displaced(s.from, settings_.center, share * s.step);
}

Wrench PathGuide::pull(const Pose& Y, double dt) noexcept {
  follow(Y);
  const double fade = std::clamp(2 * (1 - distance_ / kReach), 0.0, 1.0);
  strength_ = std::min(fade, strength_ + dt / kReturn);
  // Back to the path, and along it. Where the nearest place is a corner, what comes after it counts: before it, the
  // pull goes into the wall.
  Vec6 way = whiten(displacement(Y, at(nearest_.along), settings_.center)) / kSoft;
  const Segment& here = segments_[nearest_.segment];
  const bool over = nearest_.along >= here.end && nearest_.segment + 1 < segments_.size();
  const Segment& next = over ? segments_[nearest_.segment + 1] : here;
  if (next.end > next.begin)
    way += std::min(1.0, (length() - nearest_.along) / kSoft) / (next.end - next.begin) * whiten(next.step);
  const Vec6 pull = strength_ * settings_.force / std::max(way.norm(), 1.0) * way;
  return {pull.head<3>(), radius_ * pull.tail<3>()};
}

}  // namespace tegotae
