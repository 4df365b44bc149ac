#include "core/output_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/thread_signals.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// What a pipe's reader may take for one write, which is 64 KB of a recording.
constexpr std::int64_t kPatienceNs = 2'000'000'000;
constexpr int kPollMs = 50;

std::string cause(int error) {
  // Of an open that does not wait; of a write that has waited.
  if (error == ENXIO) return "it is a pipe without a reader";
  if (error == EAGAIN) return "the reader of the pipe does not read";
  return std::strerror(error);
}

}  // namespace

OutputFile::OutputFile(const std::string& path, const std::string& named)
    // Without O_NONBLOCK opening a pipe would wait for its reader.
    : path_(named.empty() ? path : named),
      fd_(above_standard(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0666))) {
  if (fd_.get() < 0) error_ = errno;
  check();
}

bool OutputFile::wait() noexcept {
  const std::int64_t begin = monotonic_ns();
  pollfd ready{fd_.get(), POLLOUT, 0};
  poll(&ready, 1, kPollMs);
  waited_ns_ += monotonic_ns() - begin;
  return waited_ns_ < kPatienceNs;
}

void OutputFile::write(std::string_view bytes) noexcept {
  if (error_ != 0) return;
  const WriteSignals signals;
  size_ += bytes.size();
  if (!hurry_) waited_ns_ = 0;
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_.get(), bytes.data(), bytes.size());
    if (written < 0) {
      const int error = errno;
      if (error == EINTR || (error == EAGAIN && wait())) continue;
      error_ = error;
      return;
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFile::check() const {
  if (error_ != 0) throw Error(ErrorKind::file, path_ + ": cannot be written: " + cause(error_), {path_, 0, {}, {}});
}

void OutputFile::close() {
  if (fd_.get() >= 0 && ::close(fd_.release()) != 0) fail_with(errno);
  check();
}

}  // namespace tegotae
