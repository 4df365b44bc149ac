#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace tegotae {

/// The newest of numbers that one thread writes and any thread reads; neither waits for the other. The last values are
/// kept in turn, so a read meets a write only where its thread is stopped for nearly as many writes as are kept.
template <std::size_t kCount>
class LatestValue {
 public:
  using Values = std::array<double, kCount>;

  /// One thread.
  void write(const Values& values) noexcept {
    const std::uint64_t next = written_.load(std::memory_order_relaxed) + 1;
    begun_.store(next, std::memory_order_relaxed);
    // Who sees a number of this write sees its beginning: each is released, for ThreadSanitizer knows no fences.
    auto& slot = slots_[next % kKept];
    for (std::size_t i = 0; i < kCount; ++i) slot[i].store(values[i], std::memory_order_release);
    written_.store(next, std::memory_order_release);
  }

  /// Any thread; zeros before the first write. A thread that is stopped for so many writes in each of so many tries
  /// gets numbers of different writes: a bound is better than none.
  Values read() const noexcept {
    Values values{};
    for (int i = 0; i < kTries; ++i) {
      const std::uint64_t at = written_.load(std::memory_order_acquire);
      const auto& slot = slots_[at % kKept];
      for (std::size_t k = 0; k < kCount; ++k) values[k] = slot[k].load(std::memory_order_acquire);
      if (begun_.load(std::memory_order_relaxed) - at < kKept) break;
    }
    return values;
  }

 private:
  static constexpr std::uint64_t kKept = 64;
  static constexpr int kTries = 8;

  std::atomic<std::uint64_t> begun_{0}, written_{0};
  std::array<std::array<std::atomic<double>, kCount>, kKept> slots_{};
};

}  // namespace tegotae
