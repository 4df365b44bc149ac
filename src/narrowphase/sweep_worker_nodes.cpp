// Whole nodes of A's hierarchy: whether they are apart from what is beside them without a look at their faces.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "narrowphase/sweep_worker.hpp"

namespace tegotae {
namespace {

/// What is free that blocks tell is taken a little shorter: they are looked at again.
constexpr double kShareKept = 0.999;
/// What whole blocks leave of a motion is enough where it is so much of what faces have left: less, the more blocks
/// were looked at face by face.
constexpr double kEnoughAtFirst = 0.98, kEnough = 0.85;
/// Few blocks of A: so many, and one of so many.
constexpr std::uint32_t kFewBlocks = 32, kBlocksShare = 24;
/// What is under a node of B is asked where it is so many times as large as that of A.
constexpr double kMuchLarger = 2;
constexpr std::uint32_t kNone = ~std::uint32_t{0};
/// Asking a block as a whole takes half of the time that its faces take, about.
constexpr std::uint32_t kSomeBlocks = 16;
constexpr double kToldShare = 0.5;
/// Where more than few were looked at face by face, and more than this share of those that the look has come past, all
/// are.
constexpr double kMost = 0.125;

}  // namespace

/// Of the blocks under A's node, those that are not told apart as a whole all at once.
void SweepWorker::push_blocks(const Node& node) {
  const std::uint32_t first = node.index * FaceBlocks::kFan;
  const std::uint32_t end = std::min(first + FaceBlocks::kFan, surface_a_->blocks.count());
  const Surface& b = surface_b();
  for (std::uint32_t i = 0; i < tops_[0].count; ++i) {
    prefetch(b.blocks.boxes_below(0, tops_[0].nodes[i]));
    prefetch(b.slabs.lanes(0, tops_[0].nodes[i]));
  }
  Placement from = sweep_.start, to = sweep_.end;
  from.t += from.R * offset_a_;
  to.t += to.R * offset_a_;
  const SlabLanes& lanes = surface_a_->slabs.lanes(0, node.index);
  MovedSlabs eight;
  eight.set(lanes, from, to);
  for (std::uint32_t block = first; block < end; ++block) {
    const std::uint32_t k = block - first;
    if (may_recede() && passing_.recedes(seen(cones().nodes[0][block]), lanes.middle(k) + offset_a_, lanes.radius(k)))
      continue;
    const SlabEnds ends = eight.slab(k);
    const std::uint32_t open = not_kept_apart_under(tops_[0].nodes.data(), tops_[0].count, 1, b.blocks, b.slabs, ends,
                                                    eight.origin, eight.box(k, floor_), floor_, found_.data(), kBeside);
    ++blocks_asked_;
    if (open == 0 || (open <= kBeside && apart_from_faces(block, ends, eight.origin, open))) {
      ++blocks_told_;
    } else {
      stack_[stacked_++] = {0, block, true};
    }
  }
}

/// Whether the faces of each of so many blocks in found_ are apart from those of A's block, or from what that is in.
bool SweepWorker::apart_from_faces(std::uint32_t block, const SlabEnds& ends, const Vec3& origin, std::uint32_t count) {
  std::uint32_t eight = kNone, higher = 0, left = 0;
  QuadricLanes::Field share;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t other = found_[i], group = other / FaceBlocks::kFan;
    if (std::exchange(eight, group) != group) higher = apart_by_heights({0, block}, ends, origin, {0, group}, share);
    if ((higher >> (other % FaceBlocks::kFan) & 1) == 0) found_[left++] = other;
  }
  if (left == 0) return true;
  const MovedSlab slab = moved(surface_a_->slabs.slab(0, block));
  const Vec3 middle = 0.5 * (slab.from + slab.to);
  const MovedBox corners = slab.corners(middle);
  count = left;
  return std::all_of(found_.data(), found_.data() + count, [&](std::uint32_t other) {
    const FaceLanes& b = surface_b().lanes[other];
    return not_kept_apart(corners, b, middle - b.origin, floor_) == 0;
  });
}

