#include "shared/clearance_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "loop/scene_parts.hpp"
#include "narrowphase/patch_cache.hpp"

namespace tegotae::apps {

ClearanceProbe::ClearanceProbe(const Scene& scene)
    : scene_(scene), held_(held_part(scene)), ball_(bounding_sphere(*held_.mesh)) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    if (part.held) continue;
    const Sphere ball = bounding_sphere(*part.mesh);
    others_.push_back({i, {part.pose * ball.center, ball.radius}, std::nullopt, 0});
  }
}

void ClearanceProbe::go_to(const Pose& X) {
  const Displacement d = displacement(last_, X, ball_.center);
  way_ += d.dp.norm() + ball_.radius * d.dr.norm();
  last_ = X;
}

bool ClearanceProbe::measure(Other& other, const Pose& X, double limit, Clearance& out) {
  const Part& part = scene_.parts[other.part];
  if (!other.surfaces) other.surfaces.emplace(cached_patch_tree(held_.mesh), cached_patch_tree(part.mesh));
  NearestPoints points;
  const bool within = other.surfaces->within(limit, part.pose.inverse() * X, points);
  other.until = way_ + (within ? points.distance : limit);
  if (within) out = {other.part, points.distance, part.pose * points.on_a, part.pose * points.on_b};
  return within;
}

void ClearanceProbe::at(const Pose& X, double reach, std::vector<Clearance>& out) {
  out.clear();
  order_.clear();
  go_to(X);
  const Vec3 center = X * ball_.center;
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Sphere& ball = others_[i].ball_W;
    const double apart = (center - ball.center).norm() - ball_.radius - ball.radius;
    order_.emplace_back(std::max(apart, others_[i].until - way_), i);
  }
  std::sort(order_.begin(), order_.end());
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [least, i] : order_) {
    const double limit = std::max(best, reach);
    if (least > limit) break;
    Clearance c;
    if (!measure(others_[i], X, limit, c)) continue;
    best = std::min(best, c.distance);
    out.push_back(c);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Clearance& a, const Clearance& b) { return a.distance < b.distance; });
  // What was measured before anything nearer was known.
  while (out.size() > 1 && out.back().distance > reach) out.pop_back();
}

}  // namespace tegotae::apps
