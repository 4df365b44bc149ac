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
  overlap,  ///< deeper than the tolerance, or crossing surfaces of which none is closed
  touch,    ///< a gap or an overlap of at most the tolerance
  near      ///< a gap of more than the tolerance
};

/// Two parts that touch, overlap or are near.
struct Clash {
  std::size_t a = 0;                 ///< index into Scene::parts, the smaller one
  std::size_t b = 0;                 ///< index into Scene::parts, the larger one
  ClashKind kind = ClashKind::near;  ///< by ClashOptions::tolerance
  double gap = 0;                    ///< m: distance of the surfaces; 0 when they intersect
  /// m: how far the deepest point found of one part lies inside the other, measured to the nearest point of its
  /// surface; 0 when they are apart, none when neither is closed. The search takes all vertices and, of the edges that
  /// cross the other surface, the midpoints of the segments between crossings. So this is a lower bound of the depth of
  /// the deepest point, exact where that is a vertex.
  std::optional<double> depth = 0;
  Vec3 place_W = Vec3::Zero();     ///< the deepest point, or the middle of the shortest gap, m
  std::size_t triangle_pairs = 0;  ///< pairs that intersect; triangles that touch count
};

/// Options of find_clashes().
struct ClashOptions {
  double tolerance = 10e-6;  ///< m: what counts as touching
  double within = 0;         ///< m: pairs apart by up to this are listed too
  bool held_only = false;    ///< only the pairs of the held part
  std::function<void(std::size_t done, std::size_t total)>
      progress;  ///< called with the number of checked pairs, and of all pairs of parts whose boxes are near
};

/// Returns every pair of parts that touches, overlaps or is near: first the overlaps, deepest first, then the others by
/// gap. It compares all parts, whether held or not. A part inside the closed surface of another overlaps it.
std::vector<Clash> find_clashes(const Scene& scene, const ClashOptions& options = {});

}  // namespace tegotae
