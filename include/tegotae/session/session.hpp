#pragma once

#include <array>
#include <atomic>
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

/// What a running session shows to another thread. Every value is the newest one; together they are no snapshot.
struct RunProgress {
  std::atomic<double> t{0};                            ///< s since the start
  std::atomic<double> duration{0};                     ///< s the run will take; infinite: until it is ended
  std::atomic<double> depth{0};                        ///< m, as RunSummary::depth_m
  std::atomic<int> contacts{0};                        ///< TickReport::contacts of the newest tick
  std::atomic<double> force{0};                        ///< N
  std::atomic<LagReason> lag_reason{LagReason::none};  ///< of the newest tick; none while the lag is under its bound
  std::atomic<bool> device{true};                      ///< the device is there
  std::atomic<bool> held{false};    ///< parts of a fit without room hold it where it started (HeldFast)
  std::atomic<double> checked{-1};  ///< after the last tick: share of the rest of the check (RunSummary::checked); < 0
};

/// A tick of the contact loop, for whoever looks on.
struct TickView {
  std::uint64_t tick;                   ///< number of the contact loop's tick, from 0
  double t;                             ///< s since the start
  const PenSample& pen;                 ///< the sample that the tick answered
  const HapticLoop& loop;               ///< its report() and limits() are of this tick
  std::uint64_t segment;                ///< of the run between two changes of its scene (RunEdits), from 0
  double tick_us;                       ///< time the tick took; 0 in virtual time
  std::optional<double> servo_late_us;  ///< how late the servo's newest tick began, or of another process's servo the
                                        ///< worst in a tenth of a second; none in virtual time and where nothing says
  const ServoStatistics& servo;  ///< what the servo last told of itself, ten times a second; zeros in virtual time
};

/// Looks on while a session runs. Called in the contact loop's thread.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Before the tick at `t` (s since the start), in virtual time only: may wait, to hold the run or to slow it down.
  virtual void before_tick(double t) = 0;
  /// After the tick. In real time it must neither wait nor allocate.
  virtual void after_tick(const TickView& tick) noexcept = 0;
};

/// Changes the scene of a running session (RunSettings::edits) as HapticLoop::change does: parts are added, removed,
/// moved, or another one is held. Pen, servo, recorder and ticks go on. Where another part is held the pen, where it
/// is, comes to mean that part, and the force goes off until a small one is wanted.
///
/// A recording is of one scene. So with each change it ends, and RECORDING.2, RECORDING.3, ... (before its extension)
/// go on from it, each with its scene in a file beside it (RECORDING.2.toml) and ticks and times that count on.
class RunEdits {
 public:
  RunEdits();
  ~RunEdits();
  RunEdits(const RunEdits&) = delete;
  RunEdits& operator=(const RunEdits&) = delete;

  /// Goes on with `parts`, of which the one that is held now is put where it is now, and settings as they are. From
  /// any thread but the session's; returns the parts as they are when they are in force. `ready` is told the number
  /// that TickView::segment will have then, before it has. Throws Error, and the run goes on as it was, when there is
  /// none, the parts cannot be held (see HapticLoop), their recording cannot be written, or what is new stands for a
  /// second in the way that the held part has gone meanwhile.
  std::vector<Part> change(std::vector<Part> parts, const std::function<void(std::uint64_t segment)>& ready = {});

  struct State;
  State& state() const { return *state_; }  ///< for run_session

 private:
  std::unique_ptr<State> state_;
};

/// What is known of a run before its first tick.
struct RunStart {
  const InitialContactReport& parts;  ///< what the held part touches or overlaps
  const std::string& stability;       ///< as RunSummary::stability
  const std::string& torsion;         ///< the torsional stiffness in use and why it is that, in one line, for people
  const std::string& weight;          ///< of the held part, in one line, for people; empty when the hand feels none
  const std::string& guide;           ///< along RunSettings::guide_path, in one line, for people; empty without one
};

/// How run_session() runs a scene.
struct RunSettings {
  /// "shm:NAME": the device of another process, such as tegotae-device; empty: the scene's simulated one with a servo
  /// in a thread of this process. Only in real time.
  std::string device;
  bool real_time = true;  ///< false: virtual time, as fast as it goes and the same on every run
  double seconds = 0;   ///< how long; 0: to the end of the script and kSettleTime more; another process's: until `stop`
  std::string record;   ///< recording (CSV, or MCAP by its ending, see Recorder); empty: none
  std::string program;  ///< name and version, for the recording's info
  /// Path (CSV as of `tegotae plan` and `review --csv`, see read_path) that the hand is pulled along gently while it
  /// holds the scene's held part: with at most 1 N, half of what the weight leaves of what the device stands for long,
  /// and not at all farther than 20 mm (a turn counted by the coupling's radius) from the path. Empty: none. Needs
  /// "qp".
  std::string guide_path;
  RunProgress* progress = nullptr;                ///< written to while it runs; null: disabled
  RunObserver* observer = nullptr;                ///< asked around every tick; null: disabled
  RunEdits* edits = nullptr;                      ///< changes the scene while it runs; null: it stays
  InputSource* hand = nullptr;                    ///< moves the simulated pen instead of the script
  const InputGuide* guide = nullptr;              ///< leads the simulated hand away from the script
  std::function<void(const RunStart&)> on_start;  ///< told before the first tick
  const std::atomic<bool>* stop = nullptr;        ///< set it to end the run early; the recording is kept
  /// The check of the committed poses with FCL goes on beside the run, and after it for a quarter of the time that the
  /// run took, or two seconds; in real time it takes a quarter of one processor. true: until all are checked.
  bool check_all = false;
  const std::atomic<bool>* stop_check = nullptr;  ///< set it to end the check as it is; null: only its time ends it
};

