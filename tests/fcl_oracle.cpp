#include "fcl_oracle.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <map>

namespace tegotae::test {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

fcl::Transform3d transform(const Pose& X) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = X.q.toRotationMatrix();
  t.translation() = X.p;
  return t;
}

/// Around the middle of the bounding box.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

Ball ball_around(const TriangleMesh& mesh) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  Ball ball{(low + high) / 2, 0};
  for (const Vec3& v : mesh.vertices) ball.radius = std::max(ball.radius, (v - ball.center).norm());
  return ball;
}

bool collide(const Model& a, const fcl::Transform3d& X_a, const Model& b, const fcl::Transform3d& X_b) {
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(&a, X_a, &b, X_b, request, result) > 0;
}

}  // namespace

struct FclOracle::State {
  struct Fixed {
    std::string name;
    std::shared_ptr<Model> model;
    fcl::Transform3d pose;
    Ball ball;  // in the world
  };
  std::vector<Fixed> fixed;
  std::shared_ptr<Model> held;
  Ball held_ball;  // in the file frame
};

FclOracle::FclOracle(const Scene& scene) : state_(std::make_unique<State>()) {
  std::map<const TriangleMesh*, std::shared_ptr<Model>> models;
  for (const Part& part : scene.parts) {
    auto& model = models[part.mesh.get()];
    if (!model) {
      model = std::make_shared<Model>();
      std::vector<fcl::Triangle> triangles;
      for (const auto& t : part.mesh->triangles) triangles.emplace_back(t[0], t[1], t[2]);
      model->beginModel();
      model->addSubModel(part.mesh->vertices, triangles);
      model->endModel();
    }
    Ball ball = ball_around(*part.mesh);
    if (part.held) {
      state_->held = model;
      state_->held_ball = ball;
    } else {
      ball.center = part.pose * ball.center;
      state_->fixed.push_back({part.name, model, transform(part.pose), ball});
    }
  }
}

FclOracle::~FclOracle() = default;

std::vector<std::string> FclOracle::intersecting(const Pose& X_WF) const {
  std::vector<std::string> names;
  for (const auto& f : state_->fixed)
    if (collide(*state_->held, transform(X_WF), *f.model, f.pose)) names.push_back(f.name);
  return names;
}

double FclOracle::distance(const Pose& X_WF, double reach) const {
  const Vec3 center = X_WF * state_->held_ball.center;
  double least = reach;
  for (const auto& f : state_->fixed) {
    if ((f.ball.center - center).norm() - f.ball.radius - state_->held_ball.radius >= least) continue;
    // FCL's distance is not to be asked about triangles that intersect.
    if (collide(*state_->held, transform(X_WF), *f.model, f.pose)) return 0;
    fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    result.min_distance = least;  // FCL leaves out what is farther
    fcl::distance(state_->held.get(), transform(X_WF), f.model.get(), f.pose, request, result);
    least = std::min(least, std::max(result.min_distance, 0.0));
  }
  return least;
}

}  // namespace tegotae::test
