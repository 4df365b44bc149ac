#pragma once

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>

#include <memory>

#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

using FclModel = fcl::BVHModel<fcl::OBBRSSd>;

inline std::shared_ptr<FclModel> fcl_model(const TriangleMesh& mesh) {
  auto model = std::make_shared<FclModel>();
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

inline fcl::Transform3d fcl_transform(const Pose& X) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.linear() = X.q.toRotationMatrix();
  transform.translation() = X.p;
  return transform;
}

}  // namespace tegotae
