#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include <nanobind/nanobind.h>

namespace tegotae::python {

class PythonRig;

/// Rigs that were started and not stopped. With the GIL held.
void add_running(PythonRig& rig);
void remove_running(PythonRig& rig) noexcept;
/// Stops them, at the interpreter's exit.
void stop_all_running();

/// Does `work` in a thread of its own, so that it never waits for Python, and looks after signals meanwhile: at Ctrl-C
/// it calls `stop`, waits for the end of `work`, and raises KeyboardInterrupt. Throws what `work` throws. Called with
/// the GIL held, which is free while `work` goes on.
template <class Work, class Stop>
void interruptible(Work&& work, Stop&& stop) {
  std::mutex mutex;
  std::condition_variable ended;
  bool over = false;
  std::exception_ptr failure;
  std::thread worker([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    over = true;
    ended.notify_one();
  });
  bool signaled = false;
  const auto is_over = [&] {
    const nanobind::gil_scoped_release others_go_on;
    std::unique_lock<std::mutex> lock(mutex);
    return ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return over; });
  };
  while (!is_over()) {
    if (signaled || PyErr_CheckSignals() == 0) continue;
    signaled = true;
    stop();
  }
  worker.join();
  if (signaled) throw nanobind::python_error();  // the KeyboardInterrupt that is set
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tegotae::python
