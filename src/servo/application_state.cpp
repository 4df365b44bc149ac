#include "servo/application_state.hpp"

#include <cmath>

#include "core/valid_pose.hpp"
#include "transport/shm_convert.hpp"

namespace tegotae {

namespace {

bool placed(const double (&position)[3], const double (&orientation)[4]) {
  return is_valid({quaternion(orientation), vector(position)});
}

bool constant(double x) {
  return std::isfinite(x) && x >= 0;
}

}  // namespace

bool valid(const tegotae_shm_application& in) noexcept {
  return placed(in.position, in.orientation) && vector(in.velocity).allFinite() &&
         vector(in.angular_velocity).allFinite() && within_reach(vector(in.center)) &&
         vector(in.load_force).allFinite() && vector(in.load_torque).allFinite() && constant(in.stiffness) &&
         constant(in.damping) && constant(in.torsional_stiffness) && constant(in.torsional_damping) &&
         in.scale >= kMinScale && in.scale <= kMaxScale && in.clutch <= TEGOTAE_SHM_CLUTCH_ALL &&
         (in.home_counter == 0 || placed(in.home_position, in.home_orientation));
}

CouplingSettings coupling_of(const tegotae_shm_application& in) noexcept {
  return {in.stiffness, in.damping, in.torsional_stiffness, in.torsional_damping};
}

MappingCommand mapping_of(const tegotae_shm_application& in) noexcept {
  return {in.scale,        static_cast<Clutch>(in.clutch),
          in.home_counter, {quaternion(in.home_orientation), vector(in.home_position)},
          in.attachment,   vector(in.center)};
}

ProxyState proxy_of(const tegotae_shm_application& in) noexcept {
  return {{quaternion(in.orientation), vector(in.position)},
          {vector(in.velocity), vector(in.angular_velocity)},
          in.touching != 0,
          {vector(in.load_force), vector(in.load_torque)}};
}

ContactPlanes planes_of(const tegotae_shm_application& in) noexcept {
  ContactPlanes out;
  if (in.plane_count > ContactPlanes::kMax || !placed(in.pen_position, in.pen_orientation)) return out;
  out.count = static_cast<int>(in.plane_count);
  for (std::size_t i = 0; i < in.plane_count; ++i)
    out.planes[i] = {vector(in.planes[i].normal), vector(in.planes[i].point), in.planes[i].clearance, in.planes[i].mu};
  out.X = {quaternion(in.orientation), vector(in.position)};
  out.pen = {quaternion(in.pen_orientation), vector(in.pen_position)};
  return out;
}

}  // namespace tegotae
