#pragma once

#include <cstddef>

namespace tegotae {

/// Calls for `size` bytes that are read soon.
inline void prefetch(const void* from, std::size_t size) noexcept {
  constexpr std::size_t kLineBytes = 64;
  for (std::size_t k = 0; k < size; k += kLineBytes) __builtin_prefetch(static_cast<const char*>(from) + k);
}

/// The same for a whole object.
template <typename T>
void prefetch(const T& what) noexcept {
  prefetch(&what, sizeof(T));
}

}  // namespace tegotae
