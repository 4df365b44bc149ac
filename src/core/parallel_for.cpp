#include "core/parallel_for.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tegotae {

void parallel_for(int n, int threads, const std::function<void(int)>& job, const std::function<void(int)>& done) {
  std::atomic<int> next{0};
  int count = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (int i = next++; i < n; i = next++) {
      std::exception_ptr thrown;
      try {
        job(i);
      } catch (...) {
        thrown = std::current_exception();
        next = n;
      }
      const std::lock_guard<std::mutex> lock(mutex);
      ++count;
      try {
        if (done) done(count);
      } catch (...) {
        if (!thrown) thrown = std::current_exception();
        next = n;
      }
      if (thrown && !failure) failure = thrown;
    }
  };
  const int wanted = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  std::vector<std::thread> others;
  for (int k = 1; k < std::min(wanted, n); ++k) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace tegotae
