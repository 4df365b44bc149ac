#pragma once

#include <semaphore.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "narrowphase/sweep_model.hpp"
#include "narrowphase/sweep_task.hpp"

namespace tegotae {

class SweepWorker;

/// Threads that do pieces of the task of another one. They sleep where there is none, run at the priority of ordinary
/// programs, handle no signals, and are called "tegotae-helper" where threads are shown.
class SweepHelpers {
 public:
  /// Throws Error if the system gives no more threads.
  SweepHelpers(const std::shared_ptr<const SweepModel>& model, int count);
  ~SweepHelpers();
  SweepHelpers(const SweepHelpers&) = delete;
  SweepHelpers& operator=(const SweepHelpers&) = delete;

  /// Another task from here on. Neither waits nor locks.
  void offer(SweepTask& task) noexcept;
  /// None. Who is inside the one that was offered leaves it some time later: see SweepTask::is_empty().
  void withdraw() noexcept { offered_.store(nullptr); }

 private:
  void start(const std::shared_ptr<const SweepModel>& model);
  void stop() noexcept;
  void help(SweepWorker& worker) noexcept;

  std::atomic<SweepTask*> offered_{nullptr};
  std::atomic<bool> ends_{false};
  sem_t wake_;
  std::vector<std::thread> threads_;
};

}  // namespace tegotae
