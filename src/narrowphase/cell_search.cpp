#include "narrowphase/cell_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"
#include "narrowphase/moving_plane.hpp"
#include "narrowphase/patch_lanes.hpp"
#include "narrowphase/wide.hpp"

namespace tegotae {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
/// A plane known already stands for a piece of B as well when it is not nearer than this share of the nearest.
constexpr double kGoodShare = 0.8;
/// A box of A that overlaps one of B of less than this share of its size is taken apart at once.
constexpr double kSmallShare = 0.5;
/// Blocking triangles of B that one search lists.
constexpr std::size_t kMaxBlocking = 2;
/// Products of unit vectors shorter than this have no reliable direction.
constexpr double kParallel = 1e-6;
/// What is so many times as far as is wanted is not listed.
constexpr double kListed = 6;
/// Halvings of the range of distances among which the nearest are looked for.
constexpr int kSearchHalvings = 10;

/// A number of single precision that is no larger.
float round_down(double x) {
  const float nearest = static_cast<float>(x);
  return nearest - 2.4e-7F * std::abs(nearest);
}

/// Among `count` distances, the end of which is padded with infinity to a multiple of kMeasured: one up to which,
/// itself not included, there are at most `room`, and nearly as many.
TEGOTAE_WIDE float nearest_end(const float* distance, std::size_t count, std::size_t room, float low, float high) {
  for (int i = 0; i < kSearchHalvings; ++i) {
    const float middle = 0.5F * (low + high);
    int nearer = 0;
    for (std::size_t k = 0; k < count; ++k) nearer += distance[k] < middle;
    (static_cast<std::size_t>(nearer) <= room ? low : high) = middle;
  }
  return low;
}

/// A face of A at both ends of a motion and a piece of B.
struct FaceOverHull {
  const MovingHull& a;
  const Hull& b;

  double start(const Vec3& n) const { return a.start.lowest(n) - b.highest(n); }
  double end(const Vec3& n) const { return a.end.lowest(n) - b.highest(n); }
  double mixed(const Vec3& n0, const Vec3& n1) const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) least = std::min(least, n0.dot(a.end.corner(i)) + n1.dot(a.start.corner(i)));
    return least - b.highest(n0) - b.highest(n1);
  }
};

}  // namespace

CellSearch::CellSearch() : boxes_{}, faces_{}, near_boxes_{}, near_faces_{}, lane_{} {
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

void CellSearch::report_items(bool found) {
  // What was found of the near ones, those that the search had not come to, and the nearest of the others.
  for (std::size_t i = 0; i < stacked_; ++i) near_.add(stack_[i].item, stack_[i].distance);
  for (std::size_t i = 0; i < waiting_.count; ++i) near_.add(waiting_.item[i], waiting_.distance[i]);
  items_.clear = beyond_;
  items_.count = items_.near = 0;
  if (near_.count > kCellItems) {
    items_.clear = 0;
    return;
  }
  for (std::size_t i = 0; i < near_.count; ++i) {
    items_.item[i] = near_.item[i];
    items_.distance[i] = near_.distance[i];
  }
  items_.count = static_cast<std::uint32_t>(near_.count);
  if (found) items_.near = items_.count;
  const std::size_t room = kCellItems - near_.count;
  float end = kFar;
  if (far_.count > room) {
    float low = kFar, high = -kFar;
    for (std::size_t i = 0; i < far_.count; ++i) {
      low = std::min(low, far_.distance[i]);
      high = std::max(high, far_.distance[i]);
    }
    end = nearest_end(far_.distance.data(), far_.count, room, low, high);
  }
  float rest = kFar;
  for (std::size_t i = 0; i < far_.count; ++i) {
    const float far = far_.distance[i];
    const bool listed = far < end;
    rest = std::min(rest, listed ? kFar : far);
    if (!listed) continue;
    items_.item[items_.count] = far_.item[i];
    items_.distance[items_.count++] = far;
  }
  items_.clear = std::min(items_.clear, double{rest});
}

void CellSearch::measure(const std::uint32_t* items, int count) {
  std::size_t box_count = 0, face_count = 0;
  const PatchTree& tree = *query_.tree;
  const Vec3 origin = tree.origin() + frame_.origin;
  const PatchNode* nodes = tree.nodes().data();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::uint32_t place = items[i] & ~CellItems::kFace;
    if (place == items[i]) {
      const PatchNode& b = nodes[place];
      for (std::size_t c = 0; c < 3; ++c) {
        boxes_.center[c][box_count] = b.center[c];
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
        faces_.edge[k][c][face_count] = static_cast<float>(corner[axis] - origin[axis]);
      }
    }
    lane_[i] = face_count++;
  }
  visits_ += count;
  if (box_count > 0) measure_boxes(frame_, boxes_, near_boxes_);
  if (face_count > 0) measure_triangles(frame_, faces_, near_faces_);
}

