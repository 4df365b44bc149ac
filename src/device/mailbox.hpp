#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "tegotae/device/shm.h"

namespace tegotae {

/// A slot as in shm.h between two threads of this process: one writer, nobody waits, no read is torn.
template <class Payload>
class Mailbox {
  static_assert(std::is_trivially_copyable_v<Payload> && sizeof(Payload) % sizeof(std::uint64_t) == 0);

 public:
  void write(const Payload& payload) noexcept { tegotae_shm_write(&counter_, words_, &payload, sizeof payload); }
  /// False, and `payload` untouched, before the first write.
  bool read(Payload& payload) const noexcept {
    Payload whole;
    if (tegotae_shm_read(&counter_, words_, &whole, sizeof whole) == 0) return false;
    payload = whole;
    return true;
  }

 private:
  alignas(64) std::uint64_t counter_ = 0;
  std::uint64_t words_[sizeof(Payload) / sizeof(std::uint64_t)] = {};
};

}  // namespace tegotae
