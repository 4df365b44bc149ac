#pragma once

#include <memory>
#include <string>

#include "tegotae/record/recording.hpp"

namespace tegotae {

/// A recording being written, in one of the formats. The first failure is kept, later frames are dropped.
class RecordFile {
 public:
  virtual ~RecordFile() = default;
  virtual void add(const RecordFrame& frame) noexcept = 0;
  /// Hands over to the system what may be handed over by now.
  virtual void flush() noexcept = 0;
  /// From now on all that is written has to go within two seconds.
  virtual void hurry() noexcept = 0;
  /// Frames of which the system has taken all.
  virtual std::uint64_t written() const noexcept = 0;
  /// Writes what is left, with `continued_by` in the info where there is one, and throws the first failure, as Error.
  virtual void close(const std::string& continued_by) = 0;
};

/// Creates or replaces the file; its ending chooses the format. Throws Error naming the path and the cause.
std::unique_ptr<RecordFile> open_record_file(const std::string& path, const RecordingInfo& info);

}  // namespace tegotae
