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
  /// Creates the file, or empties the one that is there. Throws Error naming the path, or what it is `named`, and the
  /// cause.
  explicit OutputFile(const std::string& path, const std::string& named = "");
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

/// Writes a whole file, by way of one beside it: what stood there is whole until the new one is, and stays when that
/// fails. Symbolic links stay, and lead to the new one, which has the rights of the old one; a hard link keeps the old
/// one. Pipes, devices and descriptors of this process (/dev/stdout) are written into. Throws Error naming the path and
/// the cause.
void write_file(const std::string& path, std::string_view bytes);

/// The same by way of the file `partial`, whatever `path` is. Several processes may do so if each has a name of its
/// own.
void write_file_by(const std::string& partial, const std::string& path, std::string_view bytes);

/// Makes the folder and those above it, where they are not there. Throws Error naming it and the cause.
void make_folder(const std::string& path);

}  // namespace tegotae
