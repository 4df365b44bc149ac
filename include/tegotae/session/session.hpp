#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/device/input_guide.hpp"
#include "tegotae/device/input_source.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/contact_link.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Progress of a run, for another thread to read. Each value is the newest one; together they are not a snapshot.
struct RunProgress {
  std::atomic<double> t{0};                            ///< s since the start
  std::atomic<double> duration{0};                     ///< s that the run will take; infinite: until it is stopped
  std::atomic<double> depth{0};                        ///< m, as RunSummary::depth_m
  std::atomic<int> contacts{0};                        ///< TickReport::contacts of the newest tick
  std::atomic<double> force{0};                        ///< N, magnitude of the newest rendered force
  std::atomic<LagReason> lag_reason{LagReason::none};  ///< of the newest tick; none while the lag is under its bound
  std::atomic<bool> device{true};                      ///< the device is connected
  std::atomic<bool> held{false};  ///< a fit without clearance holds the part where it started (HeldFast)
  /// After the last tick: the checked share (0 to 1) of the poses that remained then (RunSummary::checked). Before:
  /// below 0.
  std::atomic<double> checked{-1};
};

/// One tick of the contact loop, for a RunObserver.
struct TickView {
  std::uint64_t tick;      ///< number of the contact loop's tick, from 0
  double t;                ///< s since the start
  const PenSample& pen;    ///< the sample that the tick answered
  const HapticLoop& loop;  ///< its report() and constraints() are of this tick
  std::uint64_t segment;   ///< number of the run's segment between two changes of its scene (RunEdits), from 0
  double tick_us;          ///< time that the tick took, µs; 0 in virtual time
  /// Lateness of the servo's newest tick, µs. Of a servo in another process it is the largest of a tenth of a second.
  /// None in virtual time, and when that servo does not report it.
  std::optional<double> servo_late_us;
  const ServoStatistics& servo;  ///< the servo's newest statistics, updated ten times a second; zeros in virtual time
};

/// Observes a run. The contact loop's thread makes the calls.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Called before the tick at `t` (s since the start), in virtual time only. It may wait, to pause the run or to slow
  /// it down.
  virtual void before_tick(double t) = 0;
  /// Called after the tick. In real time it must neither wait nor allocate.
  virtual void after_tick(const TickView& tick) noexcept = 0;
};

/// Changes the scene of a run (RunSettings::edits) as HapticLoop::change does: parts are added, removed or moved, or
/// another one is held. Pen, servo, recorder and ticks continue. When another part is held, the pen's present pose maps
/// to that part, and the force goes off until the wanted force is small.
///
/// A recording is of one scene. So each change ends the recording, and RECORDING.2, RECORDING.3, ... (the number stands
/// before the extension) continue it. Each has its scene in a file beside it (RECORDING.2.toml), and its ticks and
/// times count on.
class RunEdits {
 public:
  RunEdits();
  ~RunEdits();
  RunEdits(const RunEdits&) = delete;
  RunEdits& operator=(const RunEdits&) = delete;

  /// Continues with `parts` and the present settings. The part held now stays where it is, whatever pose `parts` gives
  /// it. Any thread but the run's may call it. Returns the parts as they are once they are in force. Before that, it
  /// passes to `ready` the number that TickView::segment will then have.
  ///
  /// Throws Error when there is no run, the loop cannot hold the parts (see HapticLoop), or their recording cannot be
  /// written. Also throws Error when the change has not come into force after a second: new parts block the path that
  /// the held part has taken meanwhile, or there is no pen. Then the run continues unchanged.
  std::vector<Part> change(std::vector<Part> parts, const std::function<void(std::uint64_t segment)>& ready = {});

  struct State;
  State& state() const { return *state_; }  ///< for run_session

 private:
  std::unique_ptr<State> state_;
};

/// Facts about a run before its first tick.
struct RunStart {
  const InitialContactReport& parts;  ///< parts that the held part touches or overlaps
  const std::string& stability;       ///< as RunSummary::stability
  const std::string& torsion;         ///< the torsional stiffness in use and the reason for it, in one line, for people
  const std::string& weight;  ///< weight of the held part, in one line, for people; empty when the hand feels none
  const std::string& guide;   ///< guide along RunSettings::guide_path, in one line, for people; empty without one
};

/// How run_session() runs a scene.
struct RunSettings {
  /// "shm:NAME": the device of another process, such as tegotae-device, in real time only. Empty: the scene's simulated
  /// device, and in real time a servo in a thread of this process.
  std::string device;
  bool real_time = true;  ///< false: virtual time, as fast as possible and the same on every run
  /// Length of the run, s. 0: to the end of the script plus kSettleTime; with another process's device until `stop`.
  double seconds = 0;
  std::string record;   ///< recording (CSV, or MCAP by its ending, see Recorder); empty: none
  std::string program;  ///< name and version of the program, for the recording's metadata
  /// Path (CSV as `tegotae plan` and `review --csv` write it, see read_path) along which the run pulls the hand gently
  /// while it holds the scene's held part. Empty: none. The pull is at most 1 N, and at most half of what the weight
  /// leaves of the device's continuous force. Farther than 20 mm from the path there is no pull; a turn counts by the
  /// coupling's radius. Needs the resolver "qp".
  std::string guide_path;
  RunProgress* progress = nullptr;    ///< receives the progress; null disables it
  RunObserver* observer = nullptr;    ///< called around every tick; null disables it
  RunEdits* edits = nullptr;          ///< changes the scene during the run; null: the scene stays
  InputSource* hand = nullptr;        ///< moves the simulated pen instead of the script; null: the script does
  const InputGuide* guide = nullptr;  ///< leads the simulated hand away from the script; null disables it
  /// Called while the contact loop is built, which takes seconds for large meshes: with the present task, how many of
  /// its parts are done, and how many there are (0 of 0: not known). One call at a time, from several threads; empty:
  /// no calls.
  std::function<void(const std::string& what, std::size_t done, std::size_t total)> on_build;
  std::function<void(const RunStart&)> on_start;  ///< called before the first tick; empty: no call
  const std::atomic<bool>* stop = nullptr;  ///< set it to end the run early; the recording stays; null disables it
  /// FCL checks the committed poses during the run; in real time it takes a quarter of one processor for this. false:
  /// it continues afterwards for a quarter of the time that the run took, but at least two seconds. true: it continues
  /// until all poses are checked.
  bool check_all = false;
  const std::atomic<bool>* stop_check = nullptr;  ///< set it to end the check early; null: only its time ends it
};

