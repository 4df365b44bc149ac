// What cells are looked for: pieces on their way, and how far ahead.
#include "narrowphase/cell_front.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numbers.hpp"
#include "narrowphase/cell_slack.hpp"

namespace tegotae {
namespace {

/// What is farther from the way of a piece than this part of its width needs no plane.
constexpr double kWantedShare = 0.75;
/// Cells are looked for farther ahead than the motion goes when it is this many times as far; what was met on the way
/// ends the foresight at this share of the way to it.
constexpr double kWorthForesight = 1.5, kForesightShare = 0.9;
/// The pieces of B that a cell lists are enough for a new search while the rest is this part of what is wanted away.
constexpr double kKnownShare = 0.5;
/// Halvings of a motion until two faces meet.
constexpr int kHalvings = 8;
/// What no plane stands for is far enough away without planes while this part of what is wanted is left.
constexpr double kRenewShare = 0.5;
/// A piece that was taken apart at rest, for a clearance that no motion needed yet, is tried again at this share of it.
constexpr double kAheadRetry = 0.25;

}  // namespace

/// A's motion by `d` (world) from where it is, as `part` sees it.
Sweep CellFront::sweep_by(std::uint32_t part, const Displacement& d) const {
  const FixedPart& B = fixed_[part];
  const Quat q_BW = B.pose.q.conjugate();
  return Sweep(B.pose.inverse() * X_, {q_BW * d.dp, q_BW * d.dr}, center_, *B.tree, a_->radius() + offset_a_.norm(),
               clearance_);
}

const Sweep& CellFront::sweep_of(std::uint32_t part) {
  if (stamped_[part] != call_) {
    stamped_[part] = call_;
    sweeps_[part] = sweep_by(part, d_);
  }
  return sweeps_[part];
}

MovingHull CellFront::hull(const Node& node, const Sweep& sweep) const {
  MovingHull out;
  if (node.face_a) {
    std::array<Vec3, 3> p, start, end;
    for (int k = 0; k < 3; ++k) {
      p[k] = a_->corner(node.a, k) - center_;
      start[k] = sweep.start.R * p[k] + sweep.start.t;
      end[k] = sweep.end.R * p[k] + sweep.end.t;
      out.reach = std::max(out.reach, p[k].norm());
    }
    out.start = Hull::triangle(start);
    out.end = Hull::triangle(end);
    const Vec3 middle = out.start.middle();
    for (const Vec3& v : start) out.radius = std::max(out.radius, (v - middle).norm());
    out.width = out.radius;
    return out;
  }
  const PatchNode& n = a_->nodes()[node.a];
  const Vec3 c = n.center_vec() + offset_a_;
  std::array<Vec3, 3> start, end;
  std::array<double, 3> half;
  double half2 = 0;
  for (int i = 0; i < 3; ++i) {
    half[i] = n.half[i];
    half2 += half[i] * half[i];
    start[i] = sweep.start.R * n.axis_vec(i);
    end[i] = sweep.end.R * n.axis_vec(i);
  }
  out.start = Hull::box(sweep.start.R * c + sweep.start.t, start, half);
  out.end = Hull::box(sweep.end.R * c + sweep.end.t, end, half);
  out.radius = std::sqrt(half2) / kUnit;
  out.reach = c.norm() + out.radius;
  out.width = half[1];
  return out;
}

/// Largest distance of a point of the node's piece of A from its middle, m.
double CellFront::radius(const Node& node) const {
  if (node.face_a) {
    const Vec3 &p = a_->corner(node.a, 0), &q = a_->corner(node.a, 1), &r = a_->corner(node.a, 2);
    const Vec3 middle = (p + q + r) / 3;
    return std::sqrt(std::max({(p - middle).squaredNorm(), (q - middle).squaredNorm(), (r - middle).squaredNorm()}));
  }
  const PatchNode& n = a_->nodes()[node.a];
  return std::sqrt(double{n.half[0]} * n.half[0] + double{n.half[1]} * n.half[1] + double{n.half[2]} * n.half[2]) /
         kUnit;
}

double CellFront::wanted(const MovingHull& a, const Sweep& sweep) const {
  return std::max({2 * (clearance_ + kLengthSlack + a.radius * sweep.theta), motion_, kWantedShare * a.width});
}

bool CellFront::foresees() const {
  return !ahead_ && foreseen_length_ > kWorthForesight * carried_ && !crowded();
}

/// The motion to a part, as long as is foreseen.
const Sweep& CellFront::foreseen(std::uint32_t part) {
  if (foreseen_stamped_[part] != foresights_) {
    foreseen_stamped_[part] = foresights_;
    foreseen_[part] = sweep_by(part, foresight_);
  }
  return foreseen_[part];
}

Vec3 CellFront::middle(const Node& node) const {
  if (node.face_a) return (a_->corner(node.a, 0) + a_->corner(node.a, 1) + a_->corner(node.a, 2)) / 3 - center_;
  return a_->nodes()[node.a].center_vec() + offset_a_;
}

CellCorridor CellFront::corridor(const Node& node, const MovingHull& a, const Sweep& sweep) const {
  return {middle(node), radius(node), a.end.middle() - a.start.middle(), sweep, turned_};
}

/// How far the corridor that begins at the start of the motion leaves that of the slot at most, m.
double CellFront::moved(std::uint32_t slot, const Sweep& sweep) const {
  // A corridor is straight, and what its piece turns on the way is added when it has turned.
  const CorridorLoss loss = corridor_loss(listed_[slot], sweep, turned_);
  return std::max(loss.start, loss.end);
}

/// Something is in the way that is foreseen: what is beyond it does not matter.
void CellFront::shorten_foresight(const Node& node) {
  double until = 1;
  for (const std::uint32_t face : search_.blocking())
    until = std::min(until, free_until(node.part, node.a, face, foresight_));
  met_ = std::min(met_, kept_ * until);
  kept_ *= kForesightShare * until;
  foresight_ = (kForesightShare * until) * foresight_;
  foreseen_length_ *= kForesightShare * until;
  ++foresights_;
}

/// The share of the motion `d` after which two faces that meet on it have met.
double CellFront::free_until(std::uint32_t part, std::uint32_t face_a, std::uint32_t face_b,
                             const Displacement& d) const {
  const PatchTree& tree = *fixed_[part].tree;
  std::array<Vec3, 3> a, b;
  double reach = 0;
  for (int k = 0; k < 3; ++k) {
    a[k] = a_->corner(face_a, k) - center_;
    b[k] = tree.corner(face_b, k) - tree.origin();
    reach = std::max(reach, a[k].norm());
  }
  double free = 0, met = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double s = 0.5 * (free + met);
    MovingPlane plane{Vec3::UnitX(), Vec3::UnitX()};
    if (separate_triangles(a, b, sweep_by(part, s * d), reach, nullptr, plane)) {
      free = s;
    } else {
      met = s;
    }
  }
  return met;
}

