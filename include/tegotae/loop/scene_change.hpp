#pragma once

#include <cstdint>
#include <memory>

#include "tegotae/core/export.hpp"
#include "tegotae/loop/initial_contacts.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What has become of a change of a running scene.
enum class ChangeState : std::uint8_t {
  pending,     ///< it waits for a tick, or for the held part to be out of its way
  in_force,    ///< the loop runs in it
  superseded,  ///< it was in force until a later change came into force
  replaced,    ///< a later change took its place while it was pending
  canceled     ///< it was taken back while it was pending
};

/// A change of a running scene (HapticLoop::change, Rig::change). Copies stand for the same change; all calls may be
/// made from any thread, and after the loop is gone.
class SceneChange {
 public:
  std::uint64_t number() const noexcept;  ///< from 1 on; that of a change that was canceled is given again
  ChangeState state() const noexcept;     ///< now
  /// Waits for at most `seconds` until it is no longer pending, and returns what it is then. Another thread must step
  /// the loop meanwhile.
  ChangeState wait(double seconds) const;
  /// Takes the change back, so that the scene stays as it is. False when it is no longer pending.
  bool cancel();
  const InitialContactReport& start() const noexcept;  ///< how the held part starts in the changed scene

  struct Record;
  explicit SceneChange(std::shared_ptr<Record> record);  ///< for HapticLoop

 private:
  std::shared_ptr<Record> record_;
};

}  // namespace tegotae
