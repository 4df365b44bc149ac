#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace tegotae {

/// 128 bits that tell contents apart: those that differ by accident have different ones. Not cryptographic.
using ContentKey = std::array<std::uint64_t, 2>;

/// Sums bytes up (XXH3).
class ContentSum {
 public:
  ContentSum();
  ~ContentSum();
  ContentSum(const ContentSum&) = delete;
  ContentSum& operator=(const ContentSum&) = delete;

  void add(const void* data, std::size_t bytes) noexcept;
  /// The key of all bytes so far.
  ContentKey key() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tegotae
