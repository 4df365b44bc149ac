#include "narrowphase/face_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/block_order.hpp"
#include "narrowphase/box_overlap.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

/// Bits of a place along each axis, sorted by one at a time.
constexpr unsigned kPlaceBits = 11;
constexpr std::uint32_t kPlaces = 1u << kPlaceBits;
/// Kinds of faces by size, each this many times as long as the last.
constexpr std::uint64_t kSizes = 8;
constexpr double kLonger = 4;
/// Faces that look the other way than most, or than one of them where there is no such way, by these cosines.
constexpr float kOneWay = 0.4F, kOtherWay = -0.2F;
/// A block has fewer faces than there is room for where more would make it longer than so many times the root of their
/// squared lengths,
constexpr float kLongest = 2;
/// where they lie in layers that are farther apart than their normals tell, with this share of its length besides,
constexpr float kLayers = 0.02F;
/// and where a quarter of them or more look in one of a few directions, exact to this share of what all are, which is
/// no less than so much.
constexpr float kOneOfFew = 0.3F, kFewDirections = 0.2F;
/// Where they turn along the other axes, they are parted along one that is at least this share of the longest.
constexpr float kDrawnOut = 0.3F;
/// A difference of depths that is none, as a share of the longest, and the share of the spread of normals that the
/// place has to tell.
constexpr float kFlat = 1e-4F, kTold = 0.2F;
/// Faces of a stretch of the curve.
constexpr std::size_t kStretch = 256 * std::size_t{kBlockFaces};

/// The bits of `x` with two zeros between each and the next (Morton, 1966).
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

struct Placed {
  std::uint64_t place;  ///< along the curve, after the size
  std::array<float, 3> middle, normal;
  float length2;  ///< of the longest edge
  std::uint32_t face;
};

/// Sorts by the places, digit by digit.
void sort_by_place(std::vector<Placed>& faces) {
  std::vector<Placed> sorted(faces.size());
  for (unsigned shift = 0; shift < 4 * kPlaceBits; shift += kPlaceBits) {
    std::vector<std::size_t> first(kPlaces + 1, 0);
    for (const Placed& f : faces) ++first[(f.place >> shift) % kPlaces + 1];
    for (std::size_t i = 1; i <= kPlaces; ++i) first[i] += first[i - 1];
    for (const Placed& f : faces) sorted[first[(f.place >> shift) % kPlaces]++] = f;
    faces.swap(sorted);
  }
}

/// Of the length of its longest edge, the longest first.
std::uint64_t size_class(double length2, double size) {
  const double shorter = std::log(std::max(size * size / length2, 1.0)) / (2 * std::log(kLonger));
  return static_cast<std::uint64_t>(std::min(shorter, kSizes - 1.0));
}

float dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct Extent {
  std::array<float, 3> low, high;
  std::size_t longest = 0;
  float diagonal2 = 0, lengths2 = 0;
};

Extent extent_of(const Placed* faces, std::size_t count) {
  Extent e{faces[0].middle, faces[0].middle};
  for (std::size_t i = 0; i < count; ++i) {
    e.lengths2 += faces[i].length2;
    for (std::size_t k = 0; k < 3; ++k) {
      e.low[k] = std::min(e.low[k], faces[i].middle[k]);
      e.high[k] = std::max(e.high[k], faces[i].middle[k]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const float length = e.high[k] - e.low[k];
    e.diagonal2 += length * length;
    if (length > e.high[e.longest] - e.low[e.longest]) e.longest = k;
  }
  return e;
}

/// The mean direction of faces, and what it lacks of unit length, as the sine of how far they are off it.
struct Way {
  std::array<float, 3> mean;
  float length, spread;
};

Way way_of(const Placed* faces, std::size_t count) {
  Way way{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) way.mean[k] += faces[i].normal[k];
  for (float& x : way.mean) x /= static_cast<float>(count);
  way.length = std::sqrt(dot(way.mean, way.mean));
  way.spread = std::sqrt(std::max(0.0F, 1 - way.length * way.length));
  return way;
}

/// The axis along which faces are parted so that the halves are flat: along which they bend most over its length, or
/// the longest. By how much normals turn with the place along each (least squares).
std::size_t axis_to_part(const Placed* faces, std::size_t count, const Extent& e, const Way& way) {
  std::size_t best = e.longest;
  const float longest = e.high[e.longest] - e.low[e.longest];
  float deepest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float length = e.high[k] - e.low[k];
    if (length < kDrawnOut * longest) continue;
    const float middle = 0.5F * (e.low[k] + e.high[k]);
    std::array<float, 3> turns{};
    float places2 = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const float at = faces[i].middle[k] - middle;
      places2 += at * at;
      for (std::size_t c = 0; c < 3; ++c) turns[c] += at * (faces[i].normal[c] - way.mean[c]);
    }
    if (!(places2 > 0)) continue;
    // Of noise, as much as chance tells.
    const float told = dot(turns, turns) / (places2 * static_cast<float>(count) * way.spread * way.spread);
    const float depth = std::sqrt(dot(turns, turns)) / places2 * length * length;
    if (told > kTold && depth > deepest + kFlat * longest) {
      deepest = depth;
      best = k;
    }
  }
  return best;
}

