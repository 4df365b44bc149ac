#pragma once

#include <string>

#include "tegotae/record/recorder.hpp"

namespace tegotae {

/// A CSV file that is handed to the system in whole rows. The first failure is kept, later rows are dropped.
class RowFile {
 public:
  /// Creates or replaces the file and writes the header row. Throws Error naming the path and the cause.
  explicit RowFile(const std::string& path);
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  void add(const RecordFrame& frame) noexcept;
  void flush() noexcept;
  /// Throws the first failure, as Error.
  void close();

 private:
  [[noreturn]] void fail() const;
  std::string path_;
  int fd_ = -1;
  int error_ = 0;  // errno of the first failure
  std::string rows_;
};

}  // namespace tegotae
