#include "plan/exit.hpp"

#include <algorithm>

#include "core/numbers.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Of the held part's radius: how far out it is to be, and how far around the other parts it may go on its way.
constexpr double kMarginShare = 0.05, kAround = 2.5;
constexpr double kSameDirection = 0.9999;
constexpr int kHalvings = 40;

WorldBox around_others(const Scene& scene) {
  WorldBox box = {Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  for (const Part& part : scene.parts) {
    if (part.held) continue;
    for (const Vec3& v : part.mesh->vertices) {
      const Vec3 p = part.pose * v;
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  }
  if (!(box.low.x() <= box.high.x())) throw Error("there is no other part: the held one is out wherever it is");
  return box;
}

}  // namespace

Exit::Exit(const Scene& scene, const Vec3& center, double radius)
    : center_(center),
      margin_(margin(radius)),
      box_(bounding_box(*held_part(scene).mesh)),
      others_(around_others(scene)) {
  const Vec3 start = held_part(scene).pose * center, around = Vec3::Constant(kAround * radius);
  room_ = {others_.low.cwiseMin(start) - around, others_.high.cwiseMax(start) + around};
}

double Exit::margin(double radius) {
  return kMarginShare * radius;
}

bool Exit::is_out(const Pose& X) const {
  return is_beside(X, margin_);
}

bool Exit::is_beside(const Pose& X, double margin) const {
  const Vec3 middle = X * box_.center;
  const Vec3 half = X.q.toRotationMatrix().cwiseAbs() * box_.half;
  return ((middle - half - others_.high).array() > margin).any() ||
         ((others_.low - middle - half).array() > margin).any();
}

std::vector<Pose> Exit::straight_out(const Pose& from) const {
  std::vector<Vec3> directions;
  for (const Quat& turn : {Quat(Quat::Identity()), from.q})
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        const Vec3 d = sign * (turn * Vec3::Unit(axis));
        if (std::none_of(directions.begin(), directions.end(),
                         [&](const Vec3& other) { return other.dot(d) > kSameDirection; }))
          directions.push_back(d);
      }
  std::vector<Pose> out;
  const double farthest = 2 * (room_.high - room_.low).norm();
  for (const Vec3& d : directions) {
    // Along a line the part is out from some place on.
    double in = 0, past = farthest;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (in + past);
      (is_out({from.q, from.p + middle * d}) ? past : in) = middle;
    }
    out.push_back({from.q, from.p + past * d});
  }
  return out;
}

}  // namespace tegotae
