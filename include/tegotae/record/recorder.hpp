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
  threaded,     ///< push() only copies into a ring, and a thread writes: for the wall clock
  synchronous,  ///< push() writes, buffered: for virtual time; never drops a frame
};

/// Writes a recording: MCAP when the path ends in .mcap, otherwise CSV with its metadata in a file beside it
/// (recording_info_path). Reading the numbers gives the same bits, whatever the locale.
///
/// A failed write (a pipe without a reader, a file size limit, a full disk) never ends the process. A pipe whose reader
/// does not read delays a write by at most two seconds. The recorder drops everything after the first failure, and
/// close() reports it.
///
/// The recorder passes only whole rows or chunks to the system. So a killed process leaves a recording that can be read
/// to its last row or chunk. It loses the last 10 ms (CSV, threaded), 64 KB (CSV, synchronous) or 256 KB (MCAP, some
/// 0.3 s).
class Recorder {
 public:
  /// Creates or replaces `path`. `capacity` is the number of frames in the ring of RecordMode::threaded. Throws Error
  /// that names the path and the cause.
  Recorder(const std::string& path, RecordMode mode, const RecordingInfo& info = {}, std::size_t capacity = 16384);
  /// Closes. Reports a failure only on standard error, so call close() where failures matter.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Adds a row. Only one thread may call it. In RecordMode::threaded it never waits or allocates; when the ring is
  /// full, it drops the frame and counts it. After close() it does nothing. After a failed write its rows are lost;
  /// close() reports the failure.
  void push(const RecordFrame& frame) noexcept;
  /// Writes the rest and closes. Adds `continued_by` to the metadata (RecordingInfo::continued_by). Throws Error that
  /// names the path, the cause of the first failed write, and the number of rows written before it.
  void close(const std::string& continued_by = {});

  std::uint64_t rows() const noexcept;     ///< number of rows that push() accepted
  std::uint64_t dropped() const noexcept;  ///< number of frames that push() dropped, because the ring was full

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
