#include "syscall_guard.hpp"

#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>

#include "core/sanitizers.hpp"

// The run-time libraries of sanitizers make system calls in every thread.
#if defined(TEGOTAE_SANITIZED)
#define TEGOTAE_SANITIZER_CALLS 1
#elif defined(__has_feature)
#if __has_feature(realtime_sanitizer)
#define TEGOTAE_SANITIZER_CALLS 1
#endif
#endif

namespace tegotae::test {

namespace {

std::atomic<std::uint64_t> refused{0};
std::atomic<long> last{-1};

void on_refused(int, siginfo_t* info, void* context) {
  refused.fetch_add(1);
  last.store(info->si_syscall);
#if defined(__x86_64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RAX] = -ENOSYS;
#elif defined(__aarch64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.regs[0] = static_cast<unsigned long long>(-ENOSYS);
#endif
}

}  // namespace

bool guard_system_calls() {
#if defined(TEGOTAE_SANITIZER_CALLS)
  return false;
#endif
  struct sigaction action {};
  action.sa_sigaction = on_refused;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_nanosleep, 4, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clock_gettime, 3, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_rt_sigreturn, 2, 0),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter = {sizeof program / sizeof program[0], program};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

std::uint64_t refused_system_calls() {
  return refused.load();
}

long last_refused_system_call() {
  return last.load();
}

}  // namespace tegotae::test