CellSearch::Outcome CellFront::search(std::uint32_t id, bool cells_only) {
  const Node& node = nodes_[id];
  if (node.face_a)
    for (int k = 0; k < 3; ++k) face_[k] = a_->corner(node.a, k) - center_;
  if (foresees()) {
    // What only passes on a way that is not taken yet is of no use.
    const CellSearch::Outcome outcome = search(node, foreseen(node.part), true);
    if ((outcome == CellSearch::Outcome::found && holds(node, found_, found_corridor_, sweep_of(node.part))) ||
        (outcome == CellSearch::Outcome::divide && !node.face_a))
      return outcome;
    if (outcome == CellSearch::Outcome::blocked) shorten_foresight(node);
  }
  return search(node, sweep_of(node.part), cells_only);
}

CellSearch::Outcome CellFront::search(const Node& node, const Sweep& sweep, bool cells_only) {
  const MovingHull a = hull(node, sweep);
  CellSearch::Query query{fixed_[node.part].tree.get(), batches_[node.part].get(), node.b, node.face_b,
                          wanted(a, sweep)};
  query.cells_only = cells_only;
  found_corridor_ = corridor(node, a, sweep);
  if (node.children == 0) {
    const CellItems& items = items_[node.slot];
    query.moved = moved(node.slot, sweep);
    if (items.count > 0 && items.clear - query.moved >= kKnownShare * query.wanted) query.known = &items;
  }
  const CellSearch::Outcome outcome = search_.find(a, node.face_a ? &face_ : nullptr, query, sweep, found_);
  found_.clear *= kUnit;
  return outcome;
}

