#include "narrowphase/cell_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/moving_plane.hpp"
#include "narrowphase/patch_lanes.hpp"

namespace tegotae {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Nodes and faces of B that one search measures at most; a piece that needs more is better taken apart.
constexpr int kMaxVisits = 160;
/// A plane known already stands for a piece of B as well when it is not nearer than this share of the nearest.
constexpr double kGoodShare = 0.97;
/// A box of A that overlaps one of B of less than this share of its size is taken apart at once.
constexpr double kSmallShare = 0.5;
/// Blocking triangles of B that one search lists.
constexpr std::size_t kMaxBlocking = 2;
/// Products of unit vectors shorter than this have no reliable direction.
constexpr double kParallel = 1e-6;
/// Distances along the axes of boxes, which are of unit length and at right angles up to single precision, are right up
/// to this share.
constexpr double kAxisSlack = 1 - 1e-5;
/// For the same reason the way of a piece in its frame is right up to this share.
constexpr double kWaySlack = 1e-6;
/// Distances are listed in single precision, rounded down.
constexpr double kFloatSlack = 1 - 1e-6;

}  // namespace

CellSearch::CellSearch() : boxes_{}, faces_{}, near_boxes_{}, near_faces_{}, lane_{} {
  stack_.reserve(kMaxVisits + kMeasured + kCellItems);
  near_.reserve(kMaxVisits + kMeasured + kCellItems);
  far_.reserve(kMaxVisits + kMeasured + kCellItems);
  waiting_.reserve(kCellItems);
  blocking_.reserve(kMaxBlocking);
}

Hull CellSearch::hull_of(std::uint32_t item) const {
  if ((item & CellItems::kFace) != 0) {
    const std::uint32_t face = item & ~CellItems::kFace;
    const Vec3& o = query_.tree->origin();
    return Hull::triangle(
        {query_.tree->corner(face, 0) - o, query_.tree->corner(face, 1) - o, query_.tree->corner(face, 2) - o});
  }
  const PatchNode& b = query_.tree->nodes()[item];
  return Hull::box(b.center_vec(), {b.axis_vec(0), b.axis_vec(1), b.axis_vec(2)}, {b.half[0], b.half[1], b.half[2]});
}

bool CellSearch::stays_above(const Vec3& n, double low_start, double low_end, double top) const {
  const double alpha = low_start - top - sweep_->start_floor, beta = low_end - top - sweep_->floor;
  if (std::min(alpha, beta) >= most_bulge_) return true;
  return stays_positive(alpha, beta, bulge_along(n, a_->reach, *sweep_));
}

bool CellSearch::under_known_plane(const Hull& b, double good) {
  if (planes_ == 0) return false;
  const double start = std::max(good, most_bulge_ + sweep_->start_floor);
  const double end = std::max(good, most_bulge_ + sweep_->floor);
  const int k = first_above(known_, planes_, b, start, end, tops_);
  if (k == kCellPlanes) return false;
  const auto i = static_cast<std::size_t>(k);
  known_.top[i] = std::max(known_.top[i], tops_[i]);
  margin_ = std::min(margin_, known_.low_start[i] - tops_[i]);
  least_ = std::min(least_, std::min(known_.low_start[i], known_.low_end[i]) - tops_[i]);
  return true;
}

bool CellSearch::best_of_all_axes(const Hull& b, Vec3& best) const {
  double most = 0;
  const Hull &a = a_->start, &end = a_->end;
  const auto offer = [&](const Vec3& v) {
    const double length = v.norm();
    if (!(length > kParallel)) return;
    for (const double sign : {1.0, -1.0}) {
      const Vec3 n = (sign / length) * v;
      const double top = b.highest(n), gap = std::min(a.lowest(n) - top, end.lowest(n) - top);
      if (gap > most) most = gap, best = n;
    }
  };
  std::array<Vec3, 3> ea, eb;
  for (int i = 0; i < 3; ++i) {
    ea[i] = (a.corner((i + 1) % 3) - a.corner(i)).normalized();
    eb[i] = (b.corner((i + 1) % 3) - b.corner(i)).normalized();
  }
  const Vec3 na = ea[0].cross(ea[1]).normalized(), nb = eb[0].cross(eb[1]).normalized();
  offer(na);
  offer(nb);
  offer(a.middle() - b.middle());
  for (int i = 0; i < 3; ++i) {
    offer(na.cross(ea[i]));
    offer(nb.cross(eb[i]));
    for (int k = 0; k < 3; ++k) offer(ea[i].cross(eb[k]));
  }
  return most > 0;
}

