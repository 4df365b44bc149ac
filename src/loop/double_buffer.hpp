#pragma once

#include <atomic>
#include <memory>

namespace tegotae {

/// Passes objects made in any thread to one thread that never waits, allocates or frees. The newest offer counts. The
/// taker retires objects to a list, which the next offer frees. `T` has a member `T* retired_before`.
template <class T>
class DoubleBuffer {
 public:
  DoubleBuffer() = default;
  DoubleBuffer(const DoubleBuffer&) = delete;
  DoubleBuffer& operator=(const DoubleBuffer&) = delete;
  ~DoubleBuffer() {
    std::unique_ptr<T>(offered_.exchange(nullptr));
    free_retired();
  }

  /// Any thread. An older offer that was not taken is dropped.
  void offer(std::unique_ptr<T> object) {
    free_retired();
    std::unique_ptr<T>(offered_.exchange(object.release(), std::memory_order_acq_rel));
  }

  /// Any thread. The offer that is taken back; null when there is none, or the taker holds it.
  std::unique_ptr<T> withdraw() { return std::unique_ptr<T>(offered_.exchange(nullptr, std::memory_order_acq_rel)); }

  // The taker's thread.
  /// Null when there is no offer.
  T* take() noexcept {
    // A plain load first: most of the time there is nothing, and an exchange would take the cache line each time.
    if (offered_.load(std::memory_order_relaxed) == nullptr) return nullptr;
    return offered_.exchange(nullptr, std::memory_order_acq_rel);
  }
  /// Not yet: offers it again. False when there is a newer offer; the taker then retires the old one.
  bool put_back(T* object) noexcept {
    T* none = nullptr;
    return offered_.compare_exchange_strong(none, object, std::memory_order_acq_rel);
  }
  void retire(T* object) noexcept {
    object->retired_before = retired_.load(std::memory_order_relaxed);
    while (!retired_.compare_exchange_weak(object->retired_before, object, std::memory_order_acq_rel)) {
    }
  }

 private:
  void free_retired() {
    T* object = retired_.exchange(nullptr, std::memory_order_acq_rel);
    while (object != nullptr) {
      const std::unique_ptr<T> done(object);
      object = done->retired_before;
    }
  }

  std::atomic<T*> offered_{nullptr};
  std::atomic<T*> retired_{nullptr};  // a list
};

}  // namespace tegotae
