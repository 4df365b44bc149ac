#include "record/csv_file.hpp"

#include "record/csv_row.hpp"
#include "record/recording_info.hpp"

namespace tegotae {

namespace {
// Rows are gathered up to this size: some 150 of them in one system call.
constexpr std::size_t kBufferSize = 64 * 1024;
}  // namespace

CsvFile::CsvFile(const std::string& path, const RecordingInfo& info) : path_(path), file_(path), info_(info) {
  rows_.reserve(kBufferSize);
  rows_ = kRecordHeader;
  flush();
  file_.check();
  write_info(info, path);
}

void CsvFile::add(const RecordFrame& frame) noexcept {
  if (file_.failed()) return;
  if (rows_.size() + kMaxRecordRow > kBufferSize) flush();
  char row[kMaxRecordRow];
  rows_.append(row, format_row(frame, row));
  ++frames_;
}

void CsvFile::flush() noexcept {
  file_.write(rows_);
  rows_.clear();
  if (!file_.failed()) written_ = frames_;
}

void CsvFile::close(const std::string& continued_by) {
  flush();
  file_.close();
  info_.continued_by = continued_by;
  if (!continued_by.empty()) write_info(info_, path_);
}

}  // namespace tegotae