/// The normal of the face that looks least in a direction.
std::array<float, 3> farthest_from(const Placed* faces, std::size_t count, const std::array<float, 3>& n) {
  return std::min_element(faces, faces + count,
                          [&](const Placed& a, const Placed& b) { return dot(a.normal, n) < dot(b.normal, n); })
      ->normal;
}

/// Where faces look the other way than others, those come last; returns how many come first.
std::size_t part_by_side(Placed* faces, std::size_t count, Way way) {
  if (way.length < kOneWay) way.mean = farthest_from(faces, count, faces[0].normal);
  const auto along = [&](const Placed& f) { return dot(f.normal, way.mean); };
  if (std::none_of(faces, faces + count, [&](const Placed& f) { return along(f) < kOtherWay; })) return count;
  return static_cast<std::size_t>(std::partition(faces, faces + count, [&](const Placed& f) { return along(f) >= 0; }) -
                                  faces);
}

/// The same where the faces of a block look in a few directions.
std::size_t part_by_direction(Placed* faces, std::size_t count, const Way& way) {
  if (way.spread < kFewDirections) return count;
  const std::array<float, 3> one = farthest_from(faces, count, way.mean), other = farthest_from(faces, count, one);
  const auto half = static_cast<std::size_t>(
      std::partition(faces, faces + count,
                     [&](const Placed& f) { return dot(f.normal, one) >= dot(f.normal, other); }) -
      faces);
  const auto is_one = [&](const Placed* first, std::size_t n) {
    return 4 * n >= count && way_of(first, n).spread < kOneOfFew * way.spread;
  };
  return is_one(faces, half) || is_one(faces + half, count - half) ? half : count;
}

/// The same where they lie in layers.
std::size_t part_by_layer(Placed* faces, std::size_t count, const Way& way, float diagonal) {
  const auto depth = [&](const Placed& f) { return dot(f.middle, way.mean); };
  std::sort(faces, faces + count, [&](const Placed& a, const Placed& b) { return depth(a) < depth(b); });
  if (!(depth(faces[count - 1]) - depth(faces[0]) > (way.spread + kLayers) * way.length * diagonal)) return count;
  std::size_t half = 1;
  for (std::size_t i = 2; i < count; ++i)
    if (depth(faces[i]) - depth(faces[i - 1]) > depth(faces[half]) - depth(faces[half - 1])) half = i;
  return half;
}

/// How many faces come first where they are no block, in an order in which they are parted: by the side that they look
/// to, and in the middle of their longest extent.
std::size_t part(Placed* faces, std::size_t count) {
  if (count == 1) return 1;
  const Way way = way_of(faces, count);
  std::size_t half = part_by_side(faces, count, way);
  if (half < count) return half;
  const Extent e = extent_of(faces, count);
  if (count <= kBlockFaces) {
    half = part_by_direction(faces, count, way);
    if (half == count) half = part_by_layer(faces, count, way, std::sqrt(e.diagonal2));
    if (half < count || e.diagonal2 < kLongest * kLongest * e.lengths2) return half;
  }
  const std::size_t blocks = (count + kBlockFaces - 1) / kBlockFaces;
  half = blocks == 1 ? (count + 1) / 2 : (blocks + 1) / 2 * kBlockFaces;
  std::nth_element(faces, faces + half, faces + count,
                   [axis = axis_to_part(faces, count, e, way)](const Placed& a, const Placed& b) {
                     return a.middle[axis] < b.middle[axis];
                   });
  return half;
}

