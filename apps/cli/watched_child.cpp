#include "cli/watched_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <iostream>

#include "core/number_text.hpp"
#include "shared/process.hpp"
#include "shared/run_options.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::apps {

namespace {

/// The last of the lines that come out of `fd` until its other end is closed; sets `late` when none came for `seconds`.
std::string last_line(int fd, double seconds, bool& late) {
  std::string line, begun;
  const auto patience_ns = static_cast<std::int64_t>(1e9 * seconds);
  for (std::int64_t deadline_ns = monotonic_ns() + patience_ns;;) {
    const std::int64_t left_ns = deadline_ns - monotonic_ns();
    late = left_ns <= 0;
    if (late) return line;
    pollfd ready{fd, POLLIN, 0};
    if (poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left_ns / 1'000'000 + 1, 1'000'000))) <= 0) continue;
    char bytes[4096];
    const ssize_t n = read(fd, bytes, sizeof bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return line;
    deadline_ns = monotonic_ns() + patience_ns;
    begun.append(bytes, static_cast<std::size_t>(n));
    const std::size_t end = begun.rfind('\n');
    if (end == std::string::npos) continue;
    const std::size_t before = end == 0 ? std::string::npos : begun.rfind('\n', end - 1);
    const std::size_t start = before == std::string::npos ? 0 : before + 1;
    line = begun.substr(start, end - start);
    begun.erase(0, end + 1);
  }
}

/// What the child is for: it ends in here.
[[noreturn]] void be_child(const std::string& file, int out,
                           const std::function<int(const std::function<void(const std::string&)>&)>& body) {
  int code = kRunFailed;
  std::string last;
  try {
    code = body([&](const std::string& next) {
      if (next == last) return;
      last = next;
      const std::string line = next + '\n';
      // A line that cannot be written is only missing in the message of a child that hangs.
      [[maybe_unused]] const ssize_t n = write(out, line.data(), line.size());
    });
  } catch (const Error& e) {
    std::cerr << "tegotae: " << e.what() << "\n";
    code = kBadInput;
  } catch (const std::exception& e) {
    std::cerr << "tegotae: " << file << ": " << e.what() << "\n";
  }
  _exit(finish_output("tegotae", code));
}

}  // namespace

int watched_child(const std::string& file, double seconds, const std::string& hint,
                  const std::function<int(const std::function<void(const std::string&)>&)>& body) {
  std::cout.flush();
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw Error(file + ": cannot be read: " + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) {
    const int error = errno;
    close(ends[0]), close(ends[1]);
    throw Error(file + ": cannot be read: " + std::strerror(error));
  }
  if (child == 0) {
    close(ends[0]);
    be_child(file, ends[1], body);
  }
  close(ends[1]);
  bool late = false;
  const std::string at = last_line(ends[0], seconds, late);
  close(ends[0]);
  if (late) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  if (late)
    throw Error(file + ": not read: " + (at.empty() ? "" : at + " ") + "took more than " + number_text(seconds, 6) +
                " s; " + hint);
  const int signal = WTERMSIG(status);
  if (signal == SIGINT || signal == SIGTERM) return kRunFailed;
  throw Error(file + ": damaged: its reader crashed (" + strsignal(signal) + ")");
}

}  // namespace tegotae::apps
