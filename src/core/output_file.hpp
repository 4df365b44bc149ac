#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/file_descriptor.hpp"

namespace tegotae {

/// A file that keeps its first failure; what is written after that is dropped. No failure ends the process or waits for
/// ever: a pipe without a reader is refused, one whose reader does not take what is written within two seconds fails.
class OutputFile {
 public:
  /// Creates or replaces the file. Throws Error naming the path and the cause.
  explicit OutputFile(const std::string& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes) noexcept;
  bool failed() const noexcept { return error_ != 0; }
  std::uint64_t size() const noexcept { return size_; }  ///< bytes handed over
  /// A failure outside the file, an errno: as if a write had failed.
  void fail_with(int error) noexcept { error_ = error_ == 0 ? error : error_; }
  /// Throws the first failure, as Error.
  void check() const;
  /// From now on all that is written has to go within two seconds.
  void hurry() noexcept { hurry_ = true; }
  /// Closes, and check().
  void close();

 private:
  /// Waits until a pipe takes more; false when its time is over.
  bool wait() noexcept;

  std::string path_;
  FileDescriptor fd_;
  int error_ = 0;  // errno of the first failure
  std::uint64_t size_ = 0;
  std::int64_t waited_ns_ = 0;  // for the reader of a pipe, in this write or since hurry()
  bool hurry_ = false;
};

/// Writes a whole file. Throws Error naming the path and the cause.
void write_file(const std::string& path, std::string_view bytes);

/// The same, by way of a file beside it: what stood there is whole until the new one is.
void replace_file(const std::string& path, std::string_view bytes);

}  // namespace tegotae
