#include "families/touch_line.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tegotae/core/error.hpp"

namespace tegotae::test {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;
// Each step is the distance left, so a line that grazes a wall takes many.
constexpr int kMaxSteps = 10000;
// A line that comes askew to what it touches does so within some times the distance that is left; the rest is bisected
// where that is no more than this share of the whole.
constexpr double kAskew = 8, kBisected = 0.1;
// FCL takes triangles for degenerate, and 0 for their distance, when the square of their normal is under 1e-15: of
// 0.15 mm edges, in meters. So it is asked in this many units a meter.
constexpr double kUnits = 1e5;

fcl::Transform3d transform(const Pose& X) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = X.q.toRotationMatrix();
  t.translation() = kUnits * X.p;
  return t;
}

std::shared_ptr<Model> model_of(const TriangleMesh& mesh) {
  auto model = std::make_shared<Model>();
  std::vector<Vec3> vertices;
  for (const Vec3& v : mesh.vertices) vertices.push_back(kUnits * v);
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

/// The middle of the bounding box, and the farthest vertex from it.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
  explicit Ball(const TriangleMesh& mesh) {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
    center = (low + high) / 2;
    for (const Vec3& v : mesh.vertices) radius = std::max(radius, (v - center).norm());
  }
};

}  // namespace

struct TouchLine::State {
  struct Body {
    std::shared_ptr<Model> model;
    fcl::Transform3d pose;
    Vec3 center;  // of a ball around it, world
    double radius;
  };
  std::vector<Body> fixed;
  std::shared_ptr<Model> held;
  Vec3 held_center = Vec3::Zero();
  double held_radius = 0;
};

TouchLine::TouchLine(const Scene& scene) : state_(std::make_unique<State>()) {
  std::map<const TriangleMesh*, std::shared_ptr<Model>> models;
  for (const Part& part : scene.parts) {
    auto& model = models[part.mesh.get()];
    if (!model) model = model_of(*part.mesh);
    const Ball ball(*part.mesh);
    if (part.held) {
      state_->held = model;
      state_->held_center = ball.center;
      state_->held_radius = ball.radius;
    } else {
      state_->fixed.push_back({model, transform(part.pose), part.pose * ball.center, ball.radius});
    }
  }
}

TouchLine::~TouchLine() = default;

double TouchLine::distance(const Pose& X, double reach) const {
  const Vec3 center = X * state_->held_center;
  double least = reach;
  for (const State::Body& body : state_->fixed) {
    if ((body.center - center).norm() - body.radius - state_->held_radius >= least) continue;
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    result.min_distance = kUnits * least;  // FCL leaves out what is farther
    fcl::distance(state_->held.get(), transform(X), body.model.get(), body.pose, request, result);
    least = std::min(least, std::max(result.min_distance / kUnits, 0.0));
  }
  return least;
}

double TouchLine::travel(const Pose& from, const Vec3& direction, double most, double near) const {
  const auto at = [&](double s) -> Pose { return {from.q, from.p + s * direction}; };
  double s = 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double left = distance(at(s));
    if (left <= near) return s;
    const double beyond = kAskew * left;
    if (beyond <= kBisected * most && s + beyond < most && intersects(at(s + beyond)))
      return s + travel_bisected(at(s), direction, beyond, near);
    s += left;
    if (s >= most) return most;
  }
  throw Error("a line along a wall: FCL's distance takes too many steps on it");
}

bool TouchLine::intersects(const Pose& X) const {
  const Vec3 center = X * state_->held_center;
  for (const State::Body& body : state_->fixed) {
    if ((body.center - center).norm() > body.radius + state_->held_radius) continue;
    fcl::CollisionRequestd any;
    fcl::CollisionResultd hit;
    if (fcl::collide(state_->held.get(), transform(X), body.model.get(), body.pose, any, hit) > 0) return true;
  }
  return false;
}

double TouchLine::travel_bisected(const Pose& from, const Vec3& direction, double most, double near) const {
  const auto hits = [&](double s) { return intersects({from.q, from.p + s * direction}); };
  if (!hits(most)) return most;
  double free = 0, blocked = most;
  while (blocked - free > near) {
    const double middle = (free + blocked) / 2;
    (hits(middle) ? blocked : free) = middle;
  }
  return free;
}

}  // namespace tegotae::test
