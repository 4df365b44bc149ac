#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tegotae/contact/contact_point.hpp"
#include "tegotae/core/export.hpp"
#include "tegotae/device/device.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/loop/scene.hpp"
#include "tegotae/loop/scene_change.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// What moves a Rig's time on.
enum class RigClock : std::uint8_t {
  real,      ///< the machine's clock; the servo has a thread of its own
  simulated  ///< step() alone: servo, contact loop and pen take turns in the caller's thread, and the same scene, pen
             ///< and build do the same, bit for bit
};

/// How a Rig runs.
struct RigSettings {
  RigClock clock = RigClock::real;  ///< what moves its time on
  double period = 1e-3;             ///< s between two steps: of simulated time, and at least that in run()
  ServoSettings servo = {};         ///< of a device in this process
};

/// A scene, a pen, and everything between them: servo, shared memory, contact loop. The pen carries the held part, the
/// part stays out of the others, and the pen feels it.
///
/// Threads: all calls from one thread, the contact loop's, but for those that say otherwise. Where an application has a
/// loop of its own, it calls step() in it; run() is a loop for those that have none.
class Rig {
 public:
  /// A device in this process. Keeps a reference to it, and calls it until stop(). With RigClock::simulated,
  /// ContactSettings::tick_budget has no effect: work alone bounds a tick. Throws Error as HapticLoop and Servo do.
  Rig(const Scene& scene, Device& device, const RigSettings& settings = {});
  /// The device of another process, "shm:NAME" (see Attachment). Throws Error when there is none, and as HapticLoop
  /// does.
  Rig(const Scene& scene, const std::string& device);
  ~Rig();  ///< stops
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Starts the device and its servo. Throws Error with the cause.
  void start();
  /// Force off, servo and device stop. No effect when they do not run. Throws Error as Device::stop.
  void stop();

  /// One tick: reads the pen, moves the held part as near to it as the others allow, and tells the servo. Returns what
  /// it did, valid until the next call. Without a pen to read (another process's that is gone) the part stays where it
  /// is, and the report is that of the last tick. Never allocates or throws; between start() and stop().
  const TickReport& step() noexcept;
  /// Steps until `seconds` after start(), or until request_stop(); after each step calls `after_step(*this)`. In real
  /// time at most once a period, in the calling thread, which has real-time priority meanwhile where the system grants
  /// it.
  template <class AfterStep>
  void run(double seconds, AfterStep&& after_step) {
    const Pace pace(*this);
    while (wait_for_step(seconds)) {
      step();
      after_step(*this);
    }
  }
  /// Ends run() after the step that it is in. From any thread, and from a signal handler.
  void request_stop() noexcept;

  /// Continues in another scene (see HapticLoop::change): the part that is held now goes on from where it is, whatever
  /// pose `next` gives it. Another held part starts where `next` has it, and the pen, where it is, comes to mean that
  /// part. From any thread. Throws Error when the scene cannot be held; nothing changes then.
  SceneChange change(Scene next);

  double time() const noexcept;           ///< s since start(), as of the last step
  std::uint64_t steps() const noexcept;   ///< made since start()
  Pose part() const noexcept;             ///< X of the held part's file frame; from any thread, to draw it
  const PenSample& pen() const noexcept;  ///< the sample that the last step answered, with the wrench rendered lately
  bool connected() const noexcept;        ///< the pen was there in the last step
  const TickReport& report() const;       ///< of the last step; before the first one, of the start
  const std::vector<ContactPoint>& contacts() const;        ///< as HapticLoop::contacts
  const std::vector<ContactEvent>& contact_events() const;  ///< as HapticLoop::contact_events
  const InitialContactReport& start_report() const;   ///< what the held part touched at the start, as HapticLoop::start
  const HapticLoop& loop() const noexcept;            ///< what else the contact loop knows
  ServoStatistics servo_statistics() const noexcept;  ///< of the servo, since start()
  std::string missing_realtime() const;  ///< what the system did not grant to the servo or to run(); empty: nothing
  std::string stability() const;         ///< StabilityReport::text() of a device in this process, for people

 private:
  struct State;
  /// While it lives the calling thread has the contact loop's priority.
  class Pace {
   public:
    explicit Pace(Rig& rig);
    ~Pace();
    Pace(const Pace&) = delete;
    Pace& operator=(const Pace&) = delete;

   private:
    Rig& rig_;
  };
  bool wait_for_step(double seconds) noexcept;

  std::unique_ptr<State> state_;
};

}  // namespace tegotae
