#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include "core/ring.hpp"
#include "session/pose_check.hpp"

namespace tegotae {

/// The poses of a segment of a run on their way to the check. One thread adds them.
class CheckedSegment {
 public:
  /// `waits`: add() waits where the check is far behind, instead of leaving poses out. Keeps a reference to `scene`.
  CheckedSegment(const Scene& scene, const InitialContactReport& start, bool waits);
  /// Never allocates. A pose equal to the last one counts once. `freed`: how many pairs of the start had come free.
  void add(const Pose& X, std::uint32_t freed) noexcept;
  void came_free(const InitialContactReport& start) noexcept { judged_.came_free(start); }

 private:
  friend class RunCheck;
  struct Item {
    Pose X;
    std::uint32_t freed = 0;
  };
  JudgedScene judged_;
  Ring<Item> ring_;
  const bool waits_;
  Pose last_;
  std::atomic<std::int64_t> poses_{0};  // different ones
};

/// Asks FCL about the poses that a run commits, beside the run, in a thread of its own: some in a row at a time, which
/// is fast, and the rows in no order. Of a run in real time it takes a quarter of one processor, so that the loops keep
/// theirs; after any run it works on all processors. A question can take a second where large surfaces lie close: it is
/// broken off where the check ends.
class RunCheck {
 public:
  /// Share of the run's time that the check takes beside a run in real time and, at most, after any run.
  static constexpr double kShare = 0.25;
  /// Time (s) that it has after any run.
  static constexpr double kMinTime = 2;

  /// `all`: no pose is left out, whatever time it takes.
  RunCheck(bool all, bool real_time);
  ~RunCheck();
  RunCheck(const RunCheck&) = delete;
  RunCheck& operator=(const RunCheck&) = delete;

  /// A new segment, from any thread.
  std::unique_ptr<CheckedSegment> segment(const Scene& scene, const InitialContactReport& start);
  /// `segment` gets poses from now on, from any thread; it must stay until end() or abandon() has returned.
  void watch(CheckedSegment& segment);

  /// No pose comes any more, after `seconds`. Goes on while there is time, until `stop` (may be null); `share` (may be
  /// null) is told how far that is, from 0 to 1.
  void end(double seconds, const std::atomic<bool>* stop, std::atomic<double>* share);
  /// Ends at once; the questions at hand stay without an answer.
  void abandon() noexcept;

  // After end().
  std::int64_t poses() const;                                  ///< different ones that the run committed
  std::int64_t checked() const { return checked_; }            ///< of them, how many were asked about
  std::int64_t intersecting() const { return intersecting_; }  ///< of these, how many intersect

 private:
  /// Poses of a segment, in a row.
  struct Block {
    CheckedSegment* segment;
    std::vector<CheckedSegment::Item> items;
  };
  /// Who asks, in one thread: about a block, from the pose `next` on.
  struct Asker {
    Block block{nullptr, {}};
    std::size_t next = 0;
    const CheckedSegment* segment = nullptr;  ///< that the judge is for
    std::optional<PoseJudge> judge;
  };

  void work();
  void collect(bool last);
  void add(Block block);
  void thin_out();
  bool ask_some(Asker& asker);
  bool take_block(Asker& asker);
  void give_back(Asker& asker);
  void ask_all();
  bool rest(double seconds);

  const bool all_, real_time_;
  mutable std::mutex mutex_;  // of the next two
  std::condition_variable wake_;
  std::vector<CheckedSegment*> segments_;
  std::atomic<bool> abandoned_{false};  // what is not asked by now is not
  std::atomic<bool> ended_{false};
  std::atomic<std::int64_t> checked_{0}, intersecting_{0}, left_{0};
  std::atomic<bool> done_{false};

  // The thread's own.
  std::vector<Block> filling_;           // one a segment, with fewer poses than a block has
  std::uint64_t stride_ = 1, seen_ = 0;  // blocks

  std::mutex queue_mutex_;  // of the next two
  std::vector<Block> waiting_;
  std::mt19937 rng_;
  std::thread thread_;
};

}  // namespace tegotae
