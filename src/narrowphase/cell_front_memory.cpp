// Cells of faces that were near B are kept for when the part comes back.
#include <algorithm>

#include "core/numbers.hpp"
#include "narrowphase/cell_front.hpp"
#include "narrowphase/cell_slack.hpp"

namespace tegotae {
namespace {

/// A cell is kept when a plane comes nearer to the face than this part of its radius: farther away larger pieces do.
constexpr double kNearShare = 0.1;

}  // namespace

/// Keeps the cell that was just found for the node.
void CellFront::remember(const Node& node) {
  if (!node.face_a || node.face_b || node.b != 0) return;
  const Slot& s = slots_[node.slot];
  if (search_.least() > kNearShare * s.corridor.radius) return;
  memory_.keep({node.a, node.part, s.cell, s.corridor});
}

/// Whether the face's cell of before holds for the motion, and for what is foreseen. If so it is the node's cell.
bool CellFront::recall(std::uint32_t id) {
  const Node& node = nodes_[id];
  if (!node.face_a || node.face_b || node.b != 0) return false;
  const CellMemory::Kept* kept = memory_.find(node.a, node.part);
  if (kept == nullptr) return false;
  const auto for_all = [&](const Sweep& sweep) { return holds(node, kept->cell, kept->corridor, sweep); };
  if ((foresees() && !for_all(foreseen(node.part))) || !for_all(sweep_of(node.part))) return false;
  Slot& s = slots_[node.slot];
  s.cell = kept->cell;
  s.corridor = kept->corridor;
  // The list is of the piece that the face is of: which of its pieces are under these planes it does not say.
  items_[node.slot].near = 0;
  clear_until_[node.slot] = expiry_[node.slot] = -kInfinity;
  need_parts_above(id, state_of(id).margin);
  return true;
}

/// Whether a cell of the node holds for a motion.
bool CellFront::holds(const Node& node, const FreeCell& cell, const CellCorridor& corridor, const Sweep& sweep) const {
  const double floor = clearance_ + kLengthSlack;
  const CorridorLoss loss = corridor_loss(corridor, sweep, turned_);
  return share(cell.clear - loss.start - floor, cell.clear - loss.end - floor, loss.bulge) == 1 &&
         check_cell(cell, hull(node, sweep), sweep).free;
}

}  // namespace tegotae
