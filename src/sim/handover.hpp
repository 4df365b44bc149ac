#pragma once

#include <atomic>
#include <memory>

namespace tegotae {

/// Hands objects made in any thread to one thread that never waits, allocates or frees. The newest offer counts; what
/// the taker is done with is freed by whoever offers next. `T` has a member `T* done_before`.
template <class T>
class Handover {
 public:
  Handover() = default;
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;
  ~Handover() {
    std::unique_ptr<T>(offered_.exchange(nullptr));
    free_done();
  }

  /// Any thread. An older offer that was not taken is dropped.
  void offer(std::unique_ptr<T> object) {
    free_done();
    std::unique_ptr<T>(offered_.exchange(object.release(), std::memory_order_acq_rel));
  }

  /// Any thread. Whether there was an offer to take back; one that the taker looks at is not there.
  bool withdraw() { return std::unique_ptr<T>(offered_.exchange(nullptr, std::memory_order_acq_rel)) != nullptr; }

  // The taker's thread.
  /// Null when there is no offer.
  T* take() noexcept {
    // A plain look first: most of the time there is nothing, and an exchange would take the cache line each time.
    if (offered_.load(std::memory_order_relaxed) == nullptr) return nullptr;
    return offered_.exchange(nullptr, std::memory_order_acq_rel);
  }
  /// Not yet: offers it again, unless there is a newer offer.
  void put_back(T* object) noexcept {
    T* none = nullptr;
    if (!offered_.compare_exchange_strong(none, object, std::memory_order_acq_rel)) done_with(object);
  }
  void done_with(T* object) noexcept {
    object->done_before = done_.load(std::memory_order_relaxed);
    while (!done_.compare_exchange_weak(object->done_before, object, std::memory_order_acq_rel)) {
    }
  }

 private:
  void free_done() {
    T* object = done_.exchange(nullptr, std::memory_order_acq_rel);
    while (object != nullptr) {
      const std::unique_ptr<T> done(object);
      object = done->done_before;
    }
  }

  std::atomic<T*> offered_{nullptr};
  std::atomic<T*> done_{nullptr};  // a list
};

}  // namespace tegotae