bool CellSearch::keeps_off(const Hull& b, const Vec3& direction, double at_least) {
  const Vec3 n = single(direction);
  const double low_start = a_->start.lowest(n), low_end = a_->end.lowest(n), top = b.highest(n);
  const double gap = std::min(low_start, low_end) - top;
  if (!(gap >= at_least)) return false;
  if (!stays_above(n, low_start, low_end, top)) return false;
  if (planes_ == kCellPlanes) {
    full_ = true;
    return false;
  }
  const auto k = static_cast<std::size_t>(planes_++);
  for (std::size_t i = 0; i < 3; ++i) known_.n[i][k] = n[static_cast<Eigen::Index>(i)];
  known_.low_start[k] = low_start;
  known_.low_end[k] = low_end;
  known_.top[k] = top;
  margin_ = std::min(margin_, low_start - top);
  least_ = std::min(least_, gap);
  return true;
}

void CellSearch::tell_items(bool found) {
  // What was found of the near ones, those that the search had not come to, and the nearest of the others.
  for (const Entry& rest : stack_) list(rest.item, rest.distance);
  for (const Listed& rest : waiting_) list(rest.item, rest.distance);
  items_.clear = beyond_;
  items_.count = items_.near = 0;
  if (near_.size() > kCellItems) {
    items_.clear = 0;
    return;
  }
  const std::size_t room = kCellItems - near_.size();
  if (far_.size() > room) {
    const auto end = far_.begin() + static_cast<std::ptrdiff_t>(room);
    std::nth_element(far_.begin(), end, far_.end(),
                     [](const Listed& p, const Listed& q) { return p.distance < q.distance; });
    items_.clear = std::min(items_.clear, end->distance);
    far_.resize(room);
  }
  if (found) items_.near = static_cast<std::uint32_t>(near_.size());
  for (const auto* list : {&near_, &far_}) {
    for (const Listed& l : *list) {
      items_.item[items_.count] = l.item;
      items_.distance[items_.count++] = static_cast<float>(kFloatSlack * l.distance);
    }
  }
}

void CellSearch::leave_out(std::uint32_t item, double distance) {
  clear_ = std::min(clear_, distance);
  far_.push_back({item, distance});
}

void CellSearch::measure(const std::uint32_t* items, int count) {
  std::size_t box_count = 0, face_count = 0;
  const PatchTree& tree = *query_.tree;
  const Vec3 origin = tree.origin() + frame_.origin;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::uint32_t place = items[i] & ~CellItems::kFace;
    if (place == items[i]) {
      const PatchNode& b = tree.nodes()[place];
      for (std::size_t c = 0; c < 3; ++c) {
        boxes_.center[c][box_count] = b.center[c] - frame_.origin[static_cast<Eigen::Index>(c)];
        boxes_.half[c][box_count] = b.half[c];
        for (std::size_t k = 0; k < 3; ++k) boxes_.edge[k][c][box_count] = b.axis[k][c];
      }
      lane_[i] = box_count++;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = tree.corner(place, static_cast<int>(k));
      for (std::size_t c = 0; c < 3; ++c) {
        const auto axis = static_cast<Eigen::Index>(c);
        faces_.edge[k][c][face_count] = corner[axis] - origin[axis];
      }
    }
    lane_[i] = face_count++;
  }
  visits_ += count;
  if (box_count > 0) measure_boxes(frame_, boxes_, static_cast<int>(box_count), near_boxes_);
  if (face_count > 0) measure_triangles(frame_, faces_, static_cast<int>(face_count), near_faces_);
}

double CellSearch::distance(std::uint32_t item, std::size_t i) const {
  const Nearness& nearness = (item & CellItems::kFace) != 0 ? near_faces_ : near_boxes_;
  return kAxisSlack * std::sqrt(nearness.distance2[lane_[i]]) - way_slack_;
}

CellSearch::Side CellSearch::side(const Nearness& nearness, const Nearness::Side& side, std::size_t lane) const {
  const auto number = static_cast<std::size_t>(side.number[lane]);
  Side out{side.gap[lane], Vec3::Zero()};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto axis = static_cast<Eigen::Index>(c);
    const double n = number < 3                  ? frame_.axis[number][axis]
                     : &nearness == &near_faces_ ? nearness.plane[c][lane]
                                                 : boxes_.edge[number - 3][c][lane];
    out.n[axis] = side.sign[lane] * n;
  }
  return out;
}

