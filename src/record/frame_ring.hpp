#pragma once

#include <atomic>
#include <vector>

#include "tegotae/record/recorder.hpp"

namespace tegotae {

/// Frames from one producer thread to one consumer thread, without locks or allocation after construction.
class FrameRing {
 public:
  explicit FrameRing(std::size_t capacity) : frames_(capacity) {}

  /// False when it is full.
  bool push(const RecordFrame& frame) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    // Acquire: the consumer has finished reading the frame whose place is taken.
    if (head - tail_.load(std::memory_order_acquire) == frames_.size()) return false;
    frames_[head % frames_.size()] = frame;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// False when it is empty.
  bool pop(RecordFrame& frame) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (head_.load(std::memory_order_acquire) == tail) return false;
    frame = frames_[tail % frames_.size()];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  std::vector<RecordFrame> frames_;
  alignas(64) std::atomic<std::size_t> head_{0};  // frames ever pushed; on its own cache line
  alignas(64) std::atomic<std::size_t> tail_{0};  // frames ever popped
};

}  // namespace tegotae
