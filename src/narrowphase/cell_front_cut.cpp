// The cut through the hierarchy: pieces are taken apart, and put together again.
#include "narrowphase/cell_front.hpp"

#include <algorithm>
#include <array>

#include "core/numbers.hpp"
#include "narrowphase/cell_slack.hpp"

namespace tegotae {
namespace {

/// One call tries to put together so many pairs of children, and one for so many searches, among so many it looks at.
constexpr int kMinRaises = 4, kSearchesPerRaise = 3, kMaxVisits = 256;
/// A cell for both children together must last for so many of the longest motions of late, or this share of what the
/// children's cells last for.
constexpr double kRaiseMotions = 8, kRaiseShare = 0.5;
/// Pieces that could not be put together are tried again when they are so many times as far from B, and at least this
/// share of their size.
constexpr double kRetryGrowth = 1.4, kRetryShare = 0.01;
/// So many larger pieces are tried in the place of one whose cell is used up.
constexpr int kMaxGrowths = 2;

}  // namespace

std::uint32_t CellFront::allocate() {
  if (free_nodes_ != kNobody) {
    const std::uint32_t id = free_nodes_;
    free_nodes_ = nodes_[id].child;
    return id;
  }
  const std::size_t id = nodes_.size();
  if (id + 2 > nodes_.capacity()) return kNobody;
  nodes_.resize(id + 2);
  return static_cast<std::uint32_t>(id);
}

void CellFront::release(std::uint32_t child) {
  nodes_[child].child = free_nodes_;
  free_nodes_ = child;
}

/// Gives the node a slot that knows what another one does.
void CellFront::enter(std::uint32_t id, std::uint32_t like) {
  nodes_[id].slot = count();
  slots_.push_back(slots_[like]);
  slots_.back().node = id;
  items_.push_back(items_[like]);
  listed_.push_back(listed_[like]);
  anchors_.push_back(anchors_[like]);
  clear_until_.push_back(clear_until_[like]);
  expiry_.push_back(expiry_[like]);
}

/// Gives the node a slot that knows nothing.
void CellFront::enter(std::uint32_t id) {
  nodes_[id].slot = count();
  slots_.push_back({id, nodes_[id].part, FreeCell::unknown(), {}});
  items_.emplace_back();
  listed_.emplace_back();
  anchors_.emplace_back();
  clear_until_.push_back(-kInfinity);
  expiry_.push_back(-kInfinity);
}

void CellFront::leave(std::uint32_t slot) {
  const std::uint32_t last = count() - 1;
  if (slot != last) {
    slots_[slot] = slots_[last];
    items_[slot] = items_[last];
    listed_[slot] = listed_[last];
    anchors_[slot] = anchors_[last];
    expiry_[slot] = expiry_[last];
    clear_until_[slot] = clear_until_[last];
    nodes_[slots_[slot].node].slot = slot;
  }
  slots_.pop_back();
  items_.pop_back();
  listed_.pop_back();
  anchors_.pop_back();
  expiry_.pop_back();
  clear_until_.pop_back();
}

bool CellFront::split(std::uint32_t id) {
  const Node p = nodes_[id];
  const bool of_a = !p.face_a;
  const PatchNode& whole = of_a ? a_->nodes()[p.a] : fixed_[p.part].tree->nodes()[p.b];
  const PatchTree& tree = of_a ? *a_ : *fixed_[p.part].tree;
  const std::uint32_t children = whole.leaf() ? whole.count : 2;
  if (count() + children > capacity_) return false;
  const std::uint32_t child = allocate();
  if (child == kNobody) return false;
  // What was known of the whole holds for its parts: the first one takes its place. The pieces of B that the search
  // listed are of all parts of A, and of B's none knows its own.
  items_[p.slot] = of_a ? search_.items() : CellItems{};
  if (of_a) listed_[p.slot] = found_corridor_;
  nodes_[id].child = child;
  nodes_[id].children = static_cast<std::uint8_t>(children);
  nodes_[id].due = 0;
  for (std::uint32_t k = 0; k < children; ++k) {
    Node c = p;
    c.parent = id;
    c.children = 0;
    c.retry = 0;
    c.split = 0;
    c.due = 0;
    const std::uint32_t place = whole.leaf() ? tree.order()[whole.first + k] : whole.first + k;
    (of_a ? c.a : c.b) = place;
    (of_a ? c.face_a : c.face_b) = whole.leaf();
    nodes_[child + k] = c;
    if (k == 0) {
      nodes_[child].slot = p.slot;
      slots_[p.slot].node = child;
    } else {
      enter(child + k, p.slot);
    }
  }
  return true;
}

void CellFront::raise() {
  const int most = kMinRaises + report_.searches / kSearchesPerRaise;
  int tries = 0;
  for (int visits = std::min<int>(kMaxVisits, cells()); visits > 0 && tries < most; --visits) {
    if (++cursor_ >= count()) cursor_ = 0;
    const std::uint32_t id = slots_[cursor_].node, parent = nodes_[id].parent;
    if (parent == kNobody || nodes_[parent].child != id || !may_raise(parent)) continue;
    if (out_of_work(true)) return;
    ++tries;
    try_raise(parent);
  }
}

bool CellFront::may_raise(std::uint32_t id) const {
  const Node& p = nodes_[id];
  for (std::uint32_t k = 0; k < p.children; ++k) {
    const Node& c = nodes_[p.child + k];
    if (c.children > 0 || expiry_[c.slot] - travel_ < p.retry) return false;
  }
  return true;
}

bool CellFront::try_raise(std::uint32_t id) {
  const Node& p = nodes_[id];
  double lasts = kInfinity;
  for (std::uint32_t k = 0; k < p.children; ++k) lasts = std::min(lasts, expiry_[nodes_[p.child + k].slot] - travel_);
  return merge(id, lasts);
}

/// Whether a cell was found for the piece together with its neighbors, as many as have come far enough from B since
/// they were taken apart: what a part that leaves needs. `margin` (m) is what the piece's planes have left.
bool CellFront::grow(std::uint32_t id, double margin) {
  std::array<std::uint32_t, kMaxGrowths> last{};
  int count = 0;
  for (std::uint32_t up = nodes_[id].parent; up != kNobody; up = nodes_[up].parent)
    if (nodes_[up].retry <= margin) last[static_cast<std::size_t>(count++ % kMaxGrowths)] = up;
  // The largest first.
  for (int i = count; i-- > std::max(0, count - kMaxGrowths);) {
    if (out_of_work(true)) return false;
    if (merge(last[static_cast<std::size_t>(i % kMaxGrowths)], margin)) return true;
  }
  return false;
}

/// Notes that the node's pieces, of which one has this margin (m), need cells of their own.
void CellFront::needs_parts(std::uint32_t id, double margin) {
  nodes_[id].retry = std::max(kRetryGrowth * margin, kRetryShare * radius(nodes_[id]));
}

/// Puts together all pieces under the node if one cell for all of them lasts as long as is worth it where theirs last
/// for `lasts` (m), or none is asked for.
bool CellFront::merge(std::uint32_t id, double lasts) {
  const bool near = asked_[nodes_[id].part] == now_;
  const double enough = std::max(need_, std::min(kRaiseMotions * motion_, kRaiseShare * lasts));
  if (near && (search(id, true) != CellSearch::Outcome::found || search_.margin() < enough)) {
    needs_parts(id, lasts);
    return false;
  }
  stack_.clear();
  freed_.clear();
  stack_.push_back(id);
  while (!stack_.empty()) {
    Node& p = nodes_[stack_.back()];
    stack_.pop_back();
    p.due = 0;
    if (p.children == 0) {
      leave(p.slot);
      continue;
    }
    for (std::uint32_t k = 0; k < p.children; ++k) stack_.push_back(p.child + k);
    freed_.push_back(p.child);
    p.children = 0;
  }
  for (const std::uint32_t child : freed_) release(child);
  nodes_[id].child = kNobody;
  enter(id);
  if (near) keep(id);
  ++report_.merges;
  return true;
}

}  // namespace tegotae
