#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Pose to which a mouse or a test leads the hand of a simulated pen. One thread sets it, the servo's thread reads it,
/// and neither waits for the other.
class InputGuide {
 public:
  /// Makes the hand carry the held part's file frame to `hand` (X_WF, world), as fast as a hand can. Only one thread
  /// may call it.
  void lead(const Pose& hand) noexcept;
  /// Reads into `hand` the pose to which the hand is led. Returns false, and leaves `hand` unchanged, before the first
  /// lead().
  bool target(Pose& hand) const noexcept;

 private:
  static constexpr int kWords = 7;
  std::uint64_t counter_ = 0;
  std::uint64_t slot_[kWords] = {};
};

}  // namespace tegotae
