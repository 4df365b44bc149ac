// Processes of a test's own, forked, that are killed and waited for.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <exception>
#include <stdexcept>
#include <utility>

namespace tegotae::test {

/// Runs a function in a forked process. The function tells the parent a number by the `say` it is given; a parent that
/// is gone ends the child.
class ChildProcess {
 public:
  template <class Function>
  explicit ChildProcess(Function function) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("pipe");
    pid_ = fork();
    if (pid_ < 0) throw std::runtime_error("fork");
    if (pid_ == 0) {
      close(ends[0]);
      const auto say = [fd = ends[1]](std::int64_t number) {
        if (write(fd, &number, sizeof number) != sizeof number) _exit(3);
      };
      try {
        function(say);
      } catch (const std::exception&) {
        _exit(2);
      }
      _exit(0);  // not exit(): what the test has open is the parent's
    }
    close(ends[1]);
    from_child_ = ends[0];
  }
  ~ChildProcess() {
    kill(SIGKILL);
    close(from_child_);
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  /// The next number that the child says; throws when it ends without.
  std::int64_t hear() {
    std::int64_t number;
    if (read(from_child_, &number, sizeof number) != sizeof number) throw std::runtime_error("the child is silent");
    return number;
  }
  /// Sends a signal and waits for the end.
  void kill(int signal) {
    if (pid_ <= 0) return;
    ::kill(pid_, signal);
    wait();
  }
  /// Waits for the end; the exit code, or -1 when it was killed.
  int wait() {
    int status = 0;
    waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int from_child_ = -1;
};

}  // namespace tegotae::test
