#include "narrowphase/cell_front.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tegotae {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Lengths that were added up are rounded by less (relative, m, and rad).
constexpr double kSumSlack = 1e-9, kLengthSlack = 1e-11, kAngleSlack = 1e-14;
/// Normals are kept in single precision: a gap along one is no more than this part too long.
constexpr double kUnit = 1 - 1e-6;
/// What is farther from a piece than this part of its width, or so many motions, needs no plane.
constexpr double kWantedShare = 0.6, kWantedMotions = 4;
/// What no plane stands for is far enough away without planes while this part of what is wanted is left.
constexpr double kRenewShare = 0.5;
/// The pieces of B that a cell lists are enough for a new search while the rest is this part of what is wanted away.
constexpr double kKnownShare = 0.5;
/// Cells looked at between two looks at the clock, and anchors; nodes of B that count as one search.
constexpr int kClockStride = 8, kAskStride = 256, kVisitsPerSearch = 8;
/// So many cells that allow least of the motion are looked at in any case.
constexpr std::ptrdiff_t kFirst = 64;
/// Cells are sorted by how often the share of the motion that they allow has to be doubled, up to so many times, and in
/// eighths of that.
constexpr int kOctaves = 24, kEighths = 8, kGrades = kOctaves * kEighths;

int grade(double share) {
  if (!(share > 0)) return 0;
  int exponent = 0;
  const double part = std::frexp(share, &exponent);  // of a half to one
  const int eighth = static_cast<int>(2 * kEighths * (part - 0.5));
  return std::clamp(kEighths * (kOctaves - 1 + exponent) + eighth, 0, kGrades - 1);
}

/// One call tries to put together so many pairs of children, and one for so many searches, among so many it looks at.
constexpr int kMinRaises = 4, kSearchesPerRaise = 3, kMaxLooks = 256;
/// A cell for both children together must last for so many of the longest motions of late, or this share of what the
/// children's cells last for.
constexpr double kRaiseMotions = 8, kRaiseShare = 0.5, kMotionFades = 0.9;
/// Pieces that could not be put together are tried again when they are so many times as far from B, and at least this
/// share of their size.
constexpr double kRetryGrowth = 1.4, kRetryShare = 0.01;
/// A piece that was taken apart at rest, for a clearance that no motion needed yet, is tried again at this share of it.
constexpr double kAheadRetry = 0.25;
/// One of so many cells that are used up is tried as a larger piece: that costs as much as to renew several.
constexpr int kGrowStride = 4;
/// So many larger pieces are tried in the place of one whose cell is used up.
constexpr int kMaxGrowths = 2;

}  // namespace

CellFront::CellFront(std::shared_ptr<const PatchTree> a, const Vec3& center, std::vector<FixedPart> fixed,
                     std::uint32_t capacity, std::uint32_t blocking)
    : a_(std::move(a)),
      center_(center),
      offset_a_(a_->origin() - center),
      reach_(0),
      fixed_(std::move(fixed)),
      capacity_(capacity),
      nodes_(2 * std::size_t{capacity} + 2),
      slots_(capacity),
      items_(capacity),
      listed_(capacity),
      anchors_(capacity),
      expiry_(capacity),
      root_(fixed_.size(), kNobody),
      asked_(fixed_.size(), 0),
      sweeps_(fixed_.size()),
      stamped_(fixed_.size(), 0),
      unsorted_(capacity),
      due_(capacity) {
  for (const Vec3& v : a_->mesh().vertices) reach_ = std::max(reach_, (v - center_).norm());
  stack_.reserve(capacity);
  freed_.reserve(capacity);
  blocking_.reserve(blocking);
}

std::size_t CellFront::bytes() const {
  return nodes_.size() * sizeof(Node) +
         slots_.size() * (sizeof(Slot) + sizeof(CellItems) + sizeof(CellAnchor) + 2 * sizeof(double) + 2 * sizeof(Due));
}

void CellFront::set_near(const std::vector<std::uint32_t>& near) noexcept {
  ++now_;
  for (const std::uint32_t part : near) {
    asked_[part] = now_;
    if (root_[part] != kNobody || count_ == capacity_) continue;
    const std::uint32_t id = allocate();
    if (id == kNobody) continue;
    root_[part] = id;
    nodes_[id] = {0, 0, part, kNobody, kNobody, kNobody, 0, false, false, 0, 0, 0};
    enter(id, Slot{id, -kInfinity, {}}, {}, {}, -kInfinity);
  }
}