/// Puts faces that are near each other in order, block after block. `begins` with the number of faces before them.
void arrange(Placed* faces, std::size_t count, std::uint32_t begins, std::vector<std::uint32_t>& first_of_blocks) {
  const std::size_t half = part(faces, count);
  if (half == count) {
    first_of_blocks.push_back(begins);
    return;
  }
  arrange(faces, half, begins, first_of_blocks);
  arrange(faces + half, count - half, begins + static_cast<std::uint32_t>(half), first_of_blocks);
}

/// Faces that are beside each other one after the other: size by size along a curve that fills space, and within each
/// stretch of it, which may jump, by halves. Halves alone take five times as long for a million, and the curve alone
/// makes blocks that overlap three times as many others.
std::vector<Placed> beside_each_other(const PatchTree& tree) {
  const auto count = static_cast<std::uint32_t>(tree.mesh().triangles.size());
  const double size = std::max(tree.radius(), std::numeric_limits<double>::min());
  std::vector<Placed> placed(count);
  for (std::uint32_t f = 0; f < count; ++f) {
    const Vec3 &p = tree.corner(f, 0), &q = tree.corner(f, 1), &r = tree.corner(f, 2);
    const Vec3 middle = (p + q + r) / 3 - tree.origin(), normal = (q - p).cross(r - p).stableNormalized();
    const double length2 = std::max({(q - p).squaredNorm(), (r - p).squaredNorm(), (r - q).squaredNorm()});
    placed[f] = {size_class(length2, size) << (3 * kPlaceBits), {}, {}, static_cast<float>(length2), f};
    for (int i = 0; i < 3; ++i) {
      const double at = std::clamp(0.5 * (kPlaces - 1) / size * (middle[i] + size), 0.0, kPlaces - 1.0);
      placed[f].place |= spread(static_cast<std::uint64_t>(at)) << i;
      placed[f].middle[static_cast<std::size_t>(i)] = static_cast<float>(middle[i]);
      placed[f].normal[static_cast<std::size_t>(i)] = static_cast<float>(normal[i]);
    }
  }
  sort_by_place(placed);
  return placed;
}

BlockPlace place_of(const Placed* faces, std::size_t count) {
  const Extent e = extent_of(faces, count);
  BlockPlace place{{}, way_of(faces, count).mean, std::sqrt(e.diagonal2)};
  for (std::size_t k = 0; k < 3; ++k) place.middle[k] = 0.5F * (e.low[k] + e.high[k]);
  for (std::size_t i = 0; i < count; ++i) place.size = std::max(place.size, std::sqrt(faces[i].length2));
  return place;
}

/// The faces, block after block in an order for nodes over them; `first` of each block is put in it as well.
std::vector<std::uint32_t> in_order(const std::vector<Placed>& placed, std::vector<std::uint32_t>& first) {
  std::vector<BlockPlace> places;
  for (std::size_t block = 0; block + 1 < first.size(); ++block)
    places.push_back(place_of(placed.data() + first[block], first[block + 1] - first[block]));
  std::vector<std::uint32_t> faces, first_in_order;
  for (const std::uint32_t block : order_by_nodes(places, FaceBlocks::kFan)) {
    first_in_order.push_back(static_cast<std::uint32_t>(faces.size()));
    for (std::uint32_t i = first[block]; i < first[block + 1]; ++i) faces.push_back(placed[i].face);
  }
  first_in_order.push_back(first.back());
  first.swap(first_in_order);
  return faces;
}

/// BlockWalk::next().
TEGOTAE_WIDE std::uint32_t next_of(const FaceBlocks& blocks, const AxisBox& box, std::uint32_t level,
                                   BlockWalk::Node* stack, std::uint32_t& stacked, std::uint32_t* out,
                                   std::uint32_t most) {
  std::uint32_t found = 0;
  while (stacked > 0 && found < most) {
    const BlockWalk::Node node = stack[--stacked];
    if (node.level == level) {
      out[found++] = node.index;
      continue;
    }
    std::uint32_t bits = overlap(blocks.boxes_below(node.level - 1, node.index), box);
    const bool told = node.level - 1 == level && found + FaceBlocks::kFan <= most;
    for (; bits != 0; bits &= bits - 1) {
      const std::uint32_t i = FaceBlocks::kFan * node.index + static_cast<std::uint32_t>(__builtin_ctz(bits));
      if (told) {
        out[found++] = i;
      } else {
        stack[stacked++] = {node.level - 1, i};
      }
    }
  }
  return found;
}

}  // namespace

