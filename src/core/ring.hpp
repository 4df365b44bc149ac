#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

namespace tegotae {

/// Objects from one producer thread to one consumer thread, without locks or allocation after construction.
template <typename T>
class Ring {
 public:
  explicit Ring(std::size_t capacity) : items_(capacity) {}

  /// False when it is full.
  bool push(const T& item) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    // Acquire: the consumer has finished reading the item whose place is taken.
    if (head - tail_.load(std::memory_order_acquire) == items_.size()) return false;
    items_[head % items_.size()] = item;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// False when it is empty.
  bool pop(T& item) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (head_.load(std::memory_order_acquire) == tail) return false;
    item = items_[tail % items_.size()];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> items_;
  alignas(64) std::atomic<std::size_t> head_{0};  // items ever pushed; on its own cache line
  alignas(64) std::atomic<std::size_t> tail_{0};  // items ever popped
};

}  // namespace tegotae