/// The normal of a side of a piece, of unit length up to single precision.
Vec3 CellSearch::normal(const Entry& e, const Hull& b, const Side& side) const {
  const int number = static_cast<int>(std::abs(side.normal));
  const double sign = side.normal < 0 ? -1 : 1;
  if (number <= 3) return sign * frame_.axis[static_cast<std::size_t>(number - 1)];
  if (!e.is_face()) return sign * b.axis(number - 4);
  // Axes of a frame may be left-handed, so the side is that on which its origin is.
  const Vec3 n = (b.corner(1) - b.corner(0)).cross(b.corner(2) - b.corner(0));
  const double length = n.norm();
  if (!(length > 0)) return Vec3::Zero();
  return (n.dot(frame_.origin - b.corner(0)) < 0 ? -1 : 1) / length * n;
}

/// Puts a piece on the stack, of which those from `first` on are sorted.
void CellSearch::add_entry(std::uint32_t item, std::size_t lane, std::size_t first) {
  const Nearness& n = nearness(item);
  const Entry e{
      item, n.distance[lane], {n.any.gap[lane], n.any.normal[lane]}, {n.upright.gap[lane], n.upright.normal[lane]}};
  std::size_t k = stacked_++;
  for (; k > first && stack_[k - 1].distance < e.distance; --k) stack_[k] = stack_[k - 1];
  stack_[k] = e;
}

/// What needs no plane is listed unless it is far beyond what the next searches may want.
void CellSearch::leave_out(std::uint32_t item, float far) {
  clear_ = std::min(clear_, double{far});
  if (far < list_end_) {
    far_.add(item, far);
  } else {
    beyond_ = std::min(beyond_, double{far});
  }
}

void CellSearch::push(const std::uint32_t* items, int count) {
  measure(items, count);
  sort_out(items, count);
}

void CellSearch::sort_out(const std::uint32_t* items, int count) {
  const std::size_t first = stacked_;
  const float wanted = static_cast<float>(query_.wanted);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const float far = nearness(items[i]).distance[lane_[i]];
    if (far >= wanted) {
      leave_out(items[i], far);
    } else {
      add_entry(items[i], lane_[i], first);
    }
  }
}

void CellSearch::set_frame(const MovingHull& a) {
  frame_ = HullFrame(a.start, a.end.middle() - a.start.middle());
}

bool CellSearch::renew(const MovingHull& a, const PatchTree& tree, double moved, double enough, CellItems& items,
                       double& clear) noexcept {
  clear = items.clear - moved;
  if (items.count == 0 || !(clear >= enough)) return false;
  query_ = {};
  query_.tree = &tree;
  set_frame(a);
  std::array<float, kCellItems> far;
  std::array<std::uint32_t, kMeasured> some{}, place{};
  int count = 0;
  const auto measure_some = [&] {
    measure(some.data(), count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      far[place[k]] = nearness(some[k]).distance[lane_[k]];
      if (far[place[k]] < enough) return false;
    }
    count = 0;
    return true;
  };
  for (std::uint32_t i = 0; i < items.count; ++i) {
    far[i] = round_down(items.distance[i] - moved);
    if (i < items.near || far[i] >= enough) continue;
    some[static_cast<std::size_t>(count)] = items.item[i];
    place[static_cast<std::size_t>(count++)] = i;
    if (count == kMeasured && !measure_some()) return false;
  }
  if (!measure_some()) return false;
  items.clear = clear;
  for (std::uint32_t i = 0; i < items.count; ++i) {
    items.distance[i] = far[i];
    if (i >= items.near) clear = std::min(clear, double{far[i]});
  }
  return true;
}

void CellSearch::open(std::uint32_t node) {
  const PatchBatch& batch = query_.batches->of(*query_.tree, node, batch_);
  const int count = static_cast<int>(batch.count);
  if (batch.faces) {
    push(batch.item.data(), count);
    return;
  }
  visits_ += count;
  measure_boxes(frame_, batch.boxes, near_boxes_);
  for (std::size_t i = 0; i < kMeasured; ++i) lane_[i] = i;
  sort_out(batch.item.data(), count);
}

/// Whether the moving plane that keeps A's face off the last face of B that passes keeps it off `b` as well.
bool CellSearch::passes(const Hull& b) const {
  return stays_apart(FaceOverHull{*a_, b}, passed_.n0, passed_.n1, Bulge(*sweep_, a_->reach, 0, 1), *sweep_, 0);
}

