#include "tegotae/servo/contact_link.hpp"

#include "servo/shm_convert.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {

ContactLink::ContactLink(Channel& channel, const CouplingSettings& coupling, const Vec3& center)
    : channel_(channel), coupling_(coupling), center_(center), session_(monotonic_ns()) {}

bool ContactLink::read(PenSample& pen) const noexcept {
  tegotae_shm_device in;
  if (!channel_.read(in)) return false;
  pen.state.pose = {quaternion(in.orientation), vector(in.position)};
  pen.state.velocity = {vector(in.velocity), vector(in.angular_velocity)};
  pen.state.buttons = in.buttons;
  pen.state.time_ns = in.time_ns;
  pen.state.sequence = in.sequence;
  pen.wrench = {vector(in.force), vector(in.torque)};
  pen.status = static_cast<DeviceStatus>(in.status);
  pen.reason = static_cast<ForceOff>(in.reason);
  pen.heartbeat_ns = in.heartbeat_ns;
  pen.tick = in.tick;
  return true;
}

void ContactLink::publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence,
                          std::int64_t now_ns) noexcept {
  tegotae_shm_application out{};
  out.heartbeat_ns = now_ns;
  out.tick = tick;
  out.device_sequence = device_sequence;
  out.session = session_;
  out.enable = 1;
  out.scale = 1;
  out.touching = proxy.touching ? 1 : 0;
  store(proxy.X.p, out.position);
  store(proxy.X.q, out.orientation);
  store(proxy.velocity.v, out.velocity);
  store(proxy.velocity.w, out.angular_velocity);
  store(center_, out.center);
  out.stiffness = coupling_.stiffness;
  out.damping = coupling_.damping;
  out.torsional_stiffness = coupling_.torsional_stiffness;
  out.torsional_damping = coupling_.torsional_damping;
  channel_.write(out);
}

}  // namespace tegotae
