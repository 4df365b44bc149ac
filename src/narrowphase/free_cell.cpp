#include "narrowphase/free_cell.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "narrowphase/moving_plane.hpp"
#include "narrowphase/patch_lanes.hpp"

namespace tegotae {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Nodes of B that one search visits at most; a piece that needs more is better taken apart.
constexpr int kMostVisits = 160;
/// A plane known already stands for a piece of B as well when it is not nearer than this share of the nearest.
constexpr double kGoodShare = 0.97;
/// A box of A that overlaps one of B of less than this share of its size is taken apart at once.
constexpr double kSmallShare = 0.5;
/// Blocking triangles of B that one search lists.
constexpr std::size_t kMostBlocking = 2;
/// Products of unit vectors shorter than this have no reliable direction.
constexpr double kParallel = 1e-6;

/// Gaps along the axes of boxes are right up to this share.
constexpr double kAxisSlack = 1 - 1e-5;

Vec3 rounded(const Vec3& n) {
  return n.cast<float>().cast<double>();
}

/// Of a triangle; zero when it has no plane.
Vec3 unit_normal(const Hull& triangle) {
  const Vec3 e = triangle.corner(1) - triangle.corner(0), f = triangle.corner(2) - triangle.corner(0), n = e.cross(f);
  const double length2 = n.squaredNorm(), size2 = e.squaredNorm() + f.squaredNorm();
  return length2 > kParallel * kParallel * size2 * size2 ? Vec3(n / std::sqrt(length2)) : Vec3(Vec3::Zero());
}

}  // namespace

CellSearch::CellSearch() {
  stack_.reserve(2 * kMostVisits + kCellItems + 2);
  blocking_.reserve(kMostBlocking);
}

CellSearch::Entry CellSearch::entry(std::uint32_t node) const {
  const PatchNode& b = query_.tree->nodes()[node];
  const double radius =
      std::sqrt(double{b.half[0]} * b.half[0] + double{b.half[1]} * b.half[1] + double{b.half[2]} * b.half[2]);
  return {node, false, (b.center_vec() - middle_).norm() - kUnitSlack * radius - a_->radius};
}

Hull CellSearch::hull_of(const Entry& e) const {
  if (e.is_face) {
    const Vec3& o = query_.tree->origin();
    return Hull::triangle(
        {query_.tree->corner(e.node, 0) - o, query_.tree->corner(e.node, 1) - o, query_.tree->corner(e.node, 2) - o});
  }
  const PatchNode& b = query_.tree->nodes()[e.node];
  return Hull::box(b.center_vec(), {b.axis_vec(0), b.axis_vec(1), b.axis_vec(2)}, {b.half[0], b.half[1], b.half[2]});
}

bool CellSearch::stays_above(const Vec3& n, double low_start, double low_end, double top) const {
  return stays_positive(low_start - top - sweep_->start_floor, low_end - top - sweep_->floor,
                        bulge_along(n, a_->reach, *sweep_));
}

bool CellSearch::under_known_plane(const Hull& b, double good) {
  for (int k = 0; k < planes_; ++k) {
    const double top = b.highest(normal_[k]), gap = low_start_[k] - top;
    if (!(gap >= good) || !stays_above(normal_[k], low_start_[k], low_end_[k], top)) continue;
    top_[k] = std::max(top_[k], top);
    margin_ = std::min(margin_, gap);
    return true;
  }
  return false;
}

double CellSearch::best_axis(const Hull& b, Vec3& best) const {
  const Hull& a = a_->start;
  double most = -kInfinity;
  const auto offer = [&](const Vec3& n, double a_low, double a_high, double b_low, double b_high) {
    const double up = a_low - b_high, down = b_low - a_high;
    if (std::max(up, down) <= most) return;
    most = std::max(up, down);
    best = up > down ? n : Vec3(-n);
  };
  const auto offer_normal = [&](const Vec3& n, const Hull& of, const Hull& other) {
    // Level with its own triangle, which has no width along it.
    const double level = n.dot(of.corner(0)), low = other.lowest(n), high = other.highest(n);
    if (&of == &b) {
      offer(n, low, high, level, level);
    } else {
      offer(n, level, level, low, high);
    }
  };
  if (a.is_triangle()) {
    if (!normal_of_a_.isZero(0)) offer_normal(normal_of_a_, a, b);
  } else {
    for (int i = 0; i < 3; ++i) {
      const Vec3& n = a.axis(i);
      const double level = n.dot(a.middle());
      offer(n, level - a.half(i), level + a.half(i), b.lowest(n), b.highest(n));
    }
  }
  if (b.is_triangle()) {
    const Vec3 n = unit_normal(b);
    if (!n.isZero(0)) offer_normal(n, b, a);
  } else {
    for (int i = 0; i < 3; ++i) {
      const Vec3& n = b.axis(i);
      const double level = n.dot(b.middle());
      offer(n, a.lowest(n), a.highest(n), level - b.half(i), level + b.half(i));
    }
  }
  return most;
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
  const Vec3 n = rounded(direction);
  const double low_start = a_->start.lowest(n), top = b.highest(n), gap = low_start - top;
  if (!(gap >= at_least)) return false;
  const double low_end = a_->end.lowest(n);
  if (!stays_above(n, low_start, low_end, top)) return false;
  if (planes_ == kCellPlanes) {
    full_ = true;
    return false;
  }
  normal_[planes_] = n;
  low_start_[planes_] = low_start;
  low_end_[planes_] = low_end;
  top_[planes_++] = top;
  margin_ = std::min(margin_, gap);
  return true;
}

