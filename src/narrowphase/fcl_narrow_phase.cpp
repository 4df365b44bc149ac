#include "narrowphase/fcl_narrow_phase.hpp"

#include <ccd/ccd.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <map>

namespace tegotae {

static_assert(sizeof(ccd_real_t) == 8, "libccd must be built in double precision");

namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> build(const TriangleMesh& mesh) {
  auto model = std::make_shared<Model>();
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

struct FclNarrowPhase::State {
  std::shared_ptr<Model> held;
  std::vector<std::shared_ptr<Model>> fixed;
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;  // reused: its vector stops allocating once warm

  static fcl::Transform3d transform_of(const Pose& X) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    transform.linear() = X.q.toRotationMatrix();
    transform.translation() = X.p;
    return transform;
  }

  int collide(std::uint32_t part, const Pose& X_BA, int most) {
    request.num_max_contacts = static_cast<std::size_t>(most);
    request.enable_contact = false;
    result.clear();
    return static_cast<int>(
        fcl::collide(held.get(), transform_of(X_BA), fixed[part].get(), fcl::Transform3d::Identity(), request, result));
  }
};

FclNarrowPhase::FclNarrowPhase(const TriangleMesh& held, const std::vector<const TriangleMesh*>& fixed)
    : state_(std::make_unique<State>()) {
  state_->held = build(held);
  std::map<const TriangleMesh*, std::shared_ptr<Model>> built;
  for (const TriangleMesh* mesh : fixed) {
    auto& model = built[mesh];
    if (!model) model = build(*mesh);
    state_->fixed.push_back(model);
  }
}

FclNarrowPhase::~FclNarrowPhase() = default;

int FclNarrowPhase::intersections(std::uint32_t part, const Pose& X_BA, int most, std::vector<FacePair>& pairs) {
  if (state_->collide(part, X_BA, most) == 0) return 0;
  const int n = std::min(most, static_cast<int>(state_->result.numContacts()));
  for (int i = 0; i < n; ++i) {
    const auto& c = state_->result.getContact(static_cast<std::size_t>(i));
    pairs.push_back({part, static_cast<std::uint32_t>(c.b1), static_cast<std::uint32_t>(c.b2)});
  }
  return n;
}

double FclNarrowPhase::distance_below(double bound, std::uint32_t part, const Pose& X_BA, FacePair& nearest) {
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  result.min_distance = bound;  // the traversal leaves out whatever is farther than the best so far
  fcl::distance(state_->held.get(), State::transform_of(X_BA), state_->fixed[part].get(), fcl::Transform3d::Identity(),
                request, result);
  if (!(result.min_distance < bound)) return bound;
  nearest = {part, static_cast<std::uint32_t>(result.b1), static_cast<std::uint32_t>(result.b2)};
  return result.min_distance;
}

bool FclNarrowPhase::intersects(std::uint32_t part, const Pose& X_BA) {
  return state_->collide(part, X_BA, 1) > 0;
}

}  // namespace tegotae
