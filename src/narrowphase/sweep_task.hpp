#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include "narrowphase/backing.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae {

/// A share of a motion that several threads make less, and what made it so.
class SharedLimit {
 public:
  struct Value {
    double share;
    bool early;  ///< not since something was met
  };

  void set(const Value& value) noexcept { bits_.store(bits(value)); }
  void lower(const Value& value) noexcept {
    // Numbers that are not negative are in order as their bits are.
    const std::uint64_t to = bits(value);
    std::uint64_t now = bits_.load();
    while (to < now && !bits_.compare_exchange_weak(now, to)) {
    }
  }
  Value value() const noexcept {
    const std::uint64_t now = bits_.load();
    const std::uint64_t rounded = now & ~std::uint64_t{1};
    Value out{0, (now & 1) != 0};
    std::memcpy(&out.share, &rounded, sizeof out.share);
    return out;
  }

 private:
  /// The last bit of the share is what made it.
  static std::uint64_t bits(const Value& value) noexcept {
    std::uint64_t out;
    std::memcpy(&out, &value.share, sizeof out);
    return (out & ~std::uint64_t{1}) | (value.early ? 1 : 0);
  }

  std::atomic<std::uint64_t> bits_{0};
};

/// One step of a look at all faces of A: how, at which faces, and past which part. It has pieces, which any number of
/// threads take and do, each with a SweepWorker of its own. Whoever finds none left does what others have not finished,
/// so that nobody has to be waited for. One thread owns it: it alone opens it, and only while no other is inside.
class SweepTask {
 public:
  /// What is done, one after the other: a few of A's faces tell about how far the motion goes, then whole blocks and
  /// the faces of those that are not enough, or all faces.
  enum class Look : std::uint8_t { sample, blocks, faces };
  /// Of A drawn out what is looked at, one after the other: nothing may meet it, and it never recedes. Then A's faces.
  enum class Layer : std::uint8_t { walls, moved_faces, faces };
  /// What ends it before all is done: too many blocks are not enough, or A is not solid where it was drawn out.
  enum class Ending : std::uint8_t { none, many_faces, not_solid };

  struct Question {
    Pose X;
    Displacement d;
    double clearance = 0, kept = 0, kept_far = 0, far = 0;  ///< m, see SweepAim
    double worth = 0;                                       ///< as a share of the motion
    Look look = Look::sample;
    Layer layer = Layer::faces;
    std::optional<Backing::Side> drawn;
    std::uint32_t part = 0;
    bool outside = false;  ///< nothing of the part is inside A: what recedes need not be looked at
    std::uint32_t pieces = 0;
  };
  /// Faces that met, and the share of the motion where they do.
  struct Met {
    double share;
    std::uint32_t a, b;
  };
  static constexpr std::size_t kMostMet = 32;

  /// It has at most so many pieces.
  explicit SweepTask(std::size_t pieces) : done_(pieces) {}

  /// Owner: another question, with the shares until now and the blocks that were looked at face by face.
  void open(const Question& question, const SharedLimit::Value& end, const SharedLimit::Value& faces_end,
            std::uint32_t searched) noexcept;
  /// Owner: whoever is at it is to leave.
  void close() noexcept { closed_.store(true); }
  /// Owner: whether nobody else is inside.
  bool is_empty() const noexcept { return inside_.load() == 0; }
  /// Another thread, before it reads anything, and before it does not any more.
  void enter() noexcept { inside_.fetch_add(1); }
  void leave() noexcept { inside_.fetch_sub(1); }

  const Question& question() const noexcept { return question_; }
  /// Of this question and no other.
  std::uint64_t id() const noexcept { return id_; }

  /// A piece to do; none: all are done.
  std::optional<std::uint32_t> take() noexcept;
  /// Of the pieces those that were taken, as a share.
  double taken() const noexcept {
    return question_.pieces == 0 ? 1 : std::min(1.0, static_cast<double>(next_.load()) / question_.pieces);
  }
  bool is_done(std::uint32_t piece) const noexcept { return done_[piece].load(std::memory_order_acquire) != 0; }
  void finish(std::uint32_t piece) noexcept { done_[piece].store(1, std::memory_order_release); }
  /// Whether there is no use in going on.
  bool is_over() const noexcept {
    return closed_.load(std::memory_order_relaxed) || ending() != Ending::none || !(end.value().share > 0);
  }
  Ending ending() const noexcept { return ending_.load(); }
  void end_with(Ending ending) noexcept { ending_.store(ending); }

  void add_met(const Met& met) noexcept;
  /// Owner, when there is no piece to do: what was met, the nearest first. How many there are.
  std::size_t met(std::array<Met, kMostMet>& out) const noexcept;

  SharedLimit end;                         ///< of what is free; early: not since something was met
  SharedLimit faces_end;                   ///< the same of what faces have left
  std::atomic<std::uint32_t> searched{0};  ///< blocks of A, face by face, while whole ones were looked at

 private:
  Question question_;
  std::uint64_t id_ = 0;
  std::atomic<std::uint32_t> inside_{0}, next_{0}, met_{0};
  std::atomic<bool> closed_{true};
  std::atomic<Ending> ending_{Ending::none};
  std::vector<std::atomic<std::uint8_t>> done_;
  std::array<std::atomic<std::uint64_t>, kMostMet> met_faces_{};
  std::array<std::atomic<double>, kMostMet> met_share_{};
};

}  // namespace tegotae