/// That a held part stood where it started for half a second although its pen had gone more than a millimeter, and ten
/// times as far as the part: a fit without room holds it.
struct HeldFast {
  std::vector<std::size_t> parts;  ///< relieved parts (InitialContact) that it touched then; index into Scene::parts
  double moved = 0;                ///< how far the held part had gone, its farthest point, m
  double pen = 0;                  ///< how far the pen had, m
};

/// How the held part lagged behind the pen in a run.
struct LagSummary {
  double max_m = 0;  ///< largest TickReport::lag of a tick
  /// Ticks with a lag over lag_bound(), by LagReason.
  std::array<std::int64_t, kLagReasons> ticks{};
  std::int64_t unexplained = 0;  ///< TickReport::unexplained_lag_ticks at the end: 0 in a run without silent walls
};

/// How a run went.
struct RunSummary {
  std::int64_t ticks = 0;  ///< of the contact loop
  double seconds = 0;      ///< simulated time; in real time also the time it took
  /// The run went past the end of the script (with the device of another process: whenever it ended) and the part that
  /// the scene file holds rests where the script ends: its center within 2 % of the way plus the part's radius and what
  /// friction and resolution leave of the pen, its rotation within 0.1 rad. A part that lags at the end by more than
  /// lag_bound() for another reason than contact is not where it should be.
  bool completed = false;
  /// How far (m) that part's center has gone along the straight line from where the script starts to where it ends.
  double depth_m = 0;
  int contacts_max = 0;  ///< most TickReport::contacts of a tick
  LagSummary lag;        ///< how far it was behind the pen, and why
  /// Of the `checked` poses, how many intersect a fixed part, by FCL. Pairs that `start` names do not count until they
  /// have come free.
  std::int64_t penetrating = 0;
  std::int64_t checked = 0;  ///< committed poses that FCL was asked about, spread over the run (RunSettings::check_all)
  std::int64_t poses = 0;    ///< different poses that were committed
  InitialContactReport
      start;               ///< what the held part touched or overlapped at the start, as it was at the end or a change
  HeldFast held_fast;      ///< the last time that it was so; no parts: never
  double deepest_m = 0;    ///< deepest that a vertex was inside another part at a tick, m; only "penalty" penetrates
  LatencySummary tick_us;  ///< time a tick of the contact loop takes
  ServoStatistics servo;   ///< in virtual time only the number of ticks
  std::string missing_realtime;  ///< what the system did not grant to this process's servo, or else to the contact loop
  std::string stability;         ///< StabilityReport::text(); of this process's servo only
  double force_max_n = 0;        ///< largest rendered force, N
  double torque_max_nm = 0;      ///< largest rendered torque, N·m, about the center of mass
  std::uint64_t device_losses = 0;   ///< how often the device of another process fell silent; the part stayed meanwhile
  std::int64_t ignored = 0;          ///< ticks whose pen pose was out of range (TickFlags::input_ignored)
  std::uint64_t record_dropped = 0;  ///< rows that the recorder could not keep up with
  std::string record_failure;        ///< why a recording is not whole, and what it has; empty: all are
  std::vector<std::string> recordings;  ///< their paths: one, and one more for each change of the scene
};

/// Time (s) after the end of the script in which the hand comes to rest.
inline constexpr double kSettleTime = 0.5;

/// Runs the scene with its device, script, servo and contact loop. In real time the servo has its own thread at 1 kHz
/// and the contact loop runs in the calling thread, both under SCHED_FIFO where the system grants it (the calling
/// thread until the end of the run). In virtual time everything takes turns in the calling thread: the same scene,
/// script and build give the same recording byte for byte.
///
/// Throws Error when the scene cannot be held (see HapticLoop), the guide's path cannot be read, the recording cannot
/// be begun, or it would replace a file that the scene was read from (SceneFile::files). A recording that fails later
/// ends nothing: the run goes on, and the summary says what was lost.
RunSummary run_session(const SceneFile& file, const RunSettings& settings);

}  // namespace tegotae
