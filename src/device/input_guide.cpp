#include "tegotae/device/input_guide.hpp"

#include "tegotae/device/shm.h"

namespace tegotae {

void InputGuide::lead(const Pose& hand) noexcept {
  const double values[kWords] = {hand.p.x(), hand.p.y(), hand.p.z(), hand.q.w(), hand.q.x(), hand.q.y(), hand.q.z()};
  tegotae_shm_write(&counter_, slot_, values, sizeof values);
}

bool InputGuide::target(Pose& hand) const noexcept {
  double v[kWords];
  if (!tegotae_shm_read(&counter_, slot_, v, sizeof v)) return false;
  hand = {Quat(v[3], v[4], v[5], v[6]), Vec3(v[0], v[1], v[2])};
  return true;
}

}  // namespace tegotae
