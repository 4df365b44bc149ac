#include "cli/watched_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iostream>
#include <new>

#include "core/number_text.hpp"
#include "core/sanitizers.hpp"
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

/// So that a file that wants all memory ends this process and not others. Whoever asks for more ends it here: readers
/// that catch what `new` throws would tell of another reason.
void bound_memory(const std::string& file, double megabytes) {
#ifndef TEGOTAE_SANITIZED  // sanitizers reserve terabytes of address space
  if (megabytes <= 0)
    megabytes = 0.75e-6 * static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  static std::string text;  // made while there is memory
  text = "tegotae: " + file + ": not read: it takes more than " + fixed_text(megabytes, 0) +
         " MB of memory; tegotae import has --megabytes\n";
  std::set_new_handler([] {
    [[maybe_unused]] const ssize_t n = write(STDERR_FILENO, text.data(), text.size());
    _exit(kBadInput);
  });
  rlimit bound{};
  getrlimit(RLIMIT_AS, &bound);  // whoever started the program may have set a lower one
  bound.rlim_cur = bound.rlim_max = std::min(bound.rlim_max, static_cast<rlim_t>(1e6 * megabytes));
  if (setrlimit(RLIMIT_AS, &bound) != 0) throw Error(file + ": its memory cannot be bounded: " + std::strerror(errno));
#else
  static_cast<void>(file), static_cast<void>(megabytes);
#endif
}

/// What to add to the error of a child that was near its bound: C libraries that get no memory tell of damage.
std::string near_bound() {
  rlimit bound{};
  getrlimit(RLIMIT_AS, &bound);
  std::ifstream status("/proc/self/status");
  double kilobytes = 0;
  for (std::string word; status >> word;)
    if (word == "VmPeak:") status >> kilobytes;
  const double most = static_cast<double>(bound.rlim_cur);
  if (bound.rlim_cur == RLIM_INFINITY || 1024 * kilobytes < 0.75 * most) return "";
  return "; or it takes more than " + fixed_text(1e-6 * most, 0) + " MB of memory: tegotae import has --megabytes";
}

/// What the child is for: it ends in here.
[[noreturn]] void be_child(const std::string& file, double megabytes, int out,
                           const std::function<int(const std::function<void(const std::string&)>&)>& body) {
  int code = kRunFailed;
  std::string last;
  try {
    bound_memory(file, megabytes);
    code = body([&](const std::string& next) {
      if (next == last) return;
      last = next;
      const std::string line = next + '\n';
      // A line that cannot be written is only missing in the message of a child that hangs.
      [[maybe_unused]] const ssize_t n = write(out, line.data(), line.size());
    });
  } catch (const Error& e) {
    std::cerr << "tegotae: " << e.what() << near_bound() << "\n";
    code = kBadInput;
  } catch (const std::exception& e) {
    std::cerr << "tegotae: " << file << ": " << e.what() << "\n";
  }
  _exit(finish_output("tegotae", code));
}

}  // namespace

int watched_child(const std::string& file, const ChildBounds& bounds, const std::string& hint,
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
    be_child(file, bounds.megabytes, ends[1], body);
  }
  close(ends[1]);
  bool late = false;
  const std::string at = last_line(ends[0], bounds.seconds, late);
  close(ends[0]);
  if (late) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  if (late)
    throw Error(file + ": not read: " + (at.empty() ? "" : at + " ") + "took more than " +
                number_text(bounds.seconds, 6) + " s; " + hint);
  const int signal = WTERMSIG(status);
  if (signal == SIGINT || signal == SIGTERM) return kRunFailed;
  throw Error(file + ": damaged: its reader crashed (" + strsignal(signal) + ")");
}

}  // namespace tegotae::apps