AxisBox AxisBox::empty() {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  return {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
}

void AxisBox::add(const Vec3& from, const Vec3& to) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    low[i] = std::min(low[i], std::nextafter(static_cast<float>(from[axis]), -kFar));
    high[i] = std::max(high[i], std::nextafter(static_cast<float>(to[axis]), kFar));
  }
}

void AxisBox::add(const AxisBox& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], other.low[i]);
    high[i] = std::max(high[i], other.high[i]);
  }
}

FaceBlocks::FaceBlocks(const PatchTree& tree) {
  std::vector<Placed> placed = beside_each_other(tree);
  const auto size = [&](std::size_t i) { return placed[i].place >> (3 * kPlaceBits); };
  for (std::size_t first = 0, end = 0; first < placed.size(); first = end) {
    while (end < placed.size() && end - first < kStretch && size(end) == size(first)) ++end;
    arrange(placed.data() + first, end - first, static_cast<std::uint32_t>(first), first_);
  }
  first_.push_back(static_cast<std::uint32_t>(placed.size()));
  order_ = in_order(placed, first_);
  std::vector<AxisBox> boxes(first_.size() - 1, AxisBox::empty());
  for (std::uint32_t block = 0; block < boxes.size(); ++block) {
    for (std::uint32_t i = first_[block]; i < first_[block + 1]; ++i) {
      for (int k = 0; k < 3; ++k) {
        const Vec3 corner = tree.corner(order_[i], k) - tree.origin();
        boxes[block].add(corner, corner);
      }
    }
  }
  levels_.push_back(level_of(boxes));
  while (boxes.size() > 1) {
    std::vector<AxisBox> above((boxes.size() + kFan - 1) / kFan, AxisBox::empty());
    for (std::size_t i = 0; i < boxes.size(); ++i) above[i / kFan].add(boxes[i]);
    boxes.swap(above);
    levels_.push_back(level_of(boxes));
  }
}

FaceBlocks::Level FaceBlocks::level_of(const std::vector<AxisBox>& boxes) {
  Level level{static_cast<std::uint32_t>(boxes.size()), std::vector<BoxLanes>((boxes.size() + kFan - 1) / kFan)};
  for (std::size_t n = 0; n < kFan * level.boxes.size(); ++n) {
    const AxisBox box = n < boxes.size() ? boxes[n] : AxisBox::empty();
    for (std::size_t i = 0; i < 3; ++i) {
      level.boxes[n / kFan].low[i][n % kFan] = box.low[i];
      level.boxes[n / kFan].high[i][n % kFan] = box.high[i];
    }
  }
  return level;
}

AxisBox FaceBlocks::box(std::uint32_t level, std::uint32_t node) const {
  const BoxLanes& lanes = levels_[level].boxes[node / kFan];
  AxisBox out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.low[i] = lanes.low[i][node % kFan];
    out.high[i] = lanes.high[i][node % kFan];
  }
  return out;
}

void BlockWalk::start(const FaceBlocks& blocks, const AxisBox& box, std::uint32_t level) {
  const std::uint32_t root = 0;
  start_under(&root, 1, blocks.levels() - 1, blocks, box, level);
}

void BlockWalk::start_under(const std::uint32_t* nodes, std::uint32_t count, std::uint32_t level_of_nodes,
                            const FaceBlocks& blocks, const AxisBox& box, std::uint32_t level) {
  blocks_ = &blocks;
  level_ = level;
  box_ = box;
  stacked_ = 0;
  for (std::uint32_t i = 0; i < count; ++i) stack_[stacked_++] = {level_of_nodes, nodes[i]};
}

std::uint32_t BlockWalk::next(std::uint32_t* out, std::uint32_t most) {
  return next_of(*blocks_, box_, level_, stack_.data(), stacked_, out, most);
}

}  // namespace tegotae