void CellSearch::list(const Entry& e) {
  listed_ = listed_ && items_.count < kCellItems;
  if (listed_) items_.item[items_.count++] = e.is_face ? e.node | CellItems::kFace : e.node;
}

void CellSearch::list_rest(const Entry& e) {
  // What was found of the near ones so far, the one at which the search ended, and those that it had not come to.
  if (items_.count == 0 || (items_.item[items_.count - 1] & ~CellItems::kFace) != e.node) list(e);
  for (const Entry& rest : stack_) {
    if (rest.distance < query_.wanted) {
      list(rest);
    } else {
      clear_ = std::min(clear_, rest.distance);
    }
  }
  if (!listed_) items_.count = 0;
  items_.clear = clear_;
}

void CellSearch::open(const Entry& e) {
  const PatchNode& b = query_.tree->nodes()[e.node];
  if (b.leaf()) {
    for (std::uint32_t i = 0; i < b.count; ++i) stack_.push_back({query_.tree->order()[b.first + i], true, e.distance});
    return;
  }
  // The nearer child is on top.
  const Entry one = entry(b.first), two = entry(b.first + 1);
  stack_.push_back(one.distance > two.distance ? one : two);
  stack_.push_back(one.distance > two.distance ? two : one);
}

CellSearch::Outcome CellSearch::settle_face(const Entry& e, const Hull& b, const Vec3& best) {
  if (keeps_off(b, best, 0)) return Outcome::found;
  if (face_of_a_ == nullptr) return Outcome::divide;
  if (under_known_plane(b, 0)) return Outcome::found;
  Vec3 n = best;
  if (best_of_all_axes(b, n) && keeps_off(b, n, 0)) return Outcome::found;
  if (full_ && !query_.is_face) return Outcome::divide;
  const Vec3& o = query_.tree->origin();
  const std::array<Vec3, 3> corners{query_.tree->corner(e.node, 0) - o, query_.tree->corner(e.node, 1) - o,
                                    query_.tree->corner(e.node, 2) - o};
  if (separate_triangles(*face_of_a_, corners, *sweep_, a_->reach, n)) {
    passing_ = true;
    return Outcome::found;
  }
  blocking_.push_back(e.node);
  return blocking_.size() < kMostBlocking ? Outcome::found : Outcome::blocked;
}

CellSearch::Outcome CellSearch::settle(const Entry& e) {
  if (e.distance >= query_.wanted) {
    clear_ = std::min(clear_, e.distance);
    return Outcome::found;
  }
  const Hull b = hull_of(e);
  const double good = std::min(query_.wanted, kGoodShare * margin_);
  if (under_known_plane(b, good)) {
    list(e);
    return Outcome::found;
  }
  Vec3 n = Vec3::UnitZ();
  const double gap = best_axis(b, n);
  // Axes are of unit length, and boxes as wide along their own as they say, up to single precision.
  if (kAxisSlack * gap >= query_.wanted) {
    clear_ = std::min(clear_, a_->start.lowest(n) - b.highest(n));
    return Outcome::found;
  }
  if (gap >= good && keeps_off(b, n, good)) {
    list(e);
    return Outcome::found;
  }
  if (e.is_face) {
    list(e);
    return settle_face(e, b, n);
  }
  if (face_of_a_ == nullptr && !(gap > 0)) {
    const PatchNode& node = query_.tree->nodes()[e.node];
    if (node.half[0] < kSmallShare * a_->radius) return Outcome::divide;
  }
  open(e);
  return Outcome::found;
}

void CellSearch::begin(const Query& query) {
  query_ = query;
  middle_ = a_->start.middle();
  normal_of_a_ = a_->start.is_triangle() ? unit_normal(a_->start) : Vec3(Vec3::Zero());
  planes_ = 0;
  items_.count = 0;
  listed_ = true;
  margin_ = clear_ = kInfinity;
  passing_ = full_ = false;
  blocking_.clear();
  stack_.clear();
  if (query.known == nullptr) {
    stack_.push_back(query.is_face ? Entry{query.node, true, -kInfinity} : entry(query.node));
    return;
  }
  clear_ = query.clear;
  for (std::uint32_t i = 0; i < query.known->count; ++i) {
    const std::uint32_t item = query.known->item[i], face = item & ~CellItems::kFace;
    stack_.push_back(item == face ? entry(item) : Entry{face, true, -kInfinity});
  }
}

CellSearch::Outcome CellSearch::find(const MovingHull& a, const std::array<Vec3, 3>* face_of_a, const Query& query,
                                     const Sweep& sweep, FreeCell& cell) noexcept {
  a_ = &a;
  face_of_a_ = face_of_a;
  sweep_ = &sweep;
  begin(query);
  for (int visits = 0; !stack_.empty(); ++visits) {
    const Entry e = stack_.back();
    stack_.pop_back();
    ++visits_;
    const bool enough = visits == kMostVisits && !query.is_face;
    const Outcome outcome = enough ? Outcome::divide : settle(e);
    if (outcome == Outcome::divide && !blocking_.empty()) return Outcome::blocked;
    if (outcome == Outcome::divide) list_rest(e);
    if (outcome != Outcome::found) return outcome;
  }
  if (!blocking_.empty()) return Outcome::blocked;
  if (passing_) return Outcome::passing;
  if (!listed_) items_.count = 0;
  cell.clear = items_.clear = clear_;
  cell.drop_planes();
  for (int k = 0; k < planes_; ++k) {
    cell.nx[k] = static_cast<float>(normal_[k].x());
    cell.ny[k] = static_cast<float>(normal_[k].y());
    cell.nz[k] = static_cast<float>(normal_[k].z());
    cell.offset[k] = round_up<float>(top_[k]);
  }
  return Outcome::found;
}

}  // namespace tegotae
