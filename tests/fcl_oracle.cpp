#include "fcl_oracle.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

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

}  // namespace

struct FclOracle::State {
  struct Fixed {
    std::string name;
    std::shared_ptr<Model> model;
    fcl::Transform3d pose;
  };
  std::vector<Fixed> fixed;
  std::shared_ptr<Model> held;
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
    if (part.held) {
      state_->held = model;
    } else {
      state_->fixed.push_back({part.name, model, transform(part.pose)});
    }
  }
}

FclOracle::~FclOracle() = default;

std::vector<std::string> FclOracle::intersecting(const Pose& X_WF) const {
  std::vector<std::string> names;
  for (const auto& f : state_->fixed) {
    fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    if (fcl::collide(state_->held.get(), transform(X_WF), f.model.get(), f.pose, request, result) > 0)
      names.push_back(f.name);
  }
  return names;
}

}  // namespace tegotae::test
