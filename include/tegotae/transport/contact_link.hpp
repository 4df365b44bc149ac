#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/transport/channel.hpp"
#include "tegotae/transport/mapping.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// The servo's newest sample of the pen.
struct PenSample {
  DeviceState state;                                  ///< mapped: `pose` is Y, where the pen wants the held part
  Pose raw;                                           ///< pose of the pen in the device's own space
  Wrench wrench;                                      ///< on the pen, as rendered, at the held part's center of mass
  DeviceStatus status = DeviceStatus::uninitialized;  ///< `enabled` only when the wrench was rendered
  ForceOff reason = ForceOff::software;               ///< why the wrench was not rendered
  std::uint32_t flags = 0;                            ///< TEGOTAE_SHM_FLAG_...: what the safety chain did to the wrench
  double scale = 1;                                   ///< meters of the world for a meter of the pen
  Clutch clutch = Clutch::none;                       ///< by the application or by a button
  double thermal_load = 0;                            ///< running RMS of the force divided by the continuous force
  double energy = 0;                                  ///< J, of the passivity observer; below zero: generated
  std::int64_t heartbeat_ns = 0;                      ///< time of the servo's tick, ns
  std::uint64_t tick = 0;                             ///< number of the servo's tick
  std::int64_t attachment = 0;                        ///< attachment of the application that the servo serves
  std::uint32_t home_counter = 0;                     ///< number of the last home command that the servo executed
};

/// The contact loop's end of a channel: reads the pen, publishes the proxy.
class ContactLink {
 public:
  /// `coupling` is that of the contact loop (HapticLoop::coupling), `center` the held part's center of mass (m, file
  /// frame). Keeps a reference to `channel`, which must outlive the object.
  ContactLink(Channel& channel, const CouplingSettings& coupling, const Vec3& center);

  /// Reads the newest sample of the pen. Returns false, and leaves `pen` unchanged, before the servo's first tick.
  bool read(PenSample& pen) const noexcept;
  /// Publishes to the servo the proxy that answers the pen's sample `device_sequence`, and the commands below. `now_ns`
  /// is the heartbeat on the servo's clock: monotonic_ns(), or the caller's virtual time. The call drops planes that
  /// were taken at another pose than `proxy.X`.
  void publish(const ProxyState& proxy, std::uint64_t tick, std::uint64_t device_sequence, std::int64_t now_ns,
               const ContactPlanes& planes = {}) noexcept;

  // Commands, which the next publish() sends. None makes the force jump: it fades out, waits until the wanted force is
  // small, and ramps in again.
  void ask_for_force(bool on) noexcept { enable_ = on; }  ///< asks for force, or no longer; on by default
  /// Sets the meters of the world for a meter of the pen. Throws Error (kind setting) outside of kMinScale to
  /// kMaxScale.
  void set_scale(double scale);
  /// Sets which part of the pen's motion the held part does not follow from now on.
  void set_clutch(Clutch clutch) noexcept { clutch_ = clutch; }
  /// Re-references the pen: its present pose maps to the held part at `X` (X_WF of the file frame).
  void home(const Pose& X) noexcept;
  /// Grasps another part. `center` is its center of mass (m, file frame), `coupling` its coupling, and the pen's
  /// present pose maps to the part at `X` (X_WF).
  void grasp(const Vec3& center, const CouplingSettings& coupling, const Pose& X) noexcept;
  /// Returns whether the servo served this application, and had executed its home commands, when it published `pen`.
  bool obeyed(const PenSample& pen) const noexcept;

 private:
  Channel& channel_;
  CouplingSettings coupling_;
  Vec3 center_;
  std::int64_t attachment_;  // when this application attached
  bool enable_ = true;
  double scale_ = 1;
  Clutch clutch_ = Clutch::none;
  std::uint32_t home_counter_ = 0;
  Pose home_;
};

}  // namespace tegotae
