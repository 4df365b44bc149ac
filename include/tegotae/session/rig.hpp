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

/// Source of a Rig's time.
enum class RigClock : std::uint8_t {
  real,  ///< the machine's clock; the servo has a thread of its own
  /// Each step() advances it: servo, contact loop and pen take turns in the caller's thread, and the same scene, pen
  /// and build give the same run, bit for bit.
  simulated
};

/// How a Rig runs.
struct RigSettings {
  RigClock clock = RigClock::real;  ///< source of its time
  double period = 1e-3;             ///< s between two steps, 1e-5 to 1: exactly, in simulated time; at least, in run()
  ServoSettings servo = {};         ///< servo of a device in this process
};

/// A scene, a pen, and everything between them: servo, shared memory, contact loop. The pen carries the held part, the
/// part stays out of the others, and the hand feels it through the pen.
///
/// Threads: make all calls in one thread, the contact loop's, except those that any thread may make. An application
/// with a loop of its own calls step() in it; run() is a loop for the others.
class Rig {
 public:
  /// Uses a device in this process. Keeps a reference to it, and calls it until stop(). With RigClock::simulated,
  /// ContactSettings::tick_budget has no effect: only the amount of work bounds a tick. Throws Error as HapticLoop
  /// does, and for a period or scale out of range (kind setting).
  Rig(const Scene& scene, Device& device, const RigSettings& settings = {});
  /// Uses the device of another process, "shm:NAME" (see Attachment). Throws Error (kind device) when there is none,
  /// and as HapticLoop does.
  Rig(const Scene& scene, const std::string& device);
  ~Rig();  ///< stops
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Starts the device and its servo. Has no effect on a rig that runs. Throws Error as Device::start and Servo do,
  /// also for a servo setting out of range.
  void start();
  /// Switches the force off, and stops servo and device. Has no effect when they do not run. Throws Error as
  /// Device::stop does.
  void stop();

  /// Runs one tick: reads the pen, moves the held part as near to it as the others allow, and publishes the result to
  /// the servo. Returns the report, valid until the next call. When there is no pen to read (another process's device
  /// is gone), the part stays where it is, and the report is that of the last tick. Never allocates or throws. Call it
  /// between start() and stop(); otherwise it only returns the last report.
  const TickReport& step() noexcept;
  /// Steps until `seconds` after start(), or until request_stop(). Calls `after_step(*this)` after each step. In real
  /// time it steps at most once a period, in the calling thread, which meanwhile has real-time priority where the
  /// system grants it.
  template <class AfterStep>
  void run(double seconds, AfterStep&& after_step) {
    const Pace pace(*this);
    while (wait_for_step(seconds)) {
      step();
      after_step(*this);
    }
  }
  /// Ends run() after its present step. Any thread and any signal handler may call it.
  void request_stop() noexcept;

  /// Continues in another scene (see HapticLoop::change). The part held now continues from where it is, whatever pose
  /// `next` gives it. Another held part starts at its pose in `next`, and the pen's present pose maps to that part. Any
  /// thread may call it. Throws Error when the loop cannot hold the scene; then nothing changes.
  SceneChange change(Scene next);

  /// Pulls the hand gently along `path` from the next step on. `path` has poses X_WF of the held part's file frame, as
  /// read_path() returns them. No poses end the pull, and so does another held part.
  ///
  /// The pull is along the path at its place nearest to the pen, and beside the path also back to it. It fades from 10
  /// mm off the path on, and ends at 20 mm (lengths of the hand). It is at most 1 N. Where WeightSettings::max_force is
  /// set, it is also at most that force less half of the weight. It comes on over 0.3 s, and an earlier pull goes off
  /// in the same time. It never moves the part into another one.
  ///
  /// Needs the resolver "qp" or a custom one; throws Error (kind setting) with another one. Allocates: call it between
  /// two steps, in their thread.
  void guide(const std::vector<Pose>& path);

  double time() const noexcept;           ///< time of the last step, s since start()
  std::uint64_t steps() const noexcept;   ///< number of steps since start()
  Pose part() const noexcept;             ///< X of the held part's file frame, to draw it; any thread may call it
  const PenSample& pen() const noexcept;  ///< the sample that the last step answered, with the newest rendered wrench
  bool connected() const noexcept;        ///< whether there was a pen in the last step
  const TickReport& report() const;       ///< report of the last step; before the first one, of the start
  const std::vector<ContactPoint>& contacts() const;        ///< as HapticLoop::contacts
  const std::vector<ContactEvent>& contact_events() const;  ///< as HapticLoop::contact_events
  const InitialContactReport& start_report() const;   ///< what the held part touched at the start, as HapticLoop::start
  const HapticLoop& loop() const noexcept;            ///< everything else that the contact loop reports
  ServoStatistics servo_statistics() const noexcept;  ///< statistics of the servo since start()
  /// Returns what the system did not grant to the servo or to run(), in one line; empty: it granted everything.
  std::string missing_realtime() const;
  std::string stability() const;  ///< StabilityReport::text() of a device in this process; empty for another process's

 private:
  struct State;
  /// While it lives, the calling thread has the contact loop's priority.
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