/// Looks at the next node of A's hierarchy as a whole; a block's faces one by one where that is not enough.
void SweepWorker::next_node() {
  const Node node = stack_[--stacked_];
  if (node.level == 1) {
    prefetch(surface_a_->slabs.lanes(0, node.index));
    if (may_recede()) prefetch(&cones().nodes[0][node.index * FaceBlocks::kFan], FaceBlocks::kFan * sizeof(NormalCone));
  }
  if (recedes(node)) return;
  const double apart = node.open && question().look == Look::faces ? 0 : node_apart_for(node);
  if (node.level == 0 && !node.open) {
    ++blocks_asked_;
    if (apart == 1) ++blocks_told_;
  }
  if (apart == 1 || (node.level == 0 && all_recede(node.index))) return;
  if (is_enough(apart)) {
    // Over a shorter way from here on; this one once more.
    const double kept = kShareKept * apart * share_;
    task_->end.lower({kept, true});
    set_share(kept);
    ++stacked_;
  } else if (node.level == 1 && tops_[0].count > 0) {
    push_blocks(node);
  } else if (node.level > 0) {
    push_below(node);
  } else if (question().layer != Layer::faces || question().look == Look::faces || may_search()) {
    task_->searched.fetch_add(1);
    place(node.index);
  } else {
    // Most would be looked at, and so may all be, for all of the way.
    task_->end_with(SweepTask::Ending::many_faces);
  }
}

/// Whether it pays to ask blocks as a whole before their faces. Some are, all the same.
bool SweepWorker::nodes_tell() const {
  return blocks_asked_ < kSomeBlocks || blocks_told_ > kToldShare * blocks_asked_;
}

/// Whether the motion may end so early as whole blocks tell.
bool SweepWorker::is_enough(double apart) const {
  const double kept = kShareKept * apart * share_;
  if (question().look != Look::blocks || question().layer != Layer::faces || question().worth > 1) return false;
  const double searched = task_->searched.load() / few_blocks();
  const double enough = kEnough + (kEnoughAtFirst - kEnough) * std::max(0.0, 1 - searched);
  return kept >= enough * task_->faces_end.value().share || kept >= question().worth;
}

double SweepWorker::few_blocks() const {
  return kFewBlocks + surface_a_->blocks.count() / kBlocksShare;
}

/// Whether few blocks were looked at face by face until now, of all or of those that the look has come past.
bool SweepWorker::may_search() const {
  const double done = static_cast<double>(*piece_ + 1) / question().pieces;
  return task_->searched.load() < std::max(few_blocks(), kMost * done * surface_a_->blocks.count());
}

/// The share of the motion in which all faces under A's node are apart from B, or less.
double SweepWorker::node_apart_for(const Node& node) {
  const std::uint32_t level = std::min(node.level, surface_b().blocks.levels() - 1);
  const AxisBox box = walk_beside(node, level);
  const bool flat = node.level < surface_a_->slabs.levels() && level < surface_b().slabs.levels();
  if (!flat) return walk_.next(found_.data(), 1) == 0 ? 1 : 0;
  const MovedSlab slab = moved(surface_a_->slabs.slab(node.level, node.index));
  const Vec3 middle = 0.5 * (slab.from + slab.to);
  const SlabEnds ends(slab, middle);
  std::optional<MovedBox> corners;
  double apart = 1;
  std::uint32_t eight = kNone, kept = 0, by_heights = kNone, higher = 0;
  QuadricLanes::Field share_of_heights;
  for (std::uint32_t count = kBeside; count == kBeside;) {
    count = walk_.next(found_.data(), kBeside);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t other = found_[i];
      if (std::exchange(eight, other / FaceBlocks::kFan) != other / FaceBlocks::kFan)
        kept = kept_apart(ends, middle, surface_b().slabs.lanes(level, eight), floor_);
      if ((kept >> (other % FaceBlocks::kFan) & 1) != 0) continue;
      if (node.level == 0) {
        // Maybe each of its faces is apart from what A's block is in.
        if (!corners) corners = slab.corners(middle);
        const FaceLanes& b = surface_b().lanes[other];
        if (not_kept_apart(*corners, b, middle - b.origin, floor_) == 0) continue;
      }
      if (std::exchange(by_heights, eight) != eight)
        higher = apart_by_heights(node, ends, middle, {level, eight}, share_of_heights);
      if ((higher >> (other % FaceBlocks::kFan) & 1) != 0) continue;
      const double share = std::max(apart_from(slab, ends, middle, box, {level, other}),
                                    std::min(kShareKept, double{share_of_heights[other % FaceBlocks::kFan]}));
      if (share == 1) continue;
      apart = std::min(apart, share);
      if (!is_enough(apart)) return 0;
    }
  }
  return apart;
}

