#pragma once

#include <cstdint>
#include <memory>

#include "tegotae/core/export.hpp"
#include "tegotae/loop/initial_contacts.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// State of a change of a running scene.
enum class ChangeState : std::uint8_t {
  pending,     ///< it waits for a tick, or until the held part is out of its way
  in_force,    ///< the loop runs in it
  superseded,  ///< it was in force until a later change came into force
  replaced,    ///< a later change replaced it while it was pending
  canceled     ///< it was canceled while it was pending
};

/// Handle of a change of a running scene (HapticLoop::change, Rig::change). Copies refer to the same change. Any thread
/// may make any call, also after the loop is gone.
class SceneChange {
 public:
  /// Returns the number of the change, from 1 on. The number of a canceled change is used again.
  std::uint64_t number() const noexcept;
  ChangeState state() const noexcept;  ///< returns its present state
  /// Waits for at most `seconds` until the change is no longer pending, and returns its state. Another thread must step
  /// the loop meanwhile.
  ChangeState wait(double seconds) const;
  /// Cancels the change. Returns false, and does nothing, when the change is no longer pending or the loop is gone.
  /// Waits while another change is being built.
  bool cancel();
  const InitialContactReport& start() const noexcept;  ///< how the held part starts in the changed scene

  struct Record;
  explicit SceneChange(std::shared_ptr<Record> record);  ///< for HapticLoop

 private:
  std::shared_ptr<Record> record_;
};

}  // namespace tegotae
