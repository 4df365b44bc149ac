#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "view/frame.hpp"

namespace tegotae::view {

/// Frames from one writer to any number of readers. The writer never waits, locks or allocates; a reader that is too
/// slow misses frames and knows how many.
class FrameRing {
 public:
  FrameRing();

  /// Only the one writer calls it.
  void push(const Frame& frame) noexcept;

  /// A reader's place: the number of the frame that it reads next.
  using Cursor = std::uint64_t;
  /// Where a new reader begins: at the newest frame, if there is one.
  Cursor newest() const noexcept;
  /// Reads the next frame; false when there is none yet. What the writer has overwritten is skipped and added to
  /// `missed`.
  bool read(Cursor& cursor, Frame& frame, std::uint64_t& missed) const noexcept;

 private:
  struct Slot;
  struct SlotsDeleter {
    void operator()(Slot* slots) const;
  };
  std::unique_ptr<Slot[], SlotsDeleter> slots_;
  std::atomic<std::uint64_t> written_{0};
};

}  // namespace tegotae::view
