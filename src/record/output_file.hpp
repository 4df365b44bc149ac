#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tegotae {

/// A file that keeps its first failure; what is written after that is dropped.
class OutputFile {
 public:
  /// Creates or replaces the file. Throws Error naming the path and the cause.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes) noexcept;
  bool failed() const noexcept { return error_ != 0; }
  std::uint64_t size() const noexcept { return size_; }  ///< bytes handed over
  /// A failure outside the file, an errno: as if a write had failed.
  void fail_with(int error) noexcept { error_ = error_ == 0 ? error : error_; }
  /// Throws the first failure, as Error.
  void check() const;
  /// Closes, and check().
  void close();

 private:
  std::string path_;
  int fd_ = -1;
  int error_ = 0;  // errno of the first failure
  std::uint64_t size_ = 0;
};

}  // namespace tegotae
