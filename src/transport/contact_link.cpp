#include "tegotae/transport/contact_link.hpp"

#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"
#include "transport/shm_convert.hpp"

namespace tegotae {

namespace {

void store_planes(const ContactPlanes& planes, tegotae_shm_application& out) {
  store(planes.pen.p, out.pen_position);
  store(planes.pen.q, out.pen_orientation);
  out.plane_count = static_cast<std::uint32_t>(planes.count);
  for (int i = 0; i < planes.count; ++i) {
    const ContactPlane& plane = planes.planes[static_cast<std::size_t>(i)];
    store(plane.normal, out.planes[i].normal);
    store(plane.point, out.planes[i].point);
    out.planes[i].clearance = plane.clearance;
    out.planes[i].mu = plane.mu;
  }
}

}  // namespace

ContactLink::ContactLink(Channel& channel, const CouplingSettings& coupling, const Vec3& center)
    : channel_(channel), coupling_(coupling), center_(center), attachment_(monotonic_ns()) {}

bool ContactLink::read(PenSample& pen) const noexcept {
  tegotae_shm_device in;
  if (!channel_.read(in)) return false;
  pen.state.pose = {quaternion(in.orientation), vector(in.position)};
  pen.state.velocity = {vector(in.velocity), vector(in.angular_velocity)};
  pen.state.buttons = in.buttons;
  pen.state.time_ns = in.time_ns;
  pen.state.sequence = in.sequence;
  pen.raw = {quaternion(in.raw_orientation), vector(in.raw_position)};
  pen.wrench = {vector(in.force), vector(in.torque)};
  pen.status = static_cast<DeviceStatus>(in.status);
  pen.reason = static_cast<ForceOff>(in.reason);
  pen.flags = in.flags;
  pen.scale = in.scale;
  pen.clutch = static_cast<Clutch>(in.clutch);
  pen.thermal_load = in.thermal_load;
  pen.energy = in.energy;
  pen.heartbeat_ns = in.heartbeat_ns;
  pen.tick = in.tick;
  pen.attachment = in.attachment;
  pen.home_counter = in.home_counter;
  return true;
}

void ContactLink::set_scale(double scale) {
  if (!(scale >= kMinScale && scale <= kMaxScale))
    throw Error(ErrorKind::setting, "pen: the scale must be from 0.01 to 100", {{}, 0, "pen.scale", {}});
  scale_ = scale;
}

bool ContactLink::obeyed(const PenSample& pen) const noexcept {
  return pen.attachment == attachment_ && pen.home_counter == home_counter_;
}

void ContactLink::home(const Pose& X) noexcept {
  home_ = X;
  // 0 stands for none.
  if (++home_counter_ == 0) ++home_counter_;
}

void ContactLink::grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept {
  center_ = center;
  coupling_ = coupling;
  home(X);
}

void ContactLink::publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence,
                          std::int64_t now_ns, const ContactPlanes& planes) noexcept {
  tegotae_shm_application out{};
  out.heartbeat_ns = now_ns;
  out.tick = tick;
  out.device_sequence = device_sequence;
  out.attachment = attachment_;
  out.touching = proxy.touching ? 1 : 0;
  out.enable = enable_ ? 1 : 0;
  out.clutch = static_cast<std::uint32_t>(clutch_);
  out.home_counter = home_counter_;
  store(proxy.X.p, out.position);
  store(proxy.X.q, out.orientation);
  store(proxy.velocity.v, out.velocity);
  store(proxy.velocity.w, out.angular_velocity);
  store(proxy.load.force, out.load_force);
  store(proxy.load.torque, out.load_torque);
  store(center_, out.center);
  out.stiffness = coupling_.stiffness;
  out.damping = coupling_.damping;
  out.torsional_stiffness = coupling_.torsional_stiffness;
  out.torsional_damping = coupling_.torsional_damping;
  out.scale = scale_;
  store(home_.p, out.home_position);
  store(home_.q, out.home_orientation);
  // The slot has room for one pose.
  if (planes.taken_at(proxy.X)) store_planes(planes, out);
  channel_.write(out);
}

}  // namespace tegotae
