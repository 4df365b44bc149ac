#pragma once

#include <string>

#include "core/output_file.hpp"
#include "record/record_file.hpp"

namespace tegotae {

/// A CSV recording: a header row, then one row a frame, handed to the system in whole rows.
class CsvFile final : public RecordFile {
 public:
  CsvFile(const std::string& path, const RecordingInfo& info);

  void add(const RecordFrame& frame) noexcept override;
  void flush() noexcept override;
  void hurry() noexcept override { file_.hurry(); }
  std::uint64_t written() const noexcept override { return written_; }
  void close(const std::string& continued_by) override;

 private:
  std::string path_;
  OutputFile file_;
  RecordingInfo info_;
  std::string rows_;
  std::uint64_t frames_ = 0, written_ = 0;
};

}  // namespace tegotae
