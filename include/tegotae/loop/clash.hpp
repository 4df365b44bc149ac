#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Relation of two parts.
enum class ClashKind : std::uint8_t {
  overlap,  ///< deeper than the tolerance, or the surfaces cross and neither is closed
  touch,    ///< a gap or an overlap of at most the tolerance
  near      ///< a gap of more than the tolerance
};

/// Two parts that touch, overlap or are near.
struct Clash {
  std::size_t a = 0;                 ///< index into Scene::parts, the smaller one
  std::size_t b = 0;                 ///< index into Scene::parts, the larger one
  ClashKind kind = ClashKind::near;  ///< by ClashOptions::tolerance
  double gap = 0;                    ///< m: distance of the surfaces; 0 when they intersect
  /// m: how far the deepest point found of one part lies inside the other, measured to the nearest point of that part's
  /// surface. 0 when they are apart; none when neither part is closed. The search takes all vertices. On each edge that
  /// crosses the other surface, it also takes the midpoints of the segments between crossings. So the result is a lower
  /// bound of the depth of the deepest point, exact where that is a vertex.
  std::optional<double> depth = 0;
  Vec3 place_W = Vec3::Zero();     ///< m, world: the deepest point, or the middle of the shortest gap
  std::size_t triangle_pairs = 0;  ///< pairs of triangles that intersect; those that touch count
};

/// Options of find_clashes().
struct ClashOptions {
  double tolerance = 10e-6;  ///< m: parts with a gap or an overlap of up to this touch
  double within = 0;         ///< m: pairs with a gap of up to this are listed too
  bool held_only = false;    ///< only the pairs of the held part
  /// Called with the number of checked pairs, and of all pairs of parts whose boxes are near; empty: no calls.
  std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Returns every pair of parts that touches, overlaps or is near: first the overlaps, deepest first, then the touching
/// pairs and the near ones, each by gap. It compares all parts, whether held or not. A part inside the closed surface
/// of another one overlaps it.
std::vector<Clash> find_clashes(const Scene& scene, const ClashOptions& options = {});

}  // namespace tegotae
