#include "narrowphase/patch_batches.hpp"

namespace tegotae {
namespace {

constexpr std::uint32_t kFewFaces = 4;
/// Batches that are made at the start, from the root down: all of some 300 000 triangles. Of a million they take 60 ms,
/// as long as the rest of a second start.
constexpr std::size_t kMadeAhead = 16384;

void put(const PatchNode& b, std::size_t i, NearHulls& out) {
  for (std::size_t c = 0; c < 3; ++c) {
    out.center[c][i] = b.center[c];
    out.half[c][i] = b.half[c];
    for (std::size_t k = 0; k < 3; ++k) out.edge[k][c][i] = b.axis[k][c];
  }
}

}  // namespace

PatchBatches::PatchBatches(const PatchTree& tree)
    : faces_(tree.nodes().size()), batch_(tree.nodes().size(), kNone), batches_() {
  const std::vector<PatchNode>& nodes = tree.nodes();
  // Children come after their parents.
  for (std::size_t i = nodes.size(); i-- > 0;)
    faces_[i] = nodes[i].leaf() ? nodes[i].count : faces_[nodes[i].first] + faces_[nodes[i].first + 1];
  std::vector<std::uint32_t> queue{0};
  for (std::size_t next = 0; next < queue.size() && batches_.size() < kMadeAhead; ++next) {
    const std::uint32_t node = queue[next];
    // Faces take longer to measure than to list.
    if (faces_[node] <= kFewFaces) continue;
    batch_[node] = static_cast<std::uint32_t>(batches_.size());
    batches_.emplace_back();
    const PatchBatch& made = batches_.back();
    make(tree, node, batches_.back());
    queue.insert(queue.end(), made.item.begin(), made.item.begin() + made.count);
  }
}

std::size_t PatchBatches::bytes() const {
  return (faces_.capacity() + batch_.capacity()) * sizeof(std::uint32_t) + batches_.capacity() * sizeof(PatchBatch);
}

void PatchBatches::make(const PatchTree& tree, std::uint32_t node, PatchBatch& out) const {
  const std::vector<PatchNode>& nodes = tree.nodes();
  out.faces = faces_[node] <= kFewFaces;
  if (out.faces) {
    std::uint32_t leaf = node;
    while (!nodes[leaf].leaf()) leaf = nodes[leaf].first;
    out.count = faces_[node];
    for (std::uint32_t k = 0; k < out.count; ++k) out.item[k] = tree.order()[nodes[leaf].first + k] | CellItems::kFace;
    return;
  }
  out.item[0] = node;
  out.count = 1;
  for (bool more = true; more;) {
    more = false;
    for (std::uint32_t i = 0, n = out.count; i < n && out.count < kMeasured; ++i) {
      if (faces_[out.item[i]] <= kFewFaces) continue;
      const std::uint32_t first = nodes[out.item[i]].first;
      out.item[i] = first;
      out.item[out.count++] = first + 1;
      more = true;
    }
  }
  for (std::size_t i = 0; i < out.count; ++i) put(nodes[out.item[i]], i, out.boxes);
}

}  // namespace tegotae
