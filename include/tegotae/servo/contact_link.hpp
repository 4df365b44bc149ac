#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/device/channel.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What the servo last told of the pen.
struct PenSample {
  DeviceState state;
  Wrench wrench;                                      ///< on the pen, as rendered, at the held part's center of mass
  DeviceStatus status = DeviceStatus::uninitialized;  ///< `enabled` only when the wrench was rendered
  ForceOff reason = ForceOff::software;               ///< why it was not
  std::int64_t heartbeat_ns = 0;                      ///< time of the servo's tick
  std::uint64_t tick = 0;                             ///< number of the servo's tick
};

/// The contact loop's end of a channel: pen in, proxy out.
class ContactLink {
 public:
  /// `center` is the held part's center of mass in its file frame, m. Keeps a reference to `channel`.
  ContactLink(Channel& channel, const CouplingSettings& coupling, const Vec3& center);

  /// The newest sample of the pen; false and `pen` untouched before the servo's first tick.
  bool read(PenSample& pen) const noexcept;
  /// Tells the servo the proxy that answers the pen's sample `device_sequence`. `now_ns` is the heartbeat: of the
  /// servo's clock, that is monotonic_ns() or the caller's virtual time.
  void publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence,
               std::int64_t now_ns) noexcept;

 private:
  Channel& channel_;
  CouplingSettings coupling_;
  Vec3 center_;
};

}  // namespace tegotae