CertifyReport CellFront::certify(const Pose& X, const Displacement& d, const WorkLimit& limit) noexcept {
  report_ = {};
  limit_ = limit;
  blocking_.clear();
  visits_at_start_ = search_.visits();
  start_motion(X, d);
  collect_due();
  settle_due();
  report_.searches = static_cast<int>((search_.visits() - visits_at_start_) / kVisitsPerSearch);
  if (!blocking_.empty()) {
    report_.status = CertifyStatus::blocked;
  } else if (report_.exhausted) {
    report_.status = CertifyStatus::cut;
  }
  if (report_.status == CertifyStatus::certified) report_.share = 1;
  raise();
  report_.pairs = cells();
  return report_;
}

void CellFront::start_motion(const Pose& X, const Displacement& d) {
  if (started_ && (X.p != X_.p || X.q.coeffs() != X_.q.coeffs())) {
    const Displacement moved = displacement(X_, X, center_);
    travel_ += (moved.dp.norm() + reach_ * moved.dr.norm()) * (1 + kSumSlack) + kLengthSlack;
    turned_ += moved.dr.norm() * (1 + kSumSlack) + kAngleSlack;
  }
  started_ = true;
  X_ = X;
  d_ = d;
  ++call_;
  const double theta2 = d.dr.squaredNorm();
  const double carried = d.dp.norm() + reach_ * std::sqrt(theta2) + center_.norm() * theta2 / 8;
  ahead_ = carried == 0;
  if (!ahead_) motion_ = std::max(kMotionFades * motion_, carried);
  need_ = carried * (1 + kSumSlack) + clearance_ + kLengthSlack;
  report_.share = 1;
  settled_ = true;
}

