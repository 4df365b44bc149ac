#include "narrowphase/sweep_helpers.hpp"

#include <pthread.h>
#include <sched.h>

#include <cerrno>
#include <csignal>
#include <string>
#include <system_error>

#include "narrowphase/sweep_worker.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

/// Signals are for the threads that the program knows.
class NoSignals {
 public:
  NoSignals() noexcept {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~NoSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  NoSignals(const NoSignals&) = delete;
  NoSignals& operator=(const NoSignals&) = delete;

 private:
  sigset_t before_;
};

/// A thread has the priority of the one that starts it, which may be the contact loop's.
void leave_real_time() noexcept {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  pthread_getschedparam(pthread_self(), &policy, &parameters);
  if (policy != SCHED_FIFO && policy != SCHED_RR) return;
  parameters.sched_priority = 0;
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &parameters);
}

}  // namespace

SweepHelpers::SweepHelpers(const std::shared_ptr<const SweepModel>& model, int count) {
  sem_init(&wake_, 0, 0);
  const NoSignals inherited;
  try {
    for (int i = 0; i < count; ++i) start(model);
  } catch (const std::system_error& e) {
    stop();
    throw Error("contact.helper_threads: cannot start " + std::to_string(count) + " threads: " + e.what() +
                "; 0 does without");
  }
}

SweepHelpers::~SweepHelpers() {
  stop();
}

void SweepHelpers::start(const std::shared_ptr<const SweepModel>& model) {
  threads_.emplace_back([this, worker = std::make_unique<SweepWorker>(model)] {
    leave_real_time();
    help(*worker);
  });
  pthread_setname_np(threads_.back().native_handle(), "tegotae-helper");
}

void SweepHelpers::stop() noexcept {
  withdraw();
  ends_.store(true);
  for (std::size_t i = 0; i < threads_.size(); ++i) sem_post(&wake_);
  for (std::thread& thread : threads_) thread.join();
  sem_destroy(&wake_);
}

void SweepHelpers::offer(SweepTask& task) noexcept {
  offered_.store(&task);
  for (std::size_t i = 0; i < threads_.size(); ++i) sem_post(&wake_);
}

void SweepHelpers::help(SweepWorker& worker) noexcept {
  while (!ends_.load()) {
    if (SweepTask* const task = offered_.load(); task != nullptr) {
      // It may be withdrawn in between, and then it is not read.
      task->enter();
      if (offered_.load() == task) worker.work(*task, kNoDeadline);
      task->leave();
    }
    while (sem_wait(&wake_) != 0 && errno == EINTR) {
    }
  }
}

}  // namespace tegotae
