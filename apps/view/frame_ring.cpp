#include "view/frame_ring.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace tegotae::view {
namespace {

// A tenth of a second at 1 kHz; readers come by every 30 ms.
constexpr std::uint64_t kSlots = 128;
constexpr std::size_t kHeadBytes = offsetof(Frame, pairs);

static_assert(std::is_trivially_copyable_v<Frame>);
static_assert(kHeadBytes % sizeof(std::uint64_t) == 0 && sizeof(FramePair) % sizeof(std::uint64_t) == 0);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

}  // namespace

/// A seqlock, like those of shared memory (tegotae/device/shm.h says why it is enough): `state` is twice the number of
/// the frame plus 2 when the frame is complete, and odd while it is written.
struct FrameRing::Slot {
  std::atomic<std::uint64_t> state{0};
  std::atomic<std::uint64_t> words[sizeof(Frame) / sizeof(std::uint64_t)] = {};
};

void FrameRing::SlotsDeleter::operator()(Slot* slots) const {
  delete[] slots;
}

FrameRing::FrameRing() : slots_(new Slot[kSlots]) {}

namespace {

template <typename Words>
void put(Words& words, const Frame& frame, std::size_t from, std::size_t to) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(&frame);
  for (std::size_t at = from; at < to; at += sizeof(std::uint64_t)) {
    std::uint64_t word;
    std::memcpy(&word, bytes + at, sizeof word);
    words[at / sizeof word].store(word, std::memory_order_release);
  }
}

template <typename Words>
void get(const Words& words, Frame& frame, std::size_t from, std::size_t to) {
  auto* bytes = reinterpret_cast<unsigned char*>(&frame);
  for (std::size_t at = from; at < to; at += sizeof(std::uint64_t)) {
    const std::uint64_t word = words[at / sizeof(std::uint64_t)].load(std::memory_order_acquire);
    std::memcpy(bytes + at, &word, sizeof word);
  }
}

std::size_t used_bytes(const Frame& frame) {
  return kHeadBytes + std::min<std::size_t>(frame.pair_count, kMaxPairs) * sizeof(FramePair);
}

}  // namespace

void FrameRing::push(const Frame& frame) noexcept {
  const std::uint64_t number = written_.load(std::memory_order_relaxed);
  Slot& slot = slots_[number % kSlots];
  slot.state.store(2 * number + 1, std::memory_order_relaxed);
  put(slot.words, frame, 0, used_bytes(frame));
  slot.state.store(2 * number + 2, std::memory_order_release);
  written_.store(number + 1, std::memory_order_release);
}

FrameRing::Cursor FrameRing::newest() const noexcept {
  const std::uint64_t written = written_.load(std::memory_order_acquire);
  return written == 0 ? 0 : written - 1;
}

bool FrameRing::read(Cursor& cursor, Frame& frame, std::uint64_t& missed) const noexcept {
  for (;;) {
    const std::uint64_t written = written_.load(std::memory_order_acquire);
    if (cursor >= written) return false;
    if (written - cursor > kSlots) {
      missed += written - kSlots - cursor;
      cursor = written - kSlots;
    }
    const Slot& slot = slots_[cursor % kSlots];
    const std::uint64_t whole = 2 * cursor + 2;
    if (slot.state.load(std::memory_order_acquire) == whole) {
      get(slot.words, frame, 0, kHeadBytes);
      // A count from a frame that is being overwritten may be anything; the second look at `state` throws it away.
      get(slot.words, frame, kHeadBytes, used_bytes(frame));
      if (slot.state.load(std::memory_order_acquire) == whole) {
        ++cursor;
        return true;
      }
    }
    ++missed;
    ++cursor;
  }
}

}  // namespace tegotae::view
