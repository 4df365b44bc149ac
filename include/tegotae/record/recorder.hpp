#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// One row of a recording: one certified piece of a tick of the contact loop.
struct RecordFrame {
  std::uint64_t tick = 0;
  std::uint32_t substep = 0;  ///< number of the piece in its tick, from 0
  double t = 0;               ///< s
  Pose y;                     ///< where the pen wants the held part's file frame
  Pose x;                     ///< the held part's file frame, in the world
  Wrench wrench;              ///< on the pen, at the held part's center of mass, N and N·m
  int contacts = 0;
  double gap = 0;      ///< smallest known gap, m; +inf when nothing is near (written as inf)
  double tick_us = 0;  ///< time that the tick took; 0 in virtual time
};

enum class RecordMode {
  threaded,     ///< push() only copies into a ring, a thread writes: for the wall clock
  synchronous,  ///< push() writes (buffered): for virtual time; never drops a frame
};

/// Writes a CSV file: a header row, then one row a frame, numbers so that reading them gives the same bits, whatever
/// the locale. Only whole rows are handed to the system, so a killed process leaves whole rows but perhaps for the last
/// one; what it loses are the last 10 ms (threaded) or 64 KB (synchronous).
class Recorder {
 public:
  /// Creates or replaces `path`. `capacity`: frames of the ring. Throws Error naming the path and the cause.
  explicit Recorder(const std::string& path, RecordMode mode, std::size_t capacity = 16384);
  /// Closes; a failure is then only told on standard error, so call close() where it matters.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Adds a row. One thread calls it. Threaded: never waits or allocates; when the ring is full the frame is dropped
  /// and counted. After a failed write it does nothing; close() tells.
  void push(const RecordFrame& frame) noexcept;
  /// Writes what is left and closes. Throws Error naming the path and the cause of the first failed write.
  void close();

  std::uint64_t rows() const noexcept;     ///< rows taken by push()
  std::uint64_t dropped() const noexcept;  ///< frames that were not: the ring was full

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