/// The share in which a slab of A is apart from a node of B, or from all that is under it, where that is much larger: a
/// few such nodes, of faces that are left over from others, are beside most of A.
double SweepWorker::apart_from(const MovedSlab& slab, const SlabEnds& ends, const Vec3& middle, const AxisBox& box,
                               const Node& other) const {
  const Surface& b = surface_b();
  const double size2 = kMuchLarger * kMuchLarger * slab.from_axes.squaredNorm();
  std::array<std::uint32_t, kBeside> nodes{other.index}, below;
  std::uint32_t count = 1, level = other.level;
  const auto is_large = [&](std::uint32_t i) { return b.slabs.slab(level, i).half.squaredNorm() > size2; };
  while (level > 0 && std::any_of(nodes.begin(), nodes.begin() + count, is_large)) {
    count = not_kept_apart_under(nodes.data(), count, level, b.blocks, b.slabs, ends, middle, box, floor_, below.data(),
                                 kBeside);
    if (count > kBeside) return 0;
    std::copy_n(below.begin(), count, nodes.begin());
    --level;
  }
  double apart = 1;
  for (std::uint32_t i = 0; i < count; ++i)
    apart = std::min(apart, apart_for(slab, b.slabs.slab(level, nodes[i]), floor_));
  return apart;
}

/// Of eight of B's nodes, those that are apart from what A's node is in by heights over quadrics: a bit each, and for
/// how much of the motion the others are.
std::uint32_t SweepWorker::apart_by_heights(const Node& node, const SlabEnds& ends, const Vec3& middle,
                                            const Node& eight, QuadricLanes::Field& share) const {
  const QuadricLanes& of_a = surface_a_->slabs.quadrics(node.level, node.index / FaceBlocks::kFan);
  const QuadricLanes& of_b = surface_b().slabs.quadrics(eight.level, eight.index);
  const std::uint32_t k = node.index % FaceBlocks::kFan;
  share.fill(0);
  // What touches is nearer to most of the faces beside it than they follow quadrics, which would be asked for nothing.
  const bool touches = !std::isfinite(question().worth);
  if (touches || (of_a.fits >> k & 1) == 0 || of_b.fits == 0) return 0;
  return kept_apart_by_heights(ends, of_a, k, middle, surface_b().slabs.lanes(eight.level, eight.index), of_b, floor_,
                               share);
}

MovedSlab SweepWorker::moved(const Slab& slab) const {
  MovedSlab out;
  const Vec3 center = slab.center + offset_a_;
  out.from = sweep_.start.R * center + sweep_.start.t;
  out.to = sweep_.end.R * center + sweep_.end.t;
  out.axes = sweep_.start.R * slab.axes;
  out.from_axes = out.axes * slab.half.asDiagonal();
  out.to_axes = (sweep_.end.R * slab.axes) * slab.half.asDiagonal();
  return out;
}

}  // namespace tegotae
