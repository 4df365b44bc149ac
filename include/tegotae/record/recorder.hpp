#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/record/recording.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Who writes a recording.
enum class RecordMode {
  threaded,     ///< push() only copies into a ring, a thread writes: for the wall clock
  synchronous,  ///< push() writes (buffered): for virtual time; never drops a frame
};

/// Writes a recording: MCAP when the path ends in .mcap, otherwise CSV with its info in a file beside it
/// (recording_info_path). Numbers are written so that reading them gives the same bits, whatever the locale.
///
/// No failed write ends the process (a pipe without a reader, a limit of size, a full disk) or waits for longer than
/// two seconds (a pipe whose reader does not read); what comes after the first is dropped, and close() tells.
///
/// Only whole rows or chunks are handed to the system. A killed process leaves a recording that can be read to its last
/// row or chunk; what it loses are the last 10 ms (CSV, threaded), 64 KB (CSV, synchronous) or 256 KB (MCAP, some 0.3
/// s).
class Recorder {
 public:
  /// Creates or replaces `path`. `capacity`: frames of the ring. Throws Error naming the path and the cause.
  Recorder(const std::string& path, RecordMode mode, const RecordingInfo& info = {}, std::size_t capacity = 16384);
  /// Closes; a failure is then only told on standard error, so call close() where it matters.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Adds a row. One thread calls it. Threaded: never waits or allocates; when the ring is full the frame is dropped
  /// and counted. After a failed write it does nothing; close() tells.
  void push(const RecordFrame& frame) noexcept;
  /// Writes what is left and closes. `goes_on` is added to the info (RecordingInfo::goes_on). Throws Error naming the
  /// path, the cause of the first failed write, and how many rows were written before it.
  void close(const std::string& goes_on = {});

  std::uint64_t rows() const noexcept;     ///< rows taken by push()
  std::uint64_t dropped() const noexcept;  ///< frames that were not: the ring was full

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
