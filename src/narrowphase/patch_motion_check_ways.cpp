// Motions that are looked at as a whole, where cells and fronts would take longer, and the ways that are proved so.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "narrowphase/patch_motion_check.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// A goes along a way that is proved where that leaves no more than this share of what is wanted.
constexpr double kWayLeaves = 0.5;
// What touches does so where it leaves no more than this share of the gap that counts as contact.
constexpr double kSlideLeaves = 0.25;
// Where fronts are asked about each motion, it keeps to the way where that leaves no more than this.
constexpr double kBesideWay = 0.1;
// Near parts that are no bundle, at most: all lists are gone through for each of them.
constexpr std::size_t kMostSwept = 256;
// The pen keeps its direction up to this cosine.
constexpr double kSameWay = 0.95;
// The ticks that the pen takes to come as far as whole blocks of faces are to prove at least, of a part of no more than
// some faces and for each face: about as long as the look at all faces takes. No less than this share of what is
// wanted, and no more than that of all that is looked at. Fewer faces are looked at one by one.
constexpr double kWorthTicks = 2, kWorthTicksPerFace = 1e-4;
constexpr double kWorthOfWanted = 0.7, kWorthOfAll = 0.7;
constexpr std::size_t kManyFaces = 1U << 12;
// What a few faces tell to be in the way is come to as near as this share of the gap that counts as contact.
constexpr double kKeptOfContact = 0.6;
// What a few faces meet after a way of so many times the gap that explains a lag is told before the look is done.
constexpr double kNearTold = 4;
// Ticks in which fronts of threads and bores get over a jam.
constexpr int kTicksJammed = 16;
// Ticks after which fronts of threads and bores that were behind are asked again.
constexpr std::uint64_t kTicksOffAxes = 16;
// Turns of one kind after which the other is tried.
constexpr int kTurnsInARow = 6;
// Ticks for which looks are taken to be slow that were so once.
constexpr std::uint64_t kSlowTicks = 500;
// Ticks in which a look may wait for its turn to begin.
constexpr int kTurnWaits = 8;
// How often a look may wait until it is known what is outside what.
constexpr int kWaitsForSides = 4;
// How often as long as a look cells have the time where the pen stands.
constexpr std::uint64_t kPatience = 4;
// How often at one place a few faces that met something are enough.
constexpr int kMostBlocked = 8;

}  // namespace

void PatchMotionCheck::heads(const Heading& heading) noexcept {
  if (heading.whole != heading_.whole) sweeping_ = looks_ahead_ = false;
  heading_ = heading;
}

bool PatchMotionCheck::sweeps(const Pose& X, const Displacement& d) const noexcept {
  if (!may_sweep() || !line_.is_on(X) || !covers_near(line_.parts())) return false;
  // Away from what it touches, the way is another one, and looked at in no time.
  if (line_touches_ && !heading_.touches) return false;
  const Displacement& other = line_.motion();
  return product(d, other) > 0;
}

void PatchMotionCheck::look_at(const Pose& X, const Displacement& d, double clearance, double worth) noexcept {
  SweepAim aim{clearance, worth, kKeptOfContact * heading_.contact_gap};
  if (!heading_.touches && held_->mesh().triangles.size() >= kManyFaces) {
    aim.kept_far = kKeptOfContact * heading_.near_gap;
    aim.far = heading_.near_gap;
    aim.near_within = kNearTold * heading_.near_gap;
  }
  if (heading_.touches && blocked_.count < kMostBlocked) aim.blocked_within = heading_.contact_gap;
  if (heading_.whole) aim.blocked_within = size(d);
  aim.drawn = drawn_for(X, d);
  sweep_->begin(X, d, swept_, outside_, aim);
  line_.set(X, d, swept_);
  line_touches_ = heading_.touches;
  near_told_ = false;
}

void PatchMotionCheck::count_still(const Pose& X) noexcept {
  if (still_since_ == now_) return;
  still_since_ = now_;
  const bool still = behind_for_ > 0 && size(displacement(still_X_, X, center_)) < kStill;
  still_for_ = still ? still_for_ + 1 : 0;
  if (!still) still_X_ = X;
}

/// Cells have as many ticks as the last sweep, then whoever was faster; the other one is tried again now and then.
void PatchMotionCheck::take_turns(const Pose& X) noexcept {
  if (turn_.since == now_) return;
  turn_.since = now_;
  const double moved = size(displacement(turn_.X, X, center_));
  turn_.X = X;
  if (!heading_.touches || behind_for_ < kTicksBehind) {
    turn_.ticks = 0;
    turn_.moved = 0;
    return;
  }
  turn_.moved += moved;
  ++turn_.ticks;
  if (turn_.of_cells ? static_cast<std::uint64_t>(turn_.ticks) < swept_for_ : sweeping_ || turn_.ticks < kTurnWaits)
    return;
  (turn_.of_cells ? turn_.cells_pace : turn_.sweeps_pace) = turn_.moved / turn_.ticks;
  const bool cells = (turn_.cells_pace > turn_.sweeps_pace) != (turn_.in_a_row >= kTurnsInARow);
  turn_.in_a_row = cells == turn_.of_cells ? turn_.in_a_row + 1 : 0;
  turn_.of_cells = cells;
  turn_.ticks = 0;
  turn_.moved = 0;
}

