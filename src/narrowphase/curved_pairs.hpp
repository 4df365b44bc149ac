#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "narrowphase/curved_lanes.hpp"
#include "narrowphase/patch_separate.hpp"
#include "narrowphase/profile_tree.hpp"

namespace tegotae {

/// An axis of A and one of B whose surfaces can be told apart about them: both with the same rise.
struct AxisPair {
  std::shared_ptr<const ProfileTree> a, b;
};
/// Most axis pairs of a pair of parts.
inline constexpr std::size_t kMaxAxisPairs = 4;

/// The curved pairs of a PatchFront: pairs of nodes that are kept apart in the profile coordinates of a common axis. No
/// call but the constructor allocates.
class CurvedPairs {
 public:
  /// A pair that is apart about an axis pair.
  struct Found {
    std::uint32_t axis;
    CurvedChoice choice;
  };
  static constexpr std::uint32_t kNobody = 0xffffffffu;

  /// Room for `capacity` pairs about each of `axes` axis pairs.
  CurvedPairs(std::uint32_t capacity, std::size_t axes);

  /// Starts over with these axis pairs (as many as there is room for; null for none), which must outlive the use.
  void attach(const std::vector<AxisPair>* axes) noexcept;
  /// A motion of `a` (with its center of mass `center_A`, m, file frame) past `b`.
  void begin(const PatchTree& a, const Vec3& center_A, const PatchTree& b, const Sweep& sweep) noexcept;

  /// Whether the nodes stay more than `spare` (m) beyond the clearance apart about one of the axes.
  std::optional<Found> separate(std::uint32_t node_a, std::uint32_t node_b, double spare) const noexcept;

  /// Where both nodes have boxes about the axis of a thread, and one of them is more than a piece of one flank: whether
  /// A's is the thicker one, so that it should be taken apart.
  std::optional<bool> thicker(std::uint32_t node_a, std::uint32_t node_b) const noexcept;
  bool full(std::uint32_t axis) const { return groups_[axis].count == capacity_; }
  /// Adds the pair `owner`, for which there must be room; its slot.
  std::uint32_t enter(const Found& found, std::uint32_t node_a, std::uint32_t node_b, std::uint32_t owner) noexcept;
  /// Writes another choice for a pair that is there.
  void renew(const Found& found, std::uint32_t slot, std::uint32_t node_a, std::uint32_t node_b) noexcept;
  /// Removes a pair; the owner whose slot becomes `slot`, or kNobody.
  std::uint32_t leave(std::uint32_t axis, std::uint32_t slot) noexcept;

  /// Owners of the pairs that the motion of begin() may bring together, to `failed`; returns how many.
  std::size_t collect_failures(std::uint32_t* failed) noexcept;

  std::uint32_t count() const { return count_; }
  /// Whether pairs are kept apart about the axis of a thread.
  bool in_thread() const noexcept;
  std::uint32_t owner(std::uint32_t i) const;  ///< of the i-th of count()
  template <typename F>
  void for_each(F f) const {
    for (const Group& g : groups_)
      for (std::uint32_t i = 0; i < g.count; ++i) f(g.owner[i]);
  }

 private:
  struct Group {
    CurvedBlocks lanes;
    std::vector<std::uint32_t> owner;
    std::uint32_t count;
    AxisMotion motion;
    bool flipped;  ///< A's axis runs against B's, and its frame is taken turned by half a turn
  };

  void write(Group& g, std::uint32_t axis, std::uint32_t slot, const CurvedChoice& choice, std::uint32_t node_a,
             std::uint32_t node_b) noexcept;

  std::uint32_t capacity_;
  std::vector<Group> groups_;
  const std::vector<AxisPair>* axes_ = nullptr;
  std::uint32_t used_ = 0;  ///< groups in use
  std::uint32_t count_ = 0;
};

}  // namespace tegotae
