#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "feature/simplex_distance.hpp"
#include "narrowphase/patch_tree.hpp"

namespace tegotae {

/// Of squared distances from a PatchNode: boxes are stored in single precision, their axes are unit vectors up to
/// rounding.
inline constexpr double kBoxRounding = 1 - 1e-5;

/// A nearest point of a surface; file frame.
struct NearFace {
  double squared = 0;          ///< distance, m²
  Vec3 point = Vec3::Zero();   ///< m
  std::uint32_t face = kNone;  ///< that has the point; kNone: no face was near enough
  unsigned mask = 0;           ///< corners of the face that carry the point (see ClosestPoints)
};

/// Nearest faces of a surface to points, by its hierarchy. Immutable.
class NearestFace {
 public:
  /// Takes O(triangles); copies share what it makes.
  NearestFace(std::shared_ptr<const Surface> surface, std::shared_ptr<const PatchTree> tree);

  const Surface& surface() const { return *surface_; }
  /// Whether find() looks at all of the hierarchy; of a deeper one it leaves out what lies deepest.
  bool complete() const;

  /// Replaces `best` by what is nearer to `p` among the faces that `wanted(face)` accepts. O(log triangles) where the
  /// surface is near; never allocates.
  template <typename Wanted>
  void find(const Vec3& p, NearFace& best, Wanted wanted) const noexcept {
    find(
        p, best, wanted, [](std::uint32_t) { return true; }, [](const NearFace&) { return false; });
  }
  /// Replaces `best` by what is nearer to `p` in the flat region of `face`. Where the region is not quite flat and `p`
  /// is over several of its faces, one of them.
  void find_in_region(const Vec3& p, std::uint32_t face, NearFace& best) const noexcept;
  /// Replaces `best` by the nearest point of one face if that is nearer.
  void try_face(const Vec3& p, std::uint32_t face, NearFace& best) const noexcept;

 private:
  static constexpr std::size_t kDeepest = 500;
  struct RegionRange {
    std::uint32_t first = kNone, last = 0;
  };
  static std::vector<RegionRange> regions_under(const Surface& surface, const PatchTree& tree);

  /// The same under the nodes that `enters(node)` accepts; ends with the first face that is near enough.
  template <typename Wanted, typename Enters, typename Enough>
  void find(const Vec3& p, NearFace& best, Wanted wanted, Enters enters, Enough enough) const noexcept {
    struct Entry {
      std::uint32_t node;
      double bound;
    };
    std::array<Entry, kDeepest + 2> stack;
    std::size_t top = 0;
    stack[top++] = {0, 0};
    while (top > 0) {
      const Entry e = stack[--top];
      if (e.bound >= best.squared) continue;
      const PatchNode& node = tree_->nodes()[e.node];
      if (node.leaf()) {
        for (std::uint32_t i = 0; i < node.count; ++i)
          if (const std::uint32_t face = tree_->order()[node.first + i]; wanted(face)) try_face(p, face, best);
        if (enough(best)) return;
        continue;
      }
      if (top + 2 > stack.size()) continue;
      const std::size_t before = top;
      for (const std::uint32_t child : {node.first, node.first + 1})
        if (enters(child)) stack[top++] = {child, squared_bound(p, tree_->nodes()[child])};
      // The nearer one on top.
      if (top - before == 2 && stack[before].bound <= stack[before + 1].bound)
        std::swap(stack[before], stack[before + 1]);
    }
  }
  double squared_bound(const Vec3& p, const PatchNode& node) const noexcept;

  std::shared_ptr<const Surface> surface_;
  std::shared_ptr<const PatchTree> tree_;
  /// The flat regions under each node: from the first to the last number.
  std::shared_ptr<const std::vector<RegionRange>> regions_;
};

}  // namespace tegotae