CellSearch::Entry CellSearch::entry(std::uint32_t item, std::size_t i, double distance) const {
  const Nearness& nearness = (item & CellItems::kFace) != 0 ? near_faces_ : near_boxes_;
  return {item, distance, side(nearness, nearness.any, lane_[i]), side(nearness, nearness.upright, lane_[i])};
}

void CellSearch::push(const std::uint32_t* items, int count) {
  measure(items, count);
  const std::size_t first = stack_.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const double far = distance(items[i], i);
    if (far >= query_.wanted) {
      leave_out(items[i], far);
      continue;
    }
    // The nearest is on top.
    stack_.push_back(entry(items[i], i, far));
    for (std::size_t k = stack_.size() - 1; k > first && stack_[k - 1].distance < far; --k)
      std::swap(stack_[k - 1], stack_[k]);
  }
}

void CellSearch::set_frame(const MovingHull& a) {
  const Vec3 ahead = a.end.middle() - a.start.middle();
  frame_ = HullFrame(a.start, ahead);
  way_slack_ = kWaySlack * ahead.norm();
}

bool CellSearch::renew(const MovingHull& a, const PatchTree& tree, double moved, double enough, CellItems& items,
                       double& clear) noexcept {
  clear = items.clear - moved;
  if (items.count == 0 || !(clear >= enough)) return false;
  query_ = {};
  query_.tree = &tree;
  set_frame(a);
  std::array<double, kCellItems> far;
  std::array<std::uint32_t, kMeasured> some{}, place{};
  int count = 0;
  const auto measure_some = [&] {
    measure(some.data(), count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      far[place[k]] = distance(some[k], k);
      if (far[place[k]] < enough) return false;
    }
    count = 0;
    return true;
  };
  for (std::uint32_t i = 0; i < items.count; ++i) {
    far[i] = items.distance[i] - moved;
    if (i < items.near || far[i] >= enough) continue;
    some[static_cast<std::size_t>(count)] = items.item[i];
    place[static_cast<std::size_t>(count++)] = i;
    if (count == kMeasured && !measure_some()) return false;
  }
  if (!measure_some()) return false;
  items.clear = clear;
  for (std::uint32_t i = 0; i < items.count; ++i) {
    items.distance[i] = static_cast<float>(far[i] > 0 ? kFloatSlack * far[i] : far[i] / kFloatSlack);
    if (i >= items.near) clear = std::min(clear, far[i]);
  }
  return true;
}

void CellSearch::open(std::uint32_t node) {
  // A few levels at once, as many pieces as are measured together.
  std::array<std::uint32_t, kMeasured> pieces;
  pieces[0] = node;
  int count = 1;
  const PatchTree& tree = *query_.tree;
  for (bool more = true; more;) {
    more = false;
    for (int i = 0, n = count; i < n; ++i) {
      if ((pieces[static_cast<std::size_t>(i)] & CellItems::kFace) != 0) continue;
      const PatchNode& b = tree.nodes()[pieces[static_cast<std::size_t>(i)]];
      const int children = b.leaf() ? static_cast<int>(b.count) : 2;
      if (count + children - 1 > kMeasured) continue;
      const auto child = [&](int k) {
        const std::uint32_t place = b.first + static_cast<std::uint32_t>(k);
        return b.leaf() ? tree.order()[place] | CellItems::kFace : place;
      };
      pieces[static_cast<std::size_t>(i)] = child(0);
      for (int k = 1; k < children; ++k) pieces[static_cast<std::size_t>(count++)] = child(k);
      more = true;
    }
  }
  push(pieces.data(), count);
}

CellSearch::Outcome CellSearch::settle_face(const Entry& e, const Hull& b) {
  if (keeps_off(b, e.any.n, 0)) return Outcome::found;
  if (face_of_a_ == nullptr) return Outcome::divide;
  if (under_known_plane(b, 0)) return Outcome::found;
  Vec3 n = e.any.n;
  if (best_of_all_axes(b, n) && keeps_off(b, n, 0)) return Outcome::found;
  if (full_ && !query_.is_face) return Outcome::divide;
  const Vec3& o = query_.tree->origin();
  const std::uint32_t face = e.place();
  const std::array<Vec3, 3> corners{query_.tree->corner(face, 0) - o, query_.tree->corner(face, 1) - o,
                                    query_.tree->corner(face, 2) - o};
  MovingPlane plane{n, n};
  if (separate_triangles(*face_of_a_, corners, *sweep_, a_->reach, plane)) {
    passing_ = true;
    return Outcome::found;
  }
  blocking_.push_back(face);
  return blocking_.size() < kMaxBlocking ? Outcome::found : Outcome::blocked;
}