/// Where what touches still stands after it was looked at as a whole, cells are to have the time: for as long as that
/// took where the pen moves on, and some times as long where it stands.
bool PatchMotionCheck::rests(const Pose& X, const Displacement& d) const noexcept {
  if (size(d) < kStill) return true;
  if (!heading_.touches || size(displacement(swept_from_, X, center_)) > kStill) return false;
  if (!(size(heading_.pen) > kStands)) return now_ < swept_until_ + kPatience * swept_for_;
  return now_ < swept_until_ + swept_for_ && same_way(d, swept_motion_);
}

/// Threads have bursts of pairs. Their fronts get over them, since they keep what they take apart, but not in what
/// looks leave of ticks.
bool PatchMotionCheck::all_in_threads() const noexcept {
  const auto in_thread = [this](std::uint32_t part) { return fronts_[front_of_[part]].in_thread(); };
  return near_cells_.empty() && std::all_of(near_fronts_.begin(), near_fronts_.end(), in_thread);
}

bool PatchMotionCheck::may_sweep() const noexcept {
  return sweep_ && limit_.deadline_ns != kNoDeadline && others_ == OtherParts::far &&
         (bundled_ || near_.size() <= kMostSwept) && !all_in_threads();
}

bool PatchMotionCheck::all_on_axes() const noexcept {
  return std::all_of(near_fronts_.begin(), near_fronts_.end(),
                     [this](std::uint32_t part) { return !axes_[part]->empty(); });
}

/// Fronts of what jams in a bore get over it in some ticks, if they are left the time. Looks at all of it would leave
/// them a third, and so take their place for good.
int PatchMotionCheck::ticks_behind() const noexcept {
  if (heading_.whole) return 1;
  const bool jams = heading_.touches && near_cells_.empty() && all_on_axes() && !stands_still();
  return jams ? kTicksJammed : kTicksBehind;
}

/// What touches goes on by short motions in many directions. Fronts know better, as long as they are not behind; those
/// of threads and bores are so for a moment only, and who goes along a way does not ask them.
bool PatchMotionCheck::may_go_along() const noexcept {
  const bool fronts_behind = behind_ && (!all_on_axes() || now_ <= behind_since_ + kTicksOffAxes);
  return may_sweep() && trusted_ && !heading_.touches && (!near_cells_.empty() || fronts_behind);
}

bool PatchMotionCheck::at_end_of_way(const Pose& X) const noexcept {
  return !ways_.empty() && ways_.first().way.is_on(X) && ways_.first().way.ends_at(X);
}

/// Of large parts, fronts may be behind as soon as they touch, but for threads and bores: on those they keep up, or
/// tell before, and a look at a way along them would take all the time that ticks leave over.
bool PatchMotionCheck::may_look_ahead() const noexcept {
  const auto may_be_behind = [&] {
    return held_->mesh().triangles.size() >= kManyFaces && (fronts_busy_ || !all_on_axes());
  };
  return may_sweep() && trusted_ && !heading_.touches && (may_go_along() || may_be_behind());
}

/// What touches and was looked at as a whole goes on along that way while contacts let it go where that leads, but for
/// what nobody feels: most of the ticks of a part that slides need no look.
bool PatchMotionCheck::slides_along(const Pose& X, const Displacement& d) noexcept {
  // What stands asks for what is near, not for a way.
  if (!behind_ || !may_sweep() || !trusted_ || ways_.empty() || size(d) < kStill) return false;
  ways_.come_to(X);
  const ProvedWay& way = ways_.first().way;
  const auto along = way.toward(X, d);
  if (!along || !covers_near(way.parts())) return false;
  if (left_of(X, d, *along) > std::min(kWayLeaves * size(d), kSlideLeaves * heading_.contact_gap)) return false;
  instead_ = along;
  return true;
}

