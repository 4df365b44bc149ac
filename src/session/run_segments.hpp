#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "session/run_check.hpp"
#include "session/run_goal.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/record/recorder.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae {

/// A run between two changes of its scene.
struct RunSegment {
  std::uint64_t number = 0;
  Scene scene;
  std::string held;            ///< name of the held part
  InitialContactReport start;  ///< as of the last tick
  int waiting = 0;             ///< pairs that were not free when it began
  int freed = 0;               ///< of them, since
  std::unique_ptr<CheckedSegment> check;
  std::optional<Recorder> recorder;
  std::string recording;   ///< path; empty: none
  std::string scene_file;  ///< that the recording names
};

/// `scene` as the loop of a run gets it: a budget in seconds would let the load of the machine decide what a run in
/// virtual time does.
Scene in_its_time(Scene scene, bool real_time);

/// The segments of a run. One thread ticks, another one at a time changes the scene; the first never waits for it.
class RunSegments {
 public:
  /// `file` is the scene in which `loop` begins. Throws Error when the recording cannot be written. Keeps references.
  RunSegments(const SceneFile& file, const RunSettings& settings, HapticLoop& loop, RunCheck& check,
              const RunGoal& goal);
  /// No change() comes or is at work any more.
  ~RunSegments();
  RunSegments(const RunSegments&) = delete;
  RunSegments& operator=(const RunSegments&) = delete;

  // The thread that ticks.
  RunSegment& now() noexcept { return *now_; }
  /// After each tick, to go over to the segment that it was in: true in the first tick of one.
  bool follow() noexcept;
  /// No tick comes any more: a change that waits for one gives up, and the recordings are closed.
  void end();

  /// See RunEdits::change.
  std::vector<Part> change(std::vector<Part> parts, const std::function<void(std::uint64_t)>& ready);

  // After end().
  const InitialContactReport& start() const { return segments_.front()->start; }  ///< of the run
  std::uint64_t dropped() const;
  /// Of the first recording that could not be written to its end; empty when all are whole.
  const std::string& failure() const { return failure_; }
  std::vector<std::string> recordings() const;

 private:
  // A change that waits, the one in force, and room.
  static constexpr std::size_t kSlots = 4;

  void begin(RunSegment& segment, const Scene& scene, const InitialContactReport& start);
  void record(RunSegment& segment, const InitialContactReport& start);
  void name_goal(const RunSegment& segment, RecordingInfo& info) const;
  bool wait_for(std::uint64_t change) const;
  void finish(RunSegment& segment, const std::string& continued_by) noexcept;
  void detach();

  const SceneFile& file_;
  const RunSettings& settings_;
  HapticLoop& loop_;
  RunCheck& check_;
  const RunGoal& goal_;
  std::vector<std::unique_ptr<RunSegment>> segments_;  // that were in force, and the one that will be
  RunSegment* now_;
  std::uint64_t change_ = 0;  // that now_ is of
  std::array<std::atomic<RunSegment*>, kSlots> by_change_{};
  std::atomic<std::uint64_t> followed_{0};  // the change that follow() has gone over to
  std::atomic<bool> over_{false};
  std::string failure_;  // of the first recording that could not be closed
};

/// Who changes the scene, and the run whose scene it is.
struct RunEdits::State {
  std::mutex mutex;  // the thread that ticks takes it before its first tick and after its last
  RunSegments* run = nullptr;
};

}  // namespace tegotae