CellSearch::Outcome CellSearch::settle(const Entry& e) {
  const Hull b = hull_of(e.item);
  const double good = std::min(query_.wanted, kGoodShare * least_);
  // What leaves its surface goes against no plane that lies on it.
  const bool upright = e.upright.gap >= good;
  if (under_known_plane(b, good) || (upright && keeps_off(b, e.upright.n, good)) ||
      (e.any.gap >= good && keeps_off(b, e.any.n, good))) {
    list(e.item, e.distance);
    return Outcome::found;
  }
  if (e.is_face()) {
    list(e.item, e.distance);
    return settle_face(e, b);
  }
  if (face_of_a_ == nullptr && !(e.any.gap > 0) && b.half(0) < kSmallShare * a_->radius) return Outcome::divide;
  open(e.place());
  return Outcome::found;
}

void CellSearch::begin(const Query& query) {
  query_ = query;
  set_frame(*a_);
  most_bulge_ = 0.125 * kUnitSlack * sweep_->theta2 * (a_->reach + sweep_->center_distance);
  planes_ = 0;
  known_.clear();
  near_.clear();
  far_.clear();
  margin_ = least_ = clear_ = beyond_ = kInfinity;
  passing_ = full_ = false;
  blocking_.clear();
  stack_.clear();
  waiting_.clear();
  if (query.known == nullptr) {
    const std::uint32_t top = query.is_face ? query.node | CellItems::kFace : query.node;
    push(&top, 1);
    return;
  }
  clear_ = beyond_ = query.known->clear - query.moved;
  for (std::size_t i = 0; i < query.known->count; ++i) {
    const Listed l{query.known->item[i], query.known->distance[i] - query.moved};
    if (l.distance >= query.wanted) {
      leave_out(l.item, l.distance);
      continue;
    }
    // The nearest last.
    waiting_.push_back(l);
    for (std::size_t k = waiting_.size() - 1; k > 0 && waiting_[k - 1].distance < l.distance; --k)
      std::swap(waiting_[k - 1], waiting_[k]);
  }
}

/// While nothing is on the stack, takes the nearest of the pieces that an earlier search listed. False when there is
/// none left.
bool CellSearch::has_next() {
  std::array<std::uint32_t, kMeasured> some;
  while (stack_.empty() && !waiting_.empty()) {
    int count = 0;
    for (; count < kMeasured && !waiting_.empty(); waiting_.pop_back())
      some[static_cast<std::size_t>(count++)] = waiting_.back().item;
    push(some.data(), count);
  }
  return !stack_.empty();
}

CellGaps CellSearch::gaps() const {
  CellGaps out;
  out.fill(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < static_cast<std::size_t>(planes_); ++k) out[k] = known_.low_start[k] - known_.top[k];
  return out;
}

void CellSearch::tell(FreeCell& cell) const {
  cell.drop_planes();
  for (std::size_t k = 0; k < static_cast<std::size_t>(planes_); ++k) {
    cell.nx[k] = static_cast<float>(known_.n[0][k]);
    cell.ny[k] = static_cast<float>(known_.n[1][k]);
    cell.nz[k] = static_cast<float>(known_.n[2][k]);
    cell.offset[k] = round_up<float>(known_.top[k]);
  }
  cell.clear = clear_;
}

CellSearch::Outcome CellSearch::find(const MovingHull& a, const std::array<Vec3, 3>* face_of_a, const Query& query,
                                     const Sweep& sweep, FreeCell& cell) noexcept {
  a_ = &a;
  face_of_a_ = face_of_a;
  sweep_ = &sweep;
  const std::int64_t before = visits_;
  begin(query);
  while (has_next()) {
    const Entry e = stack_.back();
    stack_.pop_back();
    const bool enough = visits_ - before > kMaxVisits && !query.is_face;
    const Outcome outcome = enough ? Outcome::divide : settle(e);
    if (outcome == Outcome::divide && !blocking_.empty()) return Outcome::blocked;
    if (outcome == Outcome::divide && (near_.empty() || near_.back().item != e.item)) list(e.item, e.distance);
    if (outcome == Outcome::divide) tell_items(false);
    if (outcome != Outcome::found) return outcome;
  }
  if (!blocking_.empty()) return Outcome::blocked;
  if (passing_) return Outcome::passing;
  tell_items(true);
  tell(cell);
  return Outcome::found;
}

}  // namespace tegotae
