#include "plan/ompl_motions.hpp"

#include <utility>

namespace tegotae {
namespace {

namespace ob = ompl::base;

class CertifiedMotions final : public ob::MotionValidator {
 public:
  CertifiedMotions(ob::SpaceInformation* si, std::shared_ptr<PoseSpace> space, MotionWorld& world, double clearance,
                   std::function<bool()> stopped)
      : ob::MotionValidator(si),
        space_(std::move(space)),
        world_(world),
        clearance_(clearance),
        stopped_(std::move(stopped)) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const bool free = !stopped_() && world_.free_share(space_->pose(from), space_->pose(to), clearance_) == 1;
    ++(free ? valid_ : invalid_);
    return free;
  }
  bool checkMotion(const ob::State* from, const ob::State* to, std::pair<ob::State*, double>& last) const override {
    last.second = stopped_() ? 0 : world_.free_share(space_->pose(from), space_->pose(to), clearance_);
    if (last.first != nullptr) si_->getStateSpace()->interpolate(from, to, last.second, last.first);
    ++(last.second == 1 ? valid_ : invalid_);
    return last.second == 1;
  }

 private:
  std::shared_ptr<PoseSpace> space_;
  MotionWorld& world_;
  double clearance_;
  std::function<bool()> stopped_;
};

}  // namespace

ob::SpaceInformationPtr space_information(const std::shared_ptr<PoseSpace>& space, MotionWorld& world, double clearance,
                                          std::function<bool()> stopped) {
  auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker([space, &world, clearance, stopped](const ob::State* state) {
    const Pose X = space->pose(state);
    return !stopped() && world.free_share(X, X, clearance) == 1;
  });
  si->setMotionValidator(std::make_shared<CertifiedMotions>(si.get(), space, world, clearance, std::move(stopped)));
  si->setup();
  return si;
}

}  // namespace tegotae
