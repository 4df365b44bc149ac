#include "narrowphase/fcl_pairs.hpp"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "narrowphase/fcl_model.hpp"

namespace tegotae {

namespace {

// FCL's distance of two triangles takes one whose normal (the product of two edges) is shorter than 3e-8 for a segment,
// whatever the unit, and then may call them touching: lengths are given to it in 0.1 mm.
constexpr double kPairUnit = 1e-4;

TriangleMesh in_units(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) v /= kPairUnit;
  return mesh;
}

fcl::Transform3d in_units(const Pose& X) {
  return fcl_transform({X.q, X.p / kPairUnit});
}

}  // namespace

struct FclPairs::Models {
  std::map<const TriangleMesh*, std::shared_ptr<FclModel>> of;

  const FclModel* operator[](const TriangleMesh& mesh) {
    auto& model = of[&mesh];
    if (!model) model = fcl_model(in_units(mesh));
    return model.get();
  }
};

FclPairs::FclPairs() : models_(std::make_unique<Models>()) {}
FclPairs::~FclPairs() = default;

std::vector<FclPairs::Faces> FclPairs::intersections(const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA,
                                                     std::size_t most) {
  fcl::CollisionRequestd request;
  request.num_max_contacts = most;
  fcl::CollisionResultd result;
  fcl::collide((*models_)[a], in_units(X_BA), (*models_)[b], fcl::Transform3d::Identity(), request, result);
  std::vector<Faces> pairs;
  pairs.reserve(result.numContacts());
  for (std::size_t i = 0; i < result.numContacts(); ++i) {
    const auto& contact = result.getContact(i);
    pairs.emplace_back(static_cast<std::uint32_t>(contact.b1), static_cast<std::uint32_t>(contact.b2));
  }
  return pairs;
}

bool FclPairs::intersect(const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA) {
  const fcl::CollisionRequestd request(1, false);  // no points, normals or depths
  fcl::CollisionResultd result;
  fcl::collide((*models_)[a], in_units(X_BA), (*models_)[b], fcl::Transform3d::Identity(), request, result);
  return result.isCollision();
}

double FclPairs::distance_below(double bound, const TriangleMesh& a, const TriangleMesh& b, const Pose& X_BA,
                                Faces& nearest) {
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  result.min_distance = bound / kPairUnit;  // the traversal leaves out whatever is farther than the best so far
  fcl::distance((*models_)[a], in_units(X_BA), (*models_)[b], fcl::Transform3d::Identity(), request, result);
  if (!(result.min_distance < bound / kPairUnit)) return bound;
  nearest = {static_cast<std::uint32_t>(result.b1), static_cast<std::uint32_t>(result.b2)};
  return kPairUnit * result.min_distance;
}

}  // namespace tegotae
