#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tegotae {

/// Questions that were asked since the last forget(), so that none is asked twice for the same answer. Of two that fall
/// on one place the first is forgotten: it may be asked again. Allocates only when it is made.
class Asked {
 public:
  /// What is asked about which two things; the caller numbers them.
  struct Question {
    std::uint64_t what, a, b;
  };

  Asked() : places_(kPlaces) {}

  void forget() noexcept { ++now_; }
  /// Whether it was asked before; it counts as asked from now on.
  bool again(const Question& q) noexcept {
    std::uint64_t h = (q.what * 0x165667b19e3779f9ull) ^ (q.a * 0x9e3779b97f4a7c15ull) ^ (q.b * 0xc2b2ae3d27d4eb4full);
    h ^= h >> 29;
    Place& place = places_[static_cast<std::size_t>(h) & (kPlaces - 1)];
    if (place.at == now_ && place.q.what == q.what && place.q.a == q.a && place.q.b == q.b) return true;
    place = {q, now_};
    return false;
  }

 private:
  static constexpr std::size_t kPlaces = 1024;
  struct Place {
    Question q;
    std::uint64_t at;  ///< the count of forget() that it is of
  };
  std::vector<Place> places_;
  std::uint64_t now_ = 1;
};

}  // namespace tegotae
