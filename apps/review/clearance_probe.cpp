#include "review/clearance_probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "feature/simplex_distance.hpp"
#include "loop/scene_parts.hpp"

namespace tegotae::review {
namespace {

// Of a bound that is itself a distance: what rounding may make of it.
constexpr double kSlack = 1e-9;

Simplex triangle(const TriangleMesh& mesh, std::uint32_t face, const Pose& X) {
  const auto& t = mesh.triangles[face];
  return {3, {X * mesh.vertices[t[0]], X * mesh.vertices[t[1]], X * mesh.vertices[t[2]]}};
}

}  // namespace

ClearanceProbe::ClearanceProbe(const Scene& scene)
    : scene_(scene), held_(held_part(scene)), ball_(bounding_sphere(*held_.mesh)) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    if (part.held) continue;
    const Sphere ball = bounding_sphere(*part.mesh);
    others_.push_back({i, {part.pose * ball.center, ball.radius}});
  }
}

bool ClearanceProbe::measure(Other& other, const Pose& X, double limit, Clearance& out) {
  const Part& part = scene_.parts[other.part];
  const Pose X_BA = part.pose.inverse() * X;
  const auto nearest = [&] {
    return closest_points(triangle(*held_.mesh, other.last.first, X_BA),
                          triangle(*part.mesh, other.last.second, Pose()));
  };
  // The nearest triangles of the last pose bound the distance at this one, mostly closely.
  ClosestPoints points = nearest();
  const double before = std::sqrt(points.squared_distance);
  const double bound = std::min(before, limit) * (1 + kSlack) + std::numeric_limits<double>::min();
  const double found = fcl_.distance_below(bound, *held_.mesh, *part.mesh, X_BA, other.last);
  if (found < bound) points = nearest();
  const double distance = found > 0 ? std::min(before, std::sqrt(points.squared_distance)) : 0;
  if (distance > limit) return false;
  out = {other.part, distance, part.pose * points.a, part.pose * points.b};
  return true;
}

void ClearanceProbe::at(const Pose& X, double reach, std::vector<Clearance>& out) {
  out.clear();
  order_.clear();
  const Vec3 center = X * ball_.center;
  for (std::size_t i = 0; i < others_.size(); ++i) {
    const Sphere& ball = others_[i].ball_W;
    order_.emplace_back((center - ball.center).norm() - ball_.radius - ball.radius, i);
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

}  // namespace tegotae::review
