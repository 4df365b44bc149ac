// Counts the heap allocations and frees of one thread, for tests that something does neither. Link
// tegotae_alloc_guard; the whole executable's malloc then passes through it.
#pragma once

#include <cstdint>

namespace tegotae::test {

/// While it lives, every malloc, calloc, realloc, aligned allocation, operator new and free of its thread is counted.
/// One at a time in a thread.
class AllocGuard {
 public:
  AllocGuard() noexcept;
  ~AllocGuard() noexcept;
  AllocGuard(const AllocGuard&) = delete;
  AllocGuard& operator=(const AllocGuard&) = delete;
  std::uint64_t count() const noexcept;
};

}  // namespace tegotae::test