const Sweep& CellFront::sweep_of(std::uint32_t part) {
  if (stamped_[part] != call_) {
    stamped_[part] = call_;
    const FixedPart& B = fixed_[part];
    const Quat q_BW = B.pose.q.conjugate();
    sweeps_[part] = Sweep(B.pose.inverse() * X_, {q_BW * d_.dp, q_BW * d_.dr}, center_, *B.tree,
                          a_->radius() + offset_a_.norm(), clearance_);
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

double CellFront::wanted(const MovingHull& a) const {
  return std::max({2 * need_, kWantedMotions * motion_, kWantedShare * a.width});
}

/// The share of the motion that the cell allows without a look at it, by how far its planes and what they do not stand
/// for were when it was looked at last.
double CellFront::allowed(std::uint32_t slot) {
  const double floor = clearance_ + kLengthSlack, clear = slots_[slot].clear_until - travel_;
  const Sweep& sweep = sweep_of(nodes_[slots_[slot].node].part);
  const AnchoredGap gap = anchored_gap(slots_[slot].cell, anchors_[slot], sweep, turned_);
  double& expiry = expiry_[slot];
  expiry = std::max(expiry, std::min(slots_[slot].clear_until, travel_ + kUnit * gap.start));
  const double alpha = gap.start - floor, beta = gap.end - floor;
  double planes = 1;
  if (!(std::min(alpha, beta) >= gap.bulge)) planes = alpha > 0 ? share_of(alpha, beta, gap.bulge) : 0;
  const double far = clear >= need_ ? 1 : (clear - floor) / (need_ - floor);
  return std::clamp(std::min(planes, far), 0.0, 1.0);
}

void CellFront::collect_due() {
  due_count_ = 0;
  const double bound = travel_ + need_, least = travel_ + clearance_ + kLengthSlack;
  std::array<std::uint32_t, kGrades + 1> first{};
  int asked = 0;
  bool late = false;
  for (std::uint32_t slot = 0; slot < count_; ++slot) {
    if (!(expiry_[slot] < bound)) continue;
    const std::uint32_t id = slots_[slot].node;
    if (asked_[nodes_[id].part] != now_) continue;
    const double straight = std::clamp((expiry_[slot] - least) / (bound - least), 0.0, 1.0);
    if (++asked % kAskStride == 0) late = late || past(limit_.deadline_ns);
    const double share = late ? straight : std::max(straight, allowed(slot));
    if (share == 1) continue;
    nodes_[id].due = call_;
    unsorted_[due_count_++] = {id, share};
    ++first[grade(share) + 1];
  }
  // By halvings of the share: those that allow least come first. Where the part touches something they find it, and
  // where time runs out before all have been looked at, the others allow more.
  for (int k = 0; k < kGrades; ++k) first[k + 1] += first[k];
  for (std::size_t i = 0; i < due_count_; ++i) due_[first[grade(unsorted_[i].share)]++] = unsorted_[i];
}

void CellFront::settle_due() {
  const auto begin = due_.begin(), end = begin + static_cast<std::ptrdiff_t>(due_count_);
  const auto first = begin + std::min<std::ptrdiff_t>(kFirst, end - begin);
  int looked = 0;
  for (auto it = begin; it != end; ++it) {
    // What blocks is known: the others may wait.
    if (it == first && !blocking_.empty()) settled_ = false;
    if (settled_ && ++looked % kClockStride == 0 && out_of_work(true)) {
      settled_ = false;
      report_.exhausted = true;
    }
    // A cell for the piece and its neighbors may have taken its place.
    if (nodes_[it->node].due != call_) continue;
    if (!settled_) {
      report_.share = std::min(report_.share, it->share);
      continue;
    }
    const Look look = look_at(it->node);
    if (look.free) continue;
    const bool grows = look.far && looked % kGrowStride == 0 && grow(it->node, look.margin);
    if (grows || (look.far && renew(it->node, look.margin))) continue;
    const Outcome outcome = settle(it->node);
    if (outcome == Outcome::free) continue;
    report_.share = std::min(report_.share, std::max(it->share, look.share));
    if (outcome == Outcome::out_of_work) report_.exhausted = true;
    settled_ =
        outcome == Outcome::blocked && blocking_.size() < limit_.blocking && blocking_.size() < blocking_.capacity();
  }
}

CellFront::Look CellFront::look_at(std::uint32_t id) {
  const Node& node = nodes_[id];
  Slot& s = slots_[node.slot];
  const double clear = s.clear_until - travel_, floor = clearance_ + kLengthSlack;
  if (!(clear > floor)) return {false, true, 0, std::max(0.0, expiry_[node.slot] - travel_)};
  const Sweep& sweep = sweep_of(node.part);
  const CellVerdict v = check_cell(s.cell, hull(node, sweep), sweep);
  double& expiry = expiry_[node.slot];
  expiry = std::max(expiry, std::min(s.clear_until, travel_ + kUnit * v.margin));
  anchor(id, v.gaps);
  const double far = clear >= need_ ? 1 : (clear - floor) / (need_ - floor);
  return {v.free && clear >= need_, v.free, std::min(v.share, far), v.margin};
}

/// Whether what the cell's planes do not stand for is far enough away for the motion, by a new look at it alone.
bool CellFront::renew(std::uint32_t id, double margin) {
  const Node& node = nodes_[id];
  const MovingHull a = hull(node, sweep_of(node.part));
  const double enough = std::max(2 * need_, kRenewShare * wanted(a));
  double clear = 0;
  if (!search_.renew(a, *fixed_[node.part].tree, travel_ - listed_[node.slot], enough, items_[node.slot], clear))
    return false;
  Slot& s = slots_[node.slot];
  s.clear_until = travel_ + kUnit * clear;
  expiry_[node.slot] = std::min(s.clear_until, travel_ + kUnit * margin);
  return true;
}

bool CellFront::out_of_work(bool look_at_clock) {
  if ((search_.visits() - visits_at_start_) / kVisitsPerSearch > limit_.searches) return true;
  return look_at_clock && past(limit_.deadline_ns);
}

CellSearch::Outcome CellFront::search(std::uint32_t id) {
  const Node& node = nodes_[id];
  const Sweep& sweep = sweep_of(node.part);
  const MovingHull a = hull(node, sweep);
  if (node.face_a)
    for (int k = 0; k < 3; ++k) face_[k] = a_->corner(node.a, k) - center_;
  CellSearch::Query query{fixed_[node.part].tree.get(), node.b, node.face_b, wanted(a)};
  if (node.children == 0) {
    const CellItems& items = items_[node.slot];
    query.moved = travel_ - listed_[node.slot];
    if (items.count > 0 && items.clear - query.moved >= kKnownShare * query.wanted) query.known = &items;
  }
  return search_.find(a, node.face_a ? &face_ : nullptr, query, sweep, found_);
}

void CellFront::anchor(std::uint32_t id, const CellGaps& gaps) {
  const Node& node = nodes_[id];
  Vec3 middle;
  if (node.face_a) {
    middle = (a_->corner(node.a, 0) + a_->corner(node.a, 1) + a_->corner(node.a, 2)) / 3 - center_;
  } else {
    middle = a_->nodes()[node.a].center_vec() + offset_a_;
  }
  anchors_[node.slot] = CellAnchor(gaps, middle, radius(node), sweep_of(node.part), turned_);
}

void CellFront::keep(std::uint32_t id) {
  const std::uint32_t slot = nodes_[id].slot;
  Slot& s = slots_[slot];
  s.cell = found_;
  items_[slot] = search_.items();
  listed_[slot] = travel_;
  s.clear_until = travel_ + kUnit * found_.clear;
  expiry_[slot] = std::min(s.clear_until, travel_ + kUnit * search_.margin());
  anchor(id, search_.gaps());
  // The larger pieces that were just taken apart need it at this distance.
  for (std::uint32_t up = nodes_[id].parent; up != kNobody; up = nodes_[up].parent) {
    if (nodes_[up].retry < kInfinity && nodes_[up].split != call_) break;
    const double before = nodes_[up].retry;
    needs_parts(up, ahead_ ? kAheadRetry * search_.margin() : search_.margin());
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
    switch (search(id)) {
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

std::uint32_t CellFront::allocate() {
  if (free_nodes_ != kNobody) {
    const std::uint32_t id = free_nodes_;
    free_nodes_ = nodes_[id].child;
    return id;
  }
  if (nodes_used_ + 2 > nodes_.size()) return kNobody;
  nodes_used_ += 2;
  return nodes_used_ - 2;
}

void CellFront::release(std::uint32_t child) {
  nodes_[child].child = free_nodes_;
  free_nodes_ = child;
}

void CellFront::enter(std::uint32_t id, const Slot& inherited, const CellItems& items, const CellAnchor& anchor,
                      double expiry) {
  nodes_[id].slot = count_;
  slots_[count_] = inherited;
  slots_[count_].node = id;
  items_[count_] = items;
  listed_[count_] = travel_;
  anchors_[count_] = anchor;
  expiry_[count_++] = expiry;
}

void CellFront::leave(std::uint32_t slot) {
  const std::uint32_t last = --count_;
  if (slot == last) return;
  slots_[slot] = slots_[last];
  items_[slot] = items_[last];
  listed_[slot] = listed_[last];
  anchors_[slot] = anchors_[last];
  expiry_[slot] = expiry_[last];
  nodes_[slots_[slot].node].slot = slot;
}

bool CellFront::split(std::uint32_t id) {
  const Node p = nodes_[id];
  const bool of_a = !p.face_a;
  const PatchNode& whole = of_a ? a_->nodes()[p.a] : fixed_[p.part].tree->nodes()[p.b];
  const PatchTree& tree = of_a ? *a_ : *fixed_[p.part].tree;
  const std::uint32_t children = whole.leaf() ? whole.count : 2;
  if (count_ + children > capacity_) return false;
  const std::uint32_t child = allocate();
  if (child == kNobody) return false;
  // What was known of the whole holds for its parts.
  const Slot known = slots_[p.slot];
  // The pieces of B that are listed are of both its parts.
  CellItems items;
  if (of_a) items = search_.items();
  const CellAnchor anchor = anchors_[p.slot];
  const double expiry = expiry_[p.slot];
  leave(p.slot);
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
    enter(child + k, known, items, anchor, expiry);
  }
  return true;
}

void CellFront::raise() {
  const int most = kMinRaises + report_.searches / kSearchesPerRaise;
  int tries = 0;
  for (int looks = std::min<int>(kMaxLooks, cells()); looks > 0 && tries < most; --looks) {
    if (++cursor_ >= count_) cursor_ = 0;
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
  if (near && (search(id) != CellSearch::Outcome::found || search_.margin() < enough)) {
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
  enter(id, Slot{id, -kInfinity, {}}, {}, {}, -kInfinity);
  if (near) keep(id);
  ++report_.merges;
  return true;
}

}  // namespace tegotae