void CellFront::anchor(std::uint32_t id, const CellGaps& gaps) {
  const Node& node = nodes_[id];
  anchors_[node.slot] = CellAnchor(gaps, middle(node), radius(node), sweep_of(node.part), turned_);
}

void CellFront::keep(std::uint32_t id) {
  const std::uint32_t slot = nodes_[id].slot;
  Slot& s = slots_[slot];
  s.cell = found_;
  s.corridor = listed_[slot] = found_corridor_;
  items_[slot] = search_.items();
  clear_until_[slot] = travel_ + kUnit * s.cell.clear;
  expiry_[slot] = travel_ + kUnit * search_.margin();
  anchor(id, search_.gaps());
  remember(nodes_[id]);
  need_parts_above(id, search_.margin());
}

/// The larger pieces that were just taken apart need it at this distance (m).
void CellFront::need_parts_above(std::uint32_t id, double margin) {
  for (std::uint32_t up = nodes_[id].parent; up != kNobody; up = nodes_[up].parent) {
    if (nodes_[up].retry < kInfinity && nodes_[up].split != call_) break;
    const double before = nodes_[up].retry;
    needs_parts(up, ahead_ ? kAheadRetry * margin : margin);
    nodes_[up].retry = std::min(nodes_[up].retry, before);
  }
}

CellFront::Outcome CellFront::settle(std::uint32_t top) {
  const std::size_t before = blocking_.size();
  stack_.clear();
  stack_.push_back(top);
  while (!stack_.empty()) {
    const std::uint32_t id = stack_.back();
    stack_.pop_back();
    if (out_of_work(true)) return Outcome::out_of_work;
    if (recall(id)) continue;
    switch (search(id, false)) {
      case CellSearch::Outcome::found:
        keep(id);
        break;
      case CellSearch::Outcome::passing:
        break;
      case CellSearch::Outcome::blocked:
        for (const std::uint32_t face : search_.blocking()) {
          blocking_.push_back({nodes_[id].part, nodes_[id].a, face});
          if (blocking_.size() >= limit_.blocking || blocking_.size() == blocking_.capacity()) return Outcome::blocked;
        }
        break;
      case CellSearch::Outcome::divide:
        if (!split(id)) {
          report_.overflow = true;
          return Outcome::out_of_work;
        }
        ++report_.splits;
        nodes_[id].retry = kInfinity;
        nodes_[id].split = call_;
        for (std::uint32_t k = 0; k < nodes_[id].children; ++k) stack_.push_back(nodes_[id].child + k);
    }
  }
  return blocking_.size() > before ? Outcome::blocked : Outcome::free;
}

/// Whether what the cell's planes do not stand for is far enough away for the motion, by a new look at it alone.
bool CellFront::renew(std::uint32_t id, double margin) {
  const Node& node = nodes_[id];
  const Sweep& sweep = foresees() ? foreseen(node.part) : sweep_of(node.part);
  const MovingHull a = hull(node, sweep);
  const CellCorridor next = corridor(node, a, sweep);
  double clear = 0;
  if (!search_.renew(a, *fixed_[node.part].tree, moved(node.slot, sweep), kRenewShare * wanted(a, sweep),
                     items_[node.slot], clear))
    return false;
  Slot& s = slots_[node.slot];
  s.cell.clear = kUnit * clear;
  s.corridor = listed_[node.slot] = next;
  clear_until_[node.slot] = travel_ + kUnit * s.cell.clear;
  expiry_[node.slot] = std::min(clear_until_[node.slot], travel_ + kUnit * margin);
  const double floor = clearance_ + kLengthSlack;
  const CorridorLoss loss = corridor_loss(next, sweep_of(node.part), turned_);
  return share(s.cell.clear - loss.start - floor, s.cell.clear - loss.end - floor, loss.bulge) == 1;
}

}  // namespace tegotae