bool PatchMotionCheck::goes_along(const Pose& X, const Displacement& d, std::vector<FacePair>& blocking) noexcept {
  if (heading_.touches) return slides_along(X, d);
  if (!may_look_ahead()) return false;
  ways_.come_to(X);
  if (!may_go_along() || ways_.empty()) return false;
  const auto& [way, met] = ways_.first();
  const auto along = way.toward(X, d);
  if (!along || !covers_near(way.parts())) return false;
  // Near the end, what nearly touches turns a motion away from the way: it is come to all the same, and where the next
  // way is looked at that begins there.
  const bool leads_on = !met.empty() || ways_.lead_on() || (looks_ahead_ && line_.is_on(way.end()));
  const bool to_end = way.ends_at(displaced(X, center_, *along));
  const bool arrives = leads_on && !way.done() && size(*along) > kStands && to_end;
  if (left_of(X, d, *along) > kWayLeaves * size(d) && !arrives) return false;
  if (to_end) tell(met, blocking);
  forget_small_cells(*along);
  instead_ = along;
  return true;
}

std::optional<Displacement> PatchMotionCheck::onto_way(const Pose& X, const Displacement& d) const noexcept {
  if (!may_look_ahead()) return std::nullopt;
  const double most = may_go_along() ? kWayLeaves : kBesideWay;
  for (const ProvedWay* way : {&ways_.first().way, &line_}) {
    if (!(way == &line_ ? looks_ahead_ : !ways_.empty()) || !covers_near(way->parts())) continue;
    const auto onto = way->join(X, d);
    if (onto && left_of(X, d, *onto) <= most * size(d)) return onto;
  }
  return std::nullopt;
}

double PatchMotionCheck::left_of(const Pose& X, const Displacement& d, const Displacement& made) const noexcept {
  return size(displacement(displaced(X, center_, made), displaced(X, center_, d), center_));
}

bool PatchMotionCheck::covers_near(const std::vector<std::uint32_t>& parts) const noexcept {
  const auto has = [&parts](std::uint32_t part) { return std::find(parts.begin(), parts.end(), part) != parts.end(); };
  const bool all = bundle_ && has(static_cast<std::uint32_t>(fixed_.size()));
  return std::all_of(near_.begin(), near_.end(),
                     [&](std::uint32_t part) { return (all && bundle_->has(part)) || has(part); });
}

bool PatchMotionCheck::find_swept(const Pose& X, const Pose& from, const Displacement& d) noexcept {
  bool all_known = true;
  const auto nothing_inside = [&](std::uint32_t part) {
    if (!trusted_) return false;
    const bool known = sides_[part].known || !past(limit_.deadline_ns);
    all_known = all_known && known;
    return known && sides_of(part, X).b_outside;
  };
  swept_.clear();
  outside_.clear();
  if (bundle_) {
    bool outside = true;
    for (std::uint32_t part = 0; part < fixed_.size() && outside; ++part)
      if (bundle_->has(part)) outside = nothing_inside(part);
    swept_.push_back(static_cast<std::uint32_t>(fixed_.size()));
    outside_.push_back(outside);
  }
  const double reach = size(d) + radius_;
  for (std::uint32_t part = 0; part < fixed_.size(); ++part) {
    if (bundle_ && bundle_->has(part)) continue;
    const double far = (poses_[part] * fixed_[part]->origin() - from * center_).norm() - fixed_[part]->radius();
    const bool near = std::find(near_.begin(), near_.end(), part) != near_.end();
    if (!near && (far > reach || left_out_[part])) continue;
    swept_.push_back(part);
    outside_.push_back(nothing_inside(part));
  }
  // What is not known to recede takes more time than the wait for some ticks that tell. Not again: they may have none.
  if (!all_known && waits_for_sides_ < kWaitsForSides) {
    ++waits_for_sides_;
    return false;
  }
  return std::all_of(swept_.begin(), swept_.end(), [this](std::uint32_t part) { return sweep_->knows(part); });
}

std::optional<Backing::Side> PatchMotionCheck::drawn_for(const Pose& from, const Displacement& d) const noexcept {
  if (!backing_ || !trusted_) return std::nullopt;
  const double along = backing_->drawn(Backing::Side::plus).dot(from.q.conjugate() * d.dp);
  if (along == 0) return std::nullopt;
  const Backing::Side side = along > 0 ? Backing::Side::plus : Backing::Side::minus;
  // Once for all points: an assembly has thousands of parts.
  const Pose to_held = from.inverse();
  const Mat3 R = to_held.q.toRotationMatrix();
  const auto outside = [&](std::uint32_t part) {
    const auto& points = bodies_[part].points;
    return !points.empty() && std::all_of(points.begin(), points.end(),
                                          [&](const Vec3& p) { return backing_->outside(R * p + to_held.p, side); });
  };
  for (const std::uint32_t part : swept_) {
    if (part < fixed_.size() && !outside(part)) return std::nullopt;
    for (std::uint32_t i = 0; part == fixed_.size() && i < fixed_.size(); ++i)
      if (bundle_->has(i) && !outside(i)) return std::nullopt;
  }
  return side;
}

