#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/transport/channel.hpp"
#include "tegotae/transport/contact_link.hpp"
#include "tegotae/transport/servo_statistics.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Attachment of an application to a device in another process (tegotae-device, or a custom driver). It outlives the
/// device. While there is no device, read() returns false and the application keeps the part where it is. Then the
/// object attaches to the next device of that name. Use it in one thread, the contact loop's.
///
/// When it attaches, the pen's present pose maps to the held part's present pose, so that nothing jumps.
class Attachment {
 public:
  /// `device` is "shm:NAME" with the name of the segment; the other parameters are those of ContactLink. Throws Error
  /// (kind device) when there is no such device or another application is attached to it, and Error (kind setting) when
  /// `scale` is out of range (see ContactLink::set_scale).
  Attachment(const std::string& device, const CouplingSettings& coupling, const Vec3& center, double scale = 1);

  /// Reads the newest sample of the pen. Returns false, and leaves `pen` unchanged, when there is none to follow: the
  /// device's heartbeat is older than 20 ms at `now_ns` (monotonic clock), its process is gone, or it has not yet
  /// adopted the part's pose. While the device is lost, the call searches for it ten times a second; only then may it
  /// take longer or allocate.
  bool read(PenSample& pen, std::int64_t now_ns) noexcept;
  /// Publishes as ContactLink::publish does. Call it once a tick, whatever read() returned, because it is the
  /// heartbeat.
  void publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence, std::int64_t now_ns,
               const ContactPlanes& planes = {}) noexcept;

  /// Does what ContactLink::grasp does, for this device and its successors.
  void grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept;

  /// Returns whether the device's heartbeat was fresh at the last read().
  bool connected() const noexcept { return connected_; }
  /// Returns how often the device was lost.
  std::uint64_t losses() const noexcept { return losses_; }
  /// Returns the newest statistics of the device's servo; zeros before the first.
  ServoStatistics statistics() const noexcept;

 private:
  void attach();
  void poll_successor(std::int64_t now_ns) noexcept;

  std::string name_;
  CouplingSettings coupling_;
  Vec3 center_;
  double scale_;
  std::optional<Channel> channel_;
  std::optional<ContactLink> link_;  // of channel_
  bool homed_ = false;               // the home command has been given to this device
  bool connected_ = true;
  std::uint64_t losses_ = 0;
  std::int64_t polled_ns_ = 0;
};

}  // namespace tegotae
