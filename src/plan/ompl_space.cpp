#include "plan/ompl_space.hpp"

#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

namespace tegotae {

namespace ob = ompl::base;

PoseSpace::PoseSpace(const Vec3& center, double gyration, const WorldBox& room) : center_(center) {
  ob::RealVectorBounds bounds(3);
  for (unsigned i = 0; i < 3; ++i) {
    bounds.setLow(i, room.low[i]);
    bounds.setHigh(i, room.high[i]);
  }
  setBounds(bounds);
  setSubspaceWeight(1, 2 * gyration);  // OMPL's distance of two rotations is half their angle
}

Pose PoseSpace::pose(const ob::State* state) const {
  const auto* s = state->as<StateType>();
  Pose X;
  X.q = Quat(s->rotation().w, s->rotation().x, s->rotation().y, s->rotation().z).normalized();
  X.p = Vec3(s->getX(), s->getY(), s->getZ()) - X.q * center_;
  return X;
}

void PoseSpace::set(ob::State* state, const Pose& X) const {
  auto* s = state->as<StateType>();
  const Vec3 c = X * center_;
  s->setXYZ(c.x(), c.y(), c.z());
  s->rotation().w = X.q.w();
  s->rotation().x = X.q.x();
  s->rotation().y = X.q.y();
  s->rotation().z = X.q.z();
}

void seed_ompl(std::uint64_t seed) {
  // It says that a second seed in a process comes too late; whatever draws after it does repeat.
  ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed % 0xfffffffbu + 1));
}

std::vector<Pose> poses(const PoseSpace& space, ompl::geometric::PathGeometric& path) {
  std::vector<Pose> out;
  for (const ob::State* state : path.getStates()) out.push_back(space.pose(state));
  return out;
}

}  // namespace tegotae