CellSearch::Outcome CellSearch::settle_face(const Entry& e, const Hull& b) {
  if (keeps_off(b, normal(e, b, e.any), 0)) return Outcome::found;
  if (face_of_a_ == nullptr) return Outcome::divide;
  if (under_known_plane(b, 0)) return Outcome::found;
  Vec3 n = normal(e, b, e.any);
  if (best_of_all_axes(b, n) && keeps_off(b, n, 0)) return Outcome::found;
  if (full_ && !query_.is_face) return Outcome::divide;
  const Vec3& o = query_.tree->origin();
  const std::uint32_t face = e.place();
  const std::array<Vec3, 3> corners{query_.tree->corner(face, 0) - o, query_.tree->corner(face, 1) - o,
                                    query_.tree->corner(face, 2) - o};
  MovingPlane plane{n, n};
  if (separate_triangles(*face_of_a_, corners, *sweep_, a_->reach, nullptr, plane)) {
    if (query_.cells_only) return Outcome::passing;
    passing_ = true;
    passed_ = plane;
    return Outcome::found;
  }
  blocking_.push_back(face);
  return blocking_.size() < kMaxBlocking ? Outcome::found : Outcome::blocked;
}

CellSearch::Outcome CellSearch::settle(const Entry& e) {
  const Hull b = hull_of(e.item);
  // There will be no cell: what passes as well needs no closer look.
  if (passing_ && passes(b)) {
    near_.add(e.item, e.distance);
    return Outcome::found;
  }
  const double good = std::min(query_.wanted, kGoodShare * least_);
  // What leaves its surface goes against no plane that lies on it.
  const bool upright = e.upright.gap >= good;
  if (under_known_plane(b, good) || (upright && keeps_off(b, normal(e, b, e.upright), good)) ||
      (e.any.gap >= good && keeps_off(b, normal(e, b, e.any), good))) {
    near_.add(e.item, e.distance);
    return Outcome::found;
  }
  if (e.is_face()) {
    near_.add(e.item, e.distance);
    return settle_face(e, b);
  }
  if (face_of_a_ == nullptr && !(e.any.gap > 0) && b.half(0) < kSmallShare * a_->radius) return Outcome::divide;
  open(e.place());
  return Outcome::found;
}

void CellSearch::begin(const Query& query) {
  query_ = query;
  list_end_ = static_cast<float>(kListed * query.wanted);
  set_frame(*a_);
  most_bulge_ = 0.125 * kUnitSlack * sweep_->theta2 * (a_->reach + sweep_->center_distance);
  planes_ = 0;
  known_.clear();
  near_.count = far_.count = waiting_.count = stacked_ = 0;
  margin_ = least_ = clear_ = beyond_ = kInfinity;
  passing_ = full_ = false;
  blocking_.clear();
  if (query.known == nullptr) {
    const std::uint32_t top = query.is_face ? query.node | CellItems::kFace : query.node;
    push(&top, 1);
    return;
  }
  take_known(*query.known, query.moved);
}

void CellSearch::take_known(const CellItems& known, double moved) {
  clear_ = beyond_ = known.clear - moved;
  const float wanted = static_cast<float>(query_.wanted);
  for (std::size_t i = 0; i < known.count; ++i) {
    const float far = round_down(known.distance[i] - moved);
    if (far >= wanted) {
      leave_out(known.item[i], far);
      continue;
    }
    // The nearest last.
    std::size_t k = waiting_.count++;
    for (; k > 0 && waiting_.distance[k - 1] < far; --k) {
      waiting_.distance[k] = waiting_.distance[k - 1];
      waiting_.item[k] = waiting_.item[k - 1];
    }
    waiting_.distance[k] = far;
    waiting_.item[k] = known.item[i];
  }
}

/// While nothing is on the stack, takes the nearest of the pieces that an earlier search listed. False when there is
/// none left.
bool CellSearch::has_next() {
  std::array<std::uint32_t, kMeasured> some;
  while (stacked_ == 0 && waiting_.count > 0) {
    int count = 0;
    while (count < kMeasured && waiting_.count > 0)
      some[static_cast<std::size_t>(count++)] = waiting_.item[--waiting_.count];
    push(some.data(), count);
  }
  return stacked_ > 0;
}

CellGaps CellSearch::gaps() const {
  CellGaps out;
  out.fill(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < static_cast<std::size_t>(planes_); ++k) out[k] = known_.low_start[k] - known_.top[k];
  return out;
}

void CellSearch::write(FreeCell& cell) const {
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
    const Entry e = stack_[--stacked_];
    const bool enough = visits_ - before > static_cast<std::int64_t>(kMaxVisits) && !query.is_face;
    const Outcome outcome = enough ? Outcome::divide : settle(e);
    if (outcome == Outcome::divide && !blocking_.empty()) return Outcome::blocked;
    if (outcome == Outcome::divide && (near_.count == 0 || near_.item[near_.count - 1] != e.item))
      near_.add(e.item, e.distance);
    if (outcome == Outcome::divide) report_items(false);
    if (outcome != Outcome::found) return outcome;
  }
  if (!blocking_.empty()) return Outcome::blocked;
  if (passing_) return Outcome::passing;
  report_items(true);
  write(cell);
  return Outcome::found;
}

}  // namespace tegotae
