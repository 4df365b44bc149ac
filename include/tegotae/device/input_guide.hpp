#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Where somebody (a mouse, a test) leads the hand of a simulated pen. One thread leads, the servo's looks; neither
/// waits for the other.
class InputGuide {
 public:
  /// The hand shall carry the held part's file frame to `hand`, as fast as a hand can.
  void lead(const Pose& hand) noexcept;
  /// Where the hand is led; false, and `hand` untouched, as long as nobody has led it.
  bool target(Pose& hand) const noexcept;

 private:
  static constexpr int kWords = 7;
  std::uint64_t counter_ = 0;
  std::uint64_t slot_[kWords] = {};
};

}  // namespace tegotae