bool PatchMotionCheck::same_way(const Displacement& a, const Displacement& b) const noexcept {
  return product(a, b) > kSameWay * std::sqrt(product(a, a) * product(b, b));
}

double PatchMotionCheck::look_ticks() const {
  return kWorthTicks + kWorthTicksPerFace * static_cast<double>(held_->mesh().triangles.size()) / (1 + helpers_);
}

double PatchMotionCheck::beside_pen(const Displacement& d) const noexcept {
  const Displacement& pen = heading_.pen;
  const double along = product(d, pen) / std::max(product(pen, pen), kStands * kStands);
  return size({d.dp - along * pen.dp, d.dr - along * pen.dr});
}

bool PatchMotionCheck::begin_sweep(const Pose& X, const Displacement& d, double clearance) noexcept {
  // It takes as long however far it goes, and meanwhile the pen goes on. Aside, contacts may be in the way of that, and
  // where something touches, they let A go where `d` leads.
  double ticks = 0;
  if (!heading_.whole && (!heading_.touches || same_way(d, heading_.pen))) {
    // From beside the pen's way, to where the pen will be by then.
    ticks = same_way(d, heading_.pen) && beside_pen(d) <= heading_.near_gap ? kSweptTicks : soon();
    ticks = std::min(ticks, kLongestSweep * radius_ / std::max(size(heading_.pen), kStands));
  }
  Displacement all = heading_.touches ? (1 + ticks * size(heading_.pen) / std::max(size(d), kStands)) * d
                                      : Displacement{d.dp + ticks * heading_.pen.dp, d.dr + ticks * heading_.pen.dr};
  // Where the pen comes back past A meanwhile, what is in the way now has to be known, and sweeps() goes on with that.
  if (!(product(all, d) > 0)) all = d;
  if (!find_swept(X, X, all)) return false;
  look_at(X, all, clearance, worth(d, all));
  return true;
}

double PatchMotionCheck::worth(const Displacement& wanted, const Displacement& all) const noexcept {
  const std::size_t faces = held_->mesh().triangles.size();
  if (heading_.whole) return 2 * size(all);
  if (heading_.touches || faces < kManyFaces) return std::numeric_limits<double>::infinity();
  return std::min(std::max(look_ticks() * size(heading_.pen), kWorthOfWanted * size(wanted)), kWorthOfAll * size(all));
}

void PatchMotionCheck::add_way() noexcept {
  ways_.add(sweep_->start(), sweep_->share() * sweep_->motion(), sweep_->near(), sweep_->blocking());
}

void PatchMotionCheck::lasted(std::uint64_t ticks) noexcept {
  swept_for_ = ticks;
  if (ticks > kMostSoon) slow_until_ = now_ + kSlowTicks;
}

double PatchMotionCheck::soon() const noexcept {
  return static_cast<double>(std::clamp<std::uint64_t>(swept_for_, 1, kMostSoon));
}

/// A few faces were in the way: what they met turns the motion aside before all others are looked at for nothing.
MotionAnswer PatchMotionCheck::blocked_at_once(const Pose& X, std::vector<FacePair>& blocking) noexcept {
  blocked_.count = size(displacement(blocked_.X, X, center_)) < kStill ? blocked_.count + 1 : 1;
  blocked_.X = X;
  swept_until_ = 0;
  share_ = 0;
  instead_.reset();
  tell(sweep_->blocking(), blocking);
  return answer(blocking);
}

MotionAnswer PatchMotionCheck::ask_sweep(const Pose& X, const Displacement& d,
                                         std::vector<FacePair>& blocking) noexcept {
  blocking.clear();
  instead_ = d;
  if (!sweep_->go_on(limit_.deadline_ns) || past(limit_.deadline_ns)) {
    share_ = 0;
    // Once: its contacts are followed from then on.
    if (sweep_->met_near() && !std::exchange(near_told_, true)) tell(sweep_->blocking(), blocking);
    return MotionAnswer::unknown;
  }
  sweeping_ = false;
  if (sweep_->met_at_once()) return blocked_at_once(X, blocking);
  ways_.drop();
  add_way();
  ways_.come_to(X);
  const auto& [way, met] = ways_.first();
  share_ = 1;
  // What was met is told where the pen has come to it.
  const auto along = way.toward(X, d);
  instead_ = along ? *along : Displacement{};
  if (way.ends_at(displaced(X, center_, *instead_))) tell(met, blocking);
  lasted(now_ - swept_since_ + 1);
  swept_until_ = now_;
  swept_from_ = sweep_->start();
  swept_motion_ = sweep_->motion();
  forget_small_cells(*instead_);
  return answer(blocking);
}

}  // namespace tegotae
