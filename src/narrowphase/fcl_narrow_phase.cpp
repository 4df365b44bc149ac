#include "narrowphase/fcl_narrow_phase.hpp"

#include <ccd/ccd.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <map>

#include "narrowphase/fcl_model.hpp"

namespace tegotae {

static_assert(sizeof(ccd_real_t) == 8, "libccd must be built in double precision");

struct FclNarrowPhase::State {
  std::shared_ptr<FclModel> held;
  std::vector<std::shared_ptr<FclModel>> fixed;
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;  // reused: its vector stops allocating once warm

  int collide(std::uint32_t part, const Pose& X_BA, int most) {
    request.num_max_contacts = static_cast<std::size_t>(most);
    request.enable_contact = false;
    result.clear();
    return static_cast<int>(fcl::collide(held.get(), fcl_transform(X_BA), fixed[part].get(),
                                         fcl::Transform3d::Identity(), request, result));
  }
};

FclNarrowPhase::FclNarrowPhase(const TriangleMesh& held, const std::vector<const TriangleMesh*>& fixed)
    : state_(std::make_unique<State>()) {
  state_->held = fcl_model(held);
  std::map<const TriangleMesh*, std::shared_ptr<FclModel>> built;
  for (const TriangleMesh* mesh : fixed) {
    auto& model = built[mesh];
    if (!model) model = fcl_model(*mesh);
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
  fcl::distance(state_->held.get(), fcl_transform(X_BA), state_->fixed[part].get(), fcl::Transform3d::Identity(),
                request, result);
  if (!(result.min_distance < bound)) return bound;
  nearest = {part, static_cast<std::uint32_t>(result.b1), static_cast<std::uint32_t>(result.b2)};
  return result.min_distance;
}

bool FclNarrowPhase::intersects(std::uint32_t part, const Pose& X_BA) {
  return state_->collide(part, X_BA, 1) > 0;
}

}  // namespace tegotae
