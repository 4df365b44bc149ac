#include "narrowphase/cell_front.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "core/numbers.hpp"
#include "core/prefetch.hpp"
#include "narrowphase/cell_slack.hpp"

namespace tegotae {
namespace {

/// Foresight takes pieces apart that are small enough for motions: beyond this part of the capacity there is none.
constexpr double kCrowded = 0.4;
/// Cells looked at between two looks at the clock, and anchors; nodes of B that count as one search.
constexpr int kClockStride = 8, kAskStride = 128, kVisitsPerSearch = 8;
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

/// The longest motion of late counts for this much less with every call.
constexpr double kMotionFades = 0.9;
/// One of so many cells that are used up is tried as a larger piece: that costs as much as to renew several.
constexpr int kGrowStride = 4;
/// Faces nearer than so many clearances are told when time ends before what blocks is found, and so many of them.
constexpr double kTouch = 10;
constexpr std::size_t kMostTold = 8;
/// A motion leads away from a plane when it makes more than this cosine with its normal, and from all when it does so
/// from this share of the planes.
constexpr double kLeadsAway = 0.2, kMostAway = 0.75;
/// The memory of a cell is asked for so many cells before it is needed.
constexpr std::uint32_t kCellsAhead = 4;

/// The face of B nearest to a piece of A at the search.
std::optional<std::uint32_t> nearest_face(const CellItems& items) {
  std::optional<std::uint32_t> best;
  float least = std::numeric_limits<float>::infinity();
  for (std::uint32_t i = 0; i < items.count; ++i) {
    if ((items.item[i] & CellItems::kFace) == 0 || !(items.distance[i] < least)) continue;
    best = items.item[i] & ~CellItems::kFace;
    least = items.distance[i];
  }
  return best;
}

}  // namespace

CellFront::CellFront(std::shared_ptr<const PatchTree> a, const Vec3& center, std::vector<FixedPart> fixed,
                     std::uint32_t capacity, std::uint32_t blocking)
    : a_(std::move(a)),
      center_(center),
      offset_a_(a_->origin() - center),
      reach_(0),
      pieces_(*a_),
      fixed_(std::move(fixed)),
      capacity_(capacity),
      root_(fixed_.size(), kNobody),
      asked_(fixed_.size(), 0),
      memory_(a_->mesh().triangles.size()),
      sweeps_(fixed_.size()),
      stamped_(fixed_.size(), 0),
      foreseen_(fixed_.size()),
      foreseen_stamped_(fixed_.size(), 0) {
  // Parts may have a mesh in common.
  std::map<const PatchTree*, std::shared_ptr<const PatchBatches>> made;
  for (const FixedPart& part : fixed_) {
    std::shared_ptr<const PatchBatches>& batches = made[part.tree.get()];
    if (!batches) batches = std::make_shared<const PatchBatches>(*part.tree);
    batches_.push_back(batches);
  }
  // Pages are not touched before they are used: a part of a million triangles has room for 1.6 GB of cells.
  nodes_.reserve(2 * std::size_t{capacity} + 2);
  slots_.reserve(capacity);
  items_.reserve(capacity);
  listed_.reserve(capacity);
  anchors_.reserve(capacity);
  expiry_.reserve(capacity);
  clear_until_.reserve(capacity);
  unsorted_.reserve(capacity);
  due_.reserve(capacity);
  for (const Vec3& v : a_->mesh().vertices) reach_ = std::max(reach_, (v - center_).norm());
  stack_.reserve(capacity);
  freed_.reserve(capacity);
  blocking_.reserve(blocking);
}

std::size_t CellFront::bytes() const {
  std::size_t of_trees = 0;
  for (std::size_t i = 0; i < batches_.size(); ++i)
    if (i == 0 || batches_[i] != batches_[i - 1]) of_trees += batches_[i]->bytes();
  return nodes_.capacity() * sizeof(Node) + memory_.bytes() + of_trees +
         capacity_ * (sizeof(Slot) + sizeof(CellItems) + sizeof(CellAnchor) + sizeof(CellCorridor) +
                      2 * sizeof(double) + 2 * sizeof(Due));
}

void CellFront::clear() noexcept {
  forget_cut();
  memory_.clear();
  started_ = false;
  travel_ = turned_ = motion_ = 0;
  cursor_ = 0;
}

void CellFront::forget_cut() noexcept {
  nodes_.clear();
  free_nodes_ = kNobody;
  slots_.clear();
  items_.clear();
  listed_.clear();
  anchors_.clear();
  expiry_.clear();
  clear_until_.clear();
  root_.assign(root_.size(), kNobody);
  nearest_ = kInfinity;
  begun_ = call_;
}

void CellFront::set_near(const std::vector<std::uint32_t>& near) noexcept {
  ++now_;
  for (const std::uint32_t part : near) {
    asked_[part] = now_;
    enter_root(part);
  }
}

/// Gives the part a cell for all of A, unless it has cells.
void CellFront::enter_root(std::uint32_t part) {
  if (root_[part] != kNobody || count() == capacity_) return;
  const std::uint32_t id = allocate();
  if (id == kNobody) return;
  root_[part] = id;
  nodes_[id] = {0, 0, part, kNobody, kNobody, kNobody, 0, false, false, 0, 0, 0};
  enter(id);
}

void CellFront::foresee(const Displacement& d) noexcept {
  foresight_ = d;
  kept_ = 1;
  foreseen_length_ = d.dp.norm() + reach_ * d.dr.norm();
}

CertifyReport CellFront::prove_ahead(const Pose& X, const Displacement& d, const WorkLimit& limit) noexcept {
  foresee({});
  const CertifyReport report = certify(X, d, limit);
  if (report.status == CertifyStatus::blocked)
    for (const FacePair& pair : blocking_) met_ = std::min(met_, free_until(pair.part, pair.a, pair.b, d));
  return report;
}

bool CellFront::crowded() const {
  return count() > kCrowded * capacity_;
}

CertifyReport CellFront::certify(const Pose& X, const Displacement& d, const WorkLimit& limit) noexcept {
  report_ = {};
  limit_ = limit;
  blocking_.clear();
  visits_at_start_ = search_.visits();
  start_motion(X, d);
  collect_due();
  settle_due();
  const bool creeps = carried_ > 0 && carried_ < clearance_;
  if (creeps && report_.exhausted && blocking_.empty() && past(limit_.deadline_ns)) tell_nearest();
  report_.searches = static_cast<int>((search_.visits() - visits_at_start_) / kVisitsPerSearch);
  if (!blocking_.empty()) {
    report_.status = CertifyStatus::blocked;
  } else if (report_.exhausted) {
    report_.status = CertifyStatus::out_of_budget;
  }
  if (report_.status == CertifyStatus::certified) report_.share = 1;
  raise();
  if (!ahead_ && report_.exhausted && blocking_.empty()) begin_anew_where_far();
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
  ++foresights_;
  const double theta2 = d.dr.squaredNorm();
  const double carried = d.dp.norm() + reach_ * std::sqrt(theta2) + center_.norm() * theta2 / 8;
  ahead_ = carried == 0;
  met_ = 1;
  if (!ahead_) {
    motion_ = std::max(kMotionFades * motion_, carried);
  }
  carried_ = carried;
  need_ = carried * (1 + kSumSlack) + clearance_ + kLengthSlack;
  report_.share = 1;
  settled_ = true;
}

/// The share of the motion that the cell allows without a look at it, by how far its planes and what they do not stand
/// for were when it was looked at last.
double CellFront::allowed(std::uint32_t slot) {
  const double floor = clearance_ + kLengthSlack;
  const Slot& s = slots_[slot];
  const Sweep& sweep = sweep_of(s.part);
  const AnchoredGap gap = anchored_gap(s.cell, anchors_[slot], sweep, turned_);
  const double planes = share(gap.start - floor, gap.end - floor, gap.bulge);
  double rest = 1, &clear_until = clear_until_[slot];
  if (planes > 0 && !(clear_until >= travel_ + need_)) {
    const CorridorLoss loss = corridor_loss(s.corridor, sweep, turned_);
    rest = share(s.cell.clear - loss.start - floor, s.cell.clear - loss.end - floor, loss.bulge);
    clear_until = std::max(clear_until, travel_ + kUnit * (s.cell.clear - loss.start));
  }
  expiry_[slot] = std::max(expiry_[slot], std::min(clear_until, travel_ + kUnit * gap.start));
  return std::clamp(std::min(planes, rest), 0.0, 1.0);
}

/// Has what allowed() will read of a slot brought near.
void CellFront::prefetch_allowed(std::uint32_t slot) const {
  prefetch(slots_[slot]);
  prefetch(anchors_[slot]);
}

void CellFront::collect_due() {
  unsorted_.clear();
  const double bound = travel_ + need_, least = travel_ + clearance_ + kLengthSlack;
  std::array<std::uint32_t, kGrades + 1> first{};
  int asked = 0;
  std::ptrdiff_t unasked = 0;
  bool late = false;
  for (std::uint32_t slot = 0; slot < count(); ++slot) {
    if (!(expiry_[slot] < bound)) continue;
    const std::uint32_t later = slot + kCellsAhead;
    if (!late && later < count() && expiry_[later] < bound) prefetch_allowed(later);
    if (asked_[slots_[slot].part] != now_) continue;
    const double straight = std::clamp((expiry_[slot] - least) / (bound - least), 0.0, 1.0);
    if (late && ++unasked > kFirst) {
      // Nobody will look at it.
      report_.share = std::min(report_.share, straight);
      continue;
    }
    const double share = late ? straight : std::max(straight, allowed(slot));
    if (++asked % kAskStride == 0) late = late || past(limit_.deadline_ns);
    if (share == 1) continue;
    const std::uint32_t id = slots_[slot].node;
    nodes_[id].due = call_;
    unsorted_.push_back({id, share});
    ++first[grade(share) + 1];
  }
  report_.exhausted = late;
  // By halvings of the share: those that allow least come first. Where the part touches something they find it, and
  // where time runs out before all have been looked at, the others allow more.
  for (int k = 0; k < kGrades; ++k) first[k + 1] += first[k];
  due_.resize(unsorted_.size());
  for (const Due& due : unsorted_) due_[first[grade(due.share)]++] = due;
}

void CellFront::settle_due() {
  const auto begin = due_.begin(), end = due_.end();
  const auto first = begin + std::min<std::ptrdiff_t>(kFirst, end - begin);
  int visited = 0;
  for (auto it = begin; it != end; ++it) {
    // What blocks is known: the others may wait.
    if (it == first && !blocking_.empty()) settled_ = false;
    if (settled_ && ++visited % kClockStride == 0 && out_of_work(true)) {
      settled_ = false;
      report_.exhausted = true;
    }
    // A cell for the piece and its neighbors may have taken its place.
    if (nodes_[it->node].due != call_) continue;
    if (!settled_) {
      report_.share = std::min(report_.share, it->share);
      continue;
    }
    const CellState state = state_of(it->node);
    if (state.free) continue;
    const bool grows = state.far && visited % kGrowStride == 0 && grow(it->node, state.margin);
    if (grows || (state.far && renew(it->node, state.margin))) continue;
    const Outcome outcome = settle(it->node);
    if (outcome == Outcome::free) continue;
    report_.share = std::min(report_.share, std::max(it->share, state.share));
    if (outcome == Outcome::out_of_work) report_.exhausted = true;
    settled_ =
        outcome == Outcome::blocked && blocking_.size() < limit_.blocking && blocking_.size() < blocking_.capacity();
  }
}

/// A part that creeps, since time ends before anything is found that blocks, may lie on what is nearest. Some of that
/// is told as if it blocked, so that contacts are looked for there: else the last micrometer takes as long as all
/// cells.
void CellFront::tell_nearest() {
  const double near = travel_ + kTouch * clearance_;
  for (const Due& due : due_) {
    const Node& node = nodes_[due.node];
    if (node.due != call_ || !node.face_a || !(expiry_[node.slot] < near)) continue;
    const auto face = nearest_face(items_[node.slot]);
    if (!face) continue;
    blocking_.push_back({node.part, node.a, *face});
    if (blocking_.size() == std::min<std::size_t>({kMostTold, limit_.blocking, blocking_.capacity()})) return;
  }
}

CellFront::CellState CellFront::state_of(std::uint32_t id) {
  const Node& node = nodes_[id];
  const Slot& s = slots_[node.slot];
  if (!(s.cell.clear > -kInfinity)) return {false, false, 0, 0};
  const double floor = clearance_ + kLengthSlack;
  const Sweep& sweep = sweep_of(node.part);
  const CorridorLoss loss = corridor_loss(s.corridor, sweep, turned_);
  const double clear = s.cell.clear - loss.start;
  const CellVerdict v = check_cell(s.cell, hull(node, sweep), sweep);
  clear_until_[node.slot] = std::max(clear_until_[node.slot], travel_ + kUnit * clear);
  expiry_[node.slot] = std::max(expiry_[node.slot], std::min(clear_until_[node.slot], travel_ + kUnit * v.margin));
  anchor(id, v.gaps);
  const double far = share(clear - floor, s.cell.clear - loss.end - floor, loss.bulge);
  return {v.free && far == 1, v.free, std::min(v.share, far), v.margin};
}

bool CellFront::out_of_work(bool read_clock) {
  if ((search_.visits() - visits_at_start_) / kVisitsPerSearch > limit_.searches) return true;
  return read_clock && past(limit_.deadline_ns);
}

bool CellFront::leads_away(const Vec3& dp) const noexcept {
  const double length = dp.norm();
  const std::uint32_t stride = count() / kSample + 1;
  int planes = 0, away = 0;
  for (std::uint32_t slot = 0; slot < count(); slot += stride) {
    const Slot& s = slots_[slot];
    const Vec3 way = fixed_[s.part].pose.q.conjugate() * dp;
    for (int k = 0; k < kCellPlanes; ++k) {
      if (s.cell.offset[k] == std::numeric_limits<float>::lowest()) continue;
      ++planes;
      away += s.cell.normal(k).dot(way) > kLeadsAway * length;
    }
  }
  return planes > 0 && away > kMostAway * planes;
}

double CellFront::one_sidedness(std::uint32_t part) const noexcept {
  Vec3 to_a = Vec3::Zero();
  int planes = 0;
  for (const Slot& slot : slots_) {
    if (nodes_[slot.node].part != part) continue;
    for (int k = 0; k < kCellPlanes; ++k) {
      if (slot.cell.offset[k] == std::numeric_limits<float>::lowest()) continue;
      to_a += slot.cell.normal(k);
      ++planes;
    }
  }
  return planes > 0 ? to_a.norm() / planes : 0;
}

}  // namespace tegotae
