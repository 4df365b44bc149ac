#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/record/recording.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Which thread writes a recording.
enum class RecordMode {
  threaded,     ///< push() only copies into a ring, a thread writes: for the wall clock
  synchronous,  ///< push() writes (buffered): for virtual time; never drops a frame
};

/// Writes a recording: MCAP when the path ends in .mcap, otherwise CSV with its info in a file beside it
/// (recording_info_path). Reading the numbers gives the same bits, whatever the locale.
///
/// A failed write (a pipe without a reader, a file size limit, a full disk) never ends the process, and never waits for
/// longer than two seconds (a pipe whose reader does not read). The recorder drops everything after the first failure,
/// and close() reports it.
///
/// The recorder hands only whole rows or chunks to the system. So a killed process leaves a recording that can be read
/// to its last row or chunk. It loses the last 10 ms (CSV, threaded), 64 KB (CSV, synchronous) or 256 KB (MCAP, some
/// 0.3 s).
class Recorder {
 public:
  /// Creates or replaces `path`. `capacity` is the number of frames in the ring. Throws Error that names the path and
  /// the cause.
  Recorder(const std::string& path, RecordMode mode, const RecordingInfo& info = {}, std::size_t capacity = 16384);
  /// Closes. It reports a failure only on standard error, so call close() where failures matter.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Adds a row. Call it in one thread. Threaded: never waits or allocates; when the ring is full, it drops the frame
  /// and counts it. After a failed write it does nothing; close() reports the failure.
  void push(const RecordFrame& frame) noexcept;
  /// Writes the rest and closes. Adds `continued_by` to the info (RecordingInfo::continued_by). Throws Error that names
  /// the path, the cause of the first failed write, and the number of rows written before it.
  void close(const std::string& continued_by = {});

  std::uint64_t rows() const noexcept;     ///< rows that push() accepted
  std::uint64_t dropped() const noexcept;  ///< frames that push() dropped, because the ring was full

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
