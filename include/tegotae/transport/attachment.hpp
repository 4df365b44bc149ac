#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/transport/channel.hpp"
#include "tegotae/transport/contact_link.hpp"
#include "tegotae/transport/servo_statistics.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// An application's hold on a device in another process (tegotae-device, or a driver of one's own). It outlives the
/// device: while there is none, read() says so, the application keeps the part where it is, and the next device of that
/// name is attached to. Used from one thread, the contact loop's.
///
/// When it attaches, the pen, wherever it is, comes to mean the held part where that is: nothing jumps.
class Attachment {
 public:
  /// `device` is "shm:NAME", the name of the segment; the others as ContactLink has them. Throws Error when there is no
  /// such device, or another application has it, and when `scale` is out of range (see ContactLink::set_scale).
  Attachment(const std::string& device, const CouplingSettings& coupling, const Vec3& center, double scale = 1);

  /// The newest sample of the pen. False, and `pen` untouched, when there is none to follow: the device's heartbeat is
  /// older than 20 ms or its process gone (then it is looked for ten times a second, the only time that a call may take
  /// longer or allocate), or it has not yet taken in where the part is.
  bool read(PenSample& pen, std::int64_t now_ns) noexcept;
  /// As ContactLink::publish; call it once a tick, whatever read() said, for the heartbeat.
  void publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence, std::int64_t now_ns,
               const ContactPlanes& planes = {}) noexcept;

  /// As ContactLink::hold, for this device and those that come after it.
  void hold(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept;

  /// The device's heartbeat was fresh at the last read().
  bool connected() const noexcept { return connected_; }
  /// How often the device was lost.
  std::uint64_t losses() const noexcept { return losses_; }
  /// What the device's servo last told of itself; zeros before it has.
  ServoStatistics statistics() const noexcept;

 private:
  void attach();
  void look_for_successor(std::int64_t now_ns) noexcept;

  std::string name_;
  CouplingSettings coupling_;
  Vec3 center_;
  double scale_;
  std::optional<Channel> channel_;
  std::optional<ContactLink> link_;  // of channel_
  bool homed_ = false;               // the home command has been given to this device
  bool connected_ = true;
  std::uint64_t losses_ = 0;
  std::int64_t looked_ns_ = 0;
};

}  // namespace tegotae