/// Evidence that a fit without clearance holds the held part. For half a second, the pen was more than a millimeter
/// away from where the part started, and more than ten times as far from there as the part.
struct HeldFast {
  std::vector<std::size_t> parts;  ///< shrunk parts (InitialContact) that it touched then; indices into Scene::parts
  double moved = 0;                ///< m: how far the held part had moved, at its farthest point
  double pen = 0;                  ///< m: how far the pen had moved
};

/// Lag of the held part behind the pen in a run.
struct LagSummary {
  double max_m = 0;  ///< largest TickReport::lag of a tick
  /// Number of ticks with a lag over lag_bound(), by LagReason.
  std::array<std::int64_t, kLagReasons> ticks{};
  /// TickReport::unexplained_lag_ticks at the end; 0: a contact explains every stop of the part.
  std::int64_t unexplained = 0;
};

/// Result of a run.
struct RunSummary {
  std::int64_t ticks = 0;  ///< number of ticks of the contact loop
  double seconds = 0;      ///< simulated time; in real time also the time it took
  /// The part arrived: the run passed the end of the script, and the part that the scene file holds rests where the
  /// script ends. With the device of another process or RunSettings::hand, the run may end at any time. The part's
  /// center may be off by 2 % of the path's length plus the part's radius, and by what friction and resolution leave of
  /// the pen; its rotation may be off by 0.1 rad. A part that lags at the end by more than lag_bound() for another
  /// reason than contact does not count as arrived.
  bool completed = false;
  /// How far (m) that part's center of mass has moved along the straight line from the script's start to its end.
  double depth_m = 0;
  int contacts_max = 0;  ///< largest TickReport::contacts of a tick
  LagSummary lag;        ///< how far the part lagged the pen, and why
  /// Number of the `checked` poses that intersect a fixed part, by FCL. Pairs that `start` names count only once they
  /// have separated.
  std::int64_t penetrating = 0;
  /// Number of committed poses that FCL checked, spread over the run (RunSettings::check_all).
  std::int64_t checked = 0;
  std::int64_t poses = 0;  ///< number of different poses that were committed
  /// Parts that the held part touched or overlapped at the start, and the state of these pairs at the end or at a
  /// change.
  InitialContactReport start;
  /// The last such event; no parts: there was none.
  HeldFast held_fast;
  double deepest_m = 0;    ///< largest depth of a vertex inside another part at a tick, m; only "penalty" penetrates
  LatencySummary tick_us;  ///< time that a tick of the contact loop takes, µs
  ServoStatistics servo;   ///< in virtual time only the number and rate of its ticks have a meaning
  std::string missing_realtime;  ///< what the system did not grant to this process's servo, or else to the contact loop
  std::string stability;         ///< StabilityReport::text(); only of a servo in this process
  double force_max_n = 0;        ///< largest rendered force, N
  double torque_max_nm = 0;      ///< largest rendered torque, N·m, about the center of mass
  /// How often the device of another process fell silent; the part stayed in place meanwhile.
  std::uint64_t device_losses = 0;
  std::int64_t ignored = 0;  ///< number of ticks that ignored an invalid pen pose or time (TickFlags::input_ignored)
  std::uint64_t record_dropped = 0;  ///< number of rows that the recorder dropped because it was too slow
  std::string record_failure;        ///< why a recording is incomplete, and what it contains; empty: all are complete
  std::vector<std::string> recordings;  ///< paths of the recordings: one, and one more for each change of the scene
};

/// Time (s) after the end of the script in which the hand comes to rest.
inline constexpr double kSettleTime = 0.5;

/// Runs the scene with its device, script, servo and contact loop, and returns the result. In real time the servo has
/// its own thread at 1 kHz, and the contact loop runs in the calling thread. Both run under SCHED_FIFO where the system
/// grants it (the calling thread until the end of the run). In virtual time everything takes turns in the calling
/// thread: the same scene, script and build give the same recording byte for byte.
///
/// Throws Error when the loop cannot hold the scene (see HapticLoop), a script without RunSettings::seconds lasts more
/// than 1e6 s, the guide's path cannot be read, the device cannot be used, the recording cannot be begun, or the
/// recording would replace a file of the scene (SceneFile::files). A recording that fails later does not end the run;
/// RunSummary::record_failure says what was lost.
RunSummary run_session(const SceneFile& file, const RunSettings& settings);

}  // namespace tegotae
