#include "experiments/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tegotae::experiments {

void Work::each(const std::string& what, int n, const std::function<void(int)>& job) const {
  std::atomic<int> next{0};
  int done = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (int i = next++; i < n; i = next++) {
      try {
        job(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = n;
      }
      const std::lock_guard<std::mutex> lock(mutex);
      status.say(what + ": " + std::to_string(++done) + " of " + std::to_string(n));
    }
  };
  const int wanted = options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency());
  std::vector<std::thread> others;
  for (int k = 1; k < std::min(wanted, n); ++k) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tegotae::experiments
