#include "record/row_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "record/csv_row.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {
// Rows are gathered up to this size: some 150 of them in one system call.
constexpr std::size_t kBufferSize = 64 * 1024;
}  // namespace

RowFile::RowFile(const std::string& path) : path_(path) {
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd_ < 0) {
    error_ = errno;
    fail();
  }
  rows_.reserve(kBufferSize);
  rows_ = kRecordHeader;
  flush();
  if (error_ != 0) {
    ::close(fd_);
    fail();
  }
}

RowFile::~RowFile() {
  if (fd_ >= 0) ::close(fd_);
}

void RowFile::fail() const {
  throw Error(path_ + ": cannot write the recording: " + std::strerror(error_));
}

void RowFile::add(const RecordFrame& frame) noexcept {
  if (error_ != 0) return;
  if (rows_.size() + kMaxRecordRow > kBufferSize) flush();
  char row[kMaxRecordRow];
  rows_.append(row, format_row(frame, row));
}

void RowFile::flush() noexcept {
  const char* rest = rows_.data();
  std::size_t left = error_ == 0 ? rows_.size() : 0;
  while (left > 0) {
    const ssize_t written = write(fd_, rest, left);
    if (written < 0) {
      if (errno == EINTR) continue;
      error_ = errno;
      break;
    }
    rest += written;
    left -= static_cast<std::size_t>(written);
  }
  rows_.clear();
}

void RowFile::close() {
  flush();
  if (::close(std::exchange(fd_, -1)) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) fail();
}

}  // namespace tegotae
