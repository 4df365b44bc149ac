#include "core/thread_signals.hpp"

#include <ctime>

namespace tegotae {

namespace {

constexpr int kOfWrites[] = {SIGPIPE, SIGXFSZ};  // the kernel sends both to the thread that wrote

sigset_t of_writes() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : kOfWrites) sigaddset(&set, signal);
  return set;
}

}  // namespace

WriteSignals::WriteSignals() noexcept {
  const sigset_t set = of_writes();
  sigpending(&pending_before_);
  pthread_sigmask(SIG_BLOCK, &set, &before_);
}

WriteSignals::~WriteSignals() {
  sigset_t pending;
  sigpending(&pending);
  for (const int signal : kOfWrites) {
    // One that somebody else had sent before is left to its handler.
    if (sigismember(&pending, signal) != 1 || sigismember(&pending_before_, signal) == 1) continue;
    sigset_t one;
    sigemptyset(&one);
    sigaddset(&one, signal);
    const timespec now{};
    sigtimedwait(&one, nullptr, &now);
  }
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace tegotae
