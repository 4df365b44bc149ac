#include "narrowphase/face_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

/// Bits of a place along each axis, sorted by one at a time.
constexpr unsigned kPlaceBits = 11;
constexpr std::uint32_t kPlaces = 1u << kPlaceBits;
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
  std::uint64_t place;
  std::array<float, 3> middle;
  std::uint32_t face;
};

/// Sorts by the places, digit by digit.
void sort_by_place(std::vector<Placed>& faces) {
  std::vector<Placed> sorted(faces.size());
  for (unsigned shift = 0; shift < 3 * kPlaceBits; shift += kPlaceBits) {
    std::vector<std::size_t> first(kPlaces + 1, 0);
    for (const Placed& f : faces) ++first[(f.place >> shift) % kPlaces + 1];
    for (std::size_t i = 1; i <= kPlaces; ++i) first[i] += first[i - 1];
    for (const Placed& f : faces) sorted[first[(f.place >> shift) % kPlaces]++] = f;
    faces.swap(sorted);
  }
}

/// Halves the faces across their longest extent, over and over, down to whole blocks.
void halve(Placed* faces, std::size_t count) {
  if (count <= kBlockFaces) return;
  std::array<float, 3> low = faces[0].middle, high = low;
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], faces[i].middle[k]);
      high[k] = std::max(high[k], faces[i].middle[k]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  const std::size_t blocks = (count + kBlockFaces - 1) / kBlockFaces, half = (blocks + 1) / 2 * kBlockFaces;
  std::nth_element(faces, faces + half, faces + count,
                   [axis](const Placed& a, const Placed& b) { return a.middle[axis] < b.middle[axis]; });
  halve(faces, half);
  halve(faces + half, count - half);
}

/// Faces that are beside each other one after the other: along a curve that fills space, and within each stretch of it,
/// which may jump, by halves. Halves alone take five times as long for a million, and the curve alone makes blocks that
/// overlap three times as many others.
std::vector<std::uint32_t> beside_each_other(const PatchTree& tree) {
  const auto count = static_cast<std::uint32_t>(tree.mesh().triangles.size());
  const double scale = 0.5 * (kPlaces - 1) / std::max(tree.radius(), std::numeric_limits<double>::min());
  std::vector<Placed> placed(count);
  for (std::uint32_t f = 0; f < count; ++f) {
    const Vec3 middle = (tree.corner(f, 0) + tree.corner(f, 1) + tree.corner(f, 2)) / 3 - tree.origin();
    placed[f] = {0, {}, f};
    for (int i = 0; i < 3; ++i) {
      const double at = std::clamp(scale * (middle[i] + tree.radius()), 0.0, kPlaces - 1.0);
      placed[f].place |= spread(static_cast<std::uint64_t>(at)) << i;
      placed[f].middle[static_cast<std::size_t>(i)] = static_cast<float>(middle[i]);
    }
  }
  sort_by_place(placed);
  for (std::size_t first = 0; first < count; first += kStretch)
    halve(placed.data() + first, std::min(kStretch, count - first));
  std::vector<std::uint32_t> order(count);
  std::transform(placed.begin(), placed.end(), order.begin(), [](const Placed& p) { return p.face; });
  return order;
}

typedef float Lane __attribute__((vector_size(BoxLanes::kBoxes * sizeof(float)), may_alias));
typedef std::int32_t LaneBits __attribute__((vector_size(BoxLanes::kBoxes * sizeof(float)), may_alias));

TEGOTAE_WIDE std::uint32_t overlap(const BoxLanes& boxes, const AxisBox& box) {
  LaneBits all = LaneBits{1, 2, 4, 8, 16, 32, 64, 128};
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane low = *reinterpret_cast<const Lane*>(boxes.low[i].data());
    const Lane high = *reinterpret_cast<const Lane*>(boxes.high[i].data());
    all &= (LaneBits)(low <= box.high[i]) & (LaneBits)(high >= box.low[i]);
  }
  std::array<std::uint64_t, BoxLanes::kBoxes / 2> in_pairs;
  std::memcpy(in_pairs.data(), &all, sizeof all);
  const std::uint64_t pair = in_pairs[0] | in_pairs[1] | in_pairs[2] | in_pairs[3];
  return static_cast<std::uint32_t>(pair | pair >> 32);
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

FaceBlocks::FaceBlocks(const PatchTree& tree) : order_(beside_each_other(tree)) {
  std::vector<AxisBox> boxes((order_.size() + kBlockFaces - 1) / kBlockFaces, AxisBox::empty());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 corner = tree.corner(order_[i], k) - tree.origin();
      boxes[i / kBlockFaces].add(corner, corner);
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

std::uint32_t FaceBlocks::faces(std::uint32_t block) const {
  return std::min(kBlockFaces, static_cast<std::uint32_t>(order_.size()) - block * kBlockFaces);
}

std::uint32_t BoxLanes::overlapping(const AxisBox& box) const noexcept {
  return overlap(*this, box);
}

void BlockWalk::start(const FaceBlocks& blocks, const AxisBox& box) {
  blocks_ = &blocks;
  box_ = box;
  stacked_ = 0;
  const std::uint32_t top = blocks.levels() - 1;
  if (blocks.box(top, 0).overlaps(box)) stack_[stacked_++] = {top, 0};
}

std::uint32_t BlockWalk::next(std::uint32_t* out, std::uint32_t most) {
  std::uint32_t found = 0;
  while (stacked_ > 0 && found < most) {
    const Node node = stack_[--stacked_];
    if (node.level == 0) {
      out[found++] = node.index;
      continue;
    }
    std::uint32_t bits = blocks_->boxes_below(node.level - 1, node.index).overlapping(box_);
    for (std::uint32_t i = FaceBlocks::kFan * node.index; bits != 0; ++i, bits >>= 1)
      if ((bits & 1) != 0) stack_[stacked_++] = {node.level - 1, i};
  }
  return found;
}

}  // namespace tegotae
