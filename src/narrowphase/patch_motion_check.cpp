#include "narrowphase/patch_motion_check.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "narrowphase/patch_cache.hpp"
#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

// Parts that can have fronts at once.
constexpr std::size_t kMaxFronts = 32;
// Where more parts than these, of as many triangles at most, are near, they are one for the cells: 2 µs for each
// triangle at the start. Until fewer than half of them are.
constexpr std::size_t kMostApart = 16, kMaxBundleFaces = 1u << 21;
// Pairs of all fronts together (about 400 bytes each, 550 where parts have a common axis), and the least and the most
// of one.
constexpr std::size_t kAllPairs = 1u << 18;
constexpr std::size_t kMinPairs = 1u << 13;
constexpr std::size_t kMaxPairs = 1u << 15;
// The most of one of few parts that are held together by threads or bores, where cells would be slower by far: they
// slide along each other, and coarse facets of both may have to be told apart one by one.
constexpr std::size_t kMaxSlidingPairs = 1u << 16;
// Of a front's pairs those about each of its axes that may be curved (about 160 bytes each).
constexpr double kCurvedShare = 0.125;
// Where no deadline bounds it, the same motion is asked about so often until all is known: in virtual time a part must
// not lag for want of work, and what never ends is to end some time. A front that takes nothing apart has looked for
// all its planes after these rounds; what it still lacks it would look for again.
constexpr int kMaxRounds = 64, kMaxIdleRounds = 8;
// A front of so many pairs that runs out of time so often in a row has more of them than a tick can look at. Below,
// cells would not be faster: what slides along walls uses up their distance to everything else.
constexpr int kManyPairs = 10000;
constexpr std::uint32_t kMaxExhausted = 6;
// A full front is not emptied again for so many ticks.
constexpr std::uint64_t kTicksBetweenEmptied = 100;
// The other way round, so few cells that run out of time more often than that, with no more ticks than these between
// two times, and do not double meanwhile, are those of a part that slides along walls: each is looked for again in
// every tick. A front of some 20 pairs for each of them has room.
constexpr int kFewCells = 800;
// With as many for each part the cells have hardly begun.
constexpr int kCellsToBegin = 4;
constexpr std::uint64_t kTicksBetween = 12;
// So many pairs, and one for so many faces of the held part, of surfaces that face each other from one side, are better
// cells: they lie on each other over much of the part.
constexpr int kSomePairs = 500, kFacesPerPair = 5;
constexpr double kOneSided = 0.35;
// What went over to cells lying on its seat, and is surrounded since (a peg that came over the rim of its hole), goes
// back: asked this often (ticks), of as few cells as a front has room for.
constexpr double kSurrounded = 0.2;
constexpr int kCellsOfAFront = static_cast<int>(kMaxPairs) / 20;
constexpr std::uint64_t kTicksBetweenSides = 64;
// A front that has proved so many motions with that many pairs stays.
constexpr int kProvedWithMany = 20;
// A way is looked at ahead for so many times the mean edge of the held part: beyond, the pieces that are small enough
// for contact have too many others in reach.
constexpr double kHeadwayEdges = 1.0;
// Cells (about 1160 bytes each) for the held part: for every triangle of it, where surfaces lie on each other, and for
// every part.
constexpr std::size_t kMinCells = 1u << 13;
constexpr double kCellsPerFace = 1.5;
constexpr std::size_t kCellsPerPart = 16;
// Triangle pairs that stop a motion, of one part: each of them costs a walk or a search for an axis, and what they
// leave out stops the next trial.
constexpr std::uint32_t kMaxBlocking = 24;
// After so many of all parts a part tells these few: more would leave no time for making contacts of them.
constexpr std::size_t kEnoughBlocking = 3 * kMaxBlocking;
constexpr std::uint32_t kFewBlocking = 2;
// Searches for planes in one look at a part that need not be kept out of: what is left goes on in the next.
constexpr int kStandSearches = 1024;
// A motion carries no point farther than this share of the part's radius: limits are straightened at its start.
constexpr double kLongestShare = 0.1;
// A share of a motion that was not certified as a whole is taken a little shorter, for rounding.
constexpr double kShareKept = 0.999;
// Where cells or fronts were behind, they have this part of a tick before the motion is looked at as a whole, and what
// they prove of it is made if it is no less than that share.
constexpr double kShareBehind = 0.3, kSharePays = 0.5;
// Fronts are busy that take more than this share of the time that there is, and may be behind soon.
constexpr double kBusy = 0.15;

/// Asks once or, where nothing is in the way but work and no deadline bounds it, until that is done or `idle_rounds` in
/// a row have taken nothing apart.
template <typename Ask>
CertifyReport ask_through(std::int64_t deadline_ns, int idle_rounds, Ask ask) {
  CertifyReport report = ask();
  if (deadline_ns != kNoDeadline) return report;
  int idle = 0;
  for (int i = 1; i < kMaxRounds && idle < idle_rounds; ++i) {
    if (report.overflow || report.status != CertifyStatus::out_of_budget) break;
    report = ask();
    idle = report.splits > 0 ? 0 : idle + 1;
  }
  return report;
}

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) sum += (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
  return mesh.triangles.empty() ? 0 : sum / (3 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace

PatchMotionCheck::PatchMotionCheck(const std::shared_ptr<const TriangleMesh>& held, const Vec3& center, double radius,
                                   const std::vector<std::shared_ptr<const TriangleMesh>>& fixed,
                                   std::vector<Pose> poses, const std::vector<std::uint32_t>& left_out,
                                   ProofEffort effort, int helpers)
    : center_(center),
      radius_(radius),
      held_(cached_patch_tree(held)),
      effort_(effort),
      helpers_(helpers),
      poses_(std::move(poses)),
      headway_(center, radius, kHeadwayEdges * mean_edge(*held)),
      ways_(center, radius, fixed.size() + 1, kMaxBlocking),
      offered_(center, radius),
      line_(center, radius, fixed.size() + 1),
      edge_(mean_edge(*held)) {
  static const std::vector<AxisPair> kNoAxes;
  if (effort_ == ProofEffort::full) pairing_.emplace(held_);
  std::map<const TriangleMesh*, std::shared_ptr<const PatchTree>> trees = {{held.get(), held_}};
  std::vector<CellFront::FixedPart> parts;
  bool any_axes = false;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    auto& tree = trees[fixed[i].get()];
    if (!tree) tree = cached_patch_tree(fixed[i]);
    fixed_.push_back(tree);
    axes_.push_back(pairing_ ? pairing_->with(tree) : &kNoAxes);
    any_axes = any_axes || !axes_.back()->empty();
    parts.push_back({tree, poses_[i]});
  }
  make_bundle(fixed, left_out);
  make_bodies(held, fixed, left_out);
  if (bundle_) parts.push_back({bundle_->tree(), Pose{}});
  const std::size_t fronts = std::min(kMaxFronts, std::max<std::size_t>(1, fixed.size()));
  FrontCapacity capacity;
  capacity.blocking = kMaxBlocking;
  capacity.pairs = static_cast<std::uint32_t>(std::clamp(kAllPairs / fronts, kMinPairs, kMaxPairs));
  if (any_axes) {
    capacity.curved = static_cast<std::uint32_t>(kCurvedShare * capacity.pairs);
    capacity.pairs = static_cast<std::uint32_t>(std::clamp(kAllPairs / fronts, kMinPairs, kMaxSlidingPairs));
  }
  fronts_.reserve(fronts);
  for (std::size_t i = 0; i < fronts; ++i) fronts_.emplace_back(capacity);
  part_of_.assign(fronts, kNobody);
  used_.assign(fronts, 0);
  exhausted_.assign(fronts, 0);
  emptied_.assign(fronts, 0);
  ahead_.resize(fronts);
  front_of_.assign(fixed.size(), kNobody);
  const std::size_t cells = kMinCells + kCellsPerPart * fixed.size() +
                            static_cast<std::size_t>(kCellsPerFace * static_cast<double>(held->triangles.size()));
  if (effort_ == ProofEffort::full && held->triangles.size() <= SweepModel::kMostFaces) {
    backing_ = Backing::of(held_, held_body_.facing.get());
    sweep_ = std::make_unique<SurfaceSweep>(held_, center_, parts, held_body_.facing, backing_, kMaxBlocking, helpers);
  }
  cells_ =
      std::make_unique<CellFront>(held_, center_, std::move(parts), static_cast<std::uint32_t>(cells), kMaxBlocking);
  choice_.assign(fixed.size(), Certificate::front);
  seen_.assign(fixed.size(), 0);
  near_.reserve(fixed.size());
  near_fronts_.reserve(fixed.size());
  near_cells_.reserve(fixed.size() + 1);
  swept_.reserve(fixed.size() + 1);
  outside_.reserve(fixed.size() + 1);
  left_out_.assign(fixed.size(), false);
  for (const std::uint32_t part : left_out) left_out_[part] = true;
}

/// For scenes of many parts. Bores and threads are not in it, since their fronts are faster, unless there are far more
/// of them than fronts: what has some round surface may have an axis in common with everything.
void PatchMotionCheck::make_bundle(const std::vector<std::shared_ptr<const TriangleMesh>>& fixed,
                                   const std::vector<std::uint32_t>& left_out) {
  if (effort_ == ProofEffort::quick || fixed.size() <= kMostApart) return;
  const auto with_axes = static_cast<std::size_t>(
      std::count_if(axes_.begin(), axes_.end(), [](const auto* axes) { return !axes->empty(); }));
  const bool all = with_axes > 2 * kMaxFronts;
  std::vector<std::uint32_t> members;
  std::size_t faces = 0;
  for (std::uint32_t part = 0; part < fixed.size(); ++part) {
    if (!all && !axes_[part]->empty()) continue;
    if (std::find(left_out.begin(), left_out.end(), part) != left_out.end()) continue;
    members.push_back(part);
    faces += fixed[part]->triangles.size();
  }
  if (members.size() > kMostApart && faces <= kMaxBundleFaces) bundle_.emplace(fixed, poses_, members);
}

void PatchMotionCheck::make_bodies(const std::shared_ptr<const TriangleMesh>& held,
                                   const std::vector<std::shared_ptr<const TriangleMesh>>& fixed,
                                   const std::vector<std::uint32_t>& left_out) {
  bodies_.resize(fixed.size());
  sides_.resize(fixed.size());
  if (effort_ == ProofEffort::quick) return;
  const auto body = [](const std::shared_ptr<const TriangleMesh>& mesh, const std::shared_ptr<const PatchTree>& tree) {
    return Body{Facing::of(mesh, tree), Facing::points_of(mesh)};
  };
  held_body_ = body(held, held_);
  std::map<const TriangleMesh*, Body> known = {{held.get(), held_body_}};
  for (std::uint32_t part = 0; part < fixed.size(); ++part) {
    if (std::find(left_out.begin(), left_out.end(), part) != left_out.end()) continue;
    const auto found = known.find(fixed[part].get());
    if (found == known.end()) known.emplace(fixed[part].get(), body(fixed[part], fixed_[part]));
    bodies_[part] = known.at(fixed[part].get());
    for (Vec3& p : bodies_[part].points) p = poses_[part] * p;
  }
  if (!bundle_) return;
  for (std::uint32_t part = 0; part < fixed.size(); ++part)
    if (bundle_->has(part) && !bodies_[part].facing) return;
  bundle_facing_ = std::make_shared<const Facing>(bundle_->tree());
}

bool PatchMotionCheck::bundles() noexcept {
  if (!bundle_ || others_ == OtherParts::ignored) return false;
  return near_.size() > (bundled_ ? kMostApart / 2 : kMostApart);
}

double PatchMotionCheck::longest_motion() const {
  return kLongestShare * radius_;
}

void PatchMotionCheck::take_front(std::uint32_t part) noexcept {
  const auto oldest = std::min_element(used_.begin(), used_.end());
  if (*oldest == now_) return;
  const auto front = static_cast<std::uint32_t>(oldest - used_.begin());
  if (part_of_[front] != kNobody) front_of_[part_of_[front]] = kNobody;
  part_of_[front] = part;
  front_of_[part] = front;
  used_[front] = now_;
  exhausted_[front] = 0;
  emptied_[front] = 0;
  ahead_[front] = Ahead{};
  fronts_[front].attach(*held_, center_, *fixed_[part], axes_[part]);
}

void PatchMotionCheck::move_to_cells(std::uint32_t part) noexcept {
  const std::uint32_t front = front_of_[part];
  part_of_[front] = kNobody;
  front_of_[part] = kNobody;
  used_[front] = 0;
  choice_[part] = Certificate::cells;
}

void PatchMotionCheck::begin(const std::vector<std::uint32_t>& near, std::int64_t deadline_ns,
                             OtherParts others) noexcept {
  limit_.deadline_ns = deadline_ns;
  others_ = others;
  trusted_ = false;
  near_.assign(near.begin(), near.end());
  take_up_near();
}

void PatchMotionCheck::take_up_near() noexcept {
  ++now_;
  overflow_ = false;
  near_fronts_.clear();
  near_cells_.clear();
  bundled_ = bundles();
  for (const std::uint32_t part : near_)
    if (front_of_[part] != kNobody && !(bundled_ && bundle_->has(part))) used_[front_of_[part]] = now_;
  if (bundled_) near_cells_.push_back(static_cast<std::uint32_t>(fixed_.size()));
  for (const std::uint32_t part : near_) {
    if (bundled_ && bundle_->has(part)) continue;
    if (seen_[part] + 1 < now_) choice_[part] = Certificate::front;
    seen_[part] = now_;
    if (front_of_[part] == kNobody && choice_[part] != Certificate::cells) take_front(part);
    (front_of_[part] == kNobody ? near_cells_ : near_fronts_).push_back(part);
  }
  cells_->set_near(near_cells_);
}

void PatchMotionCheck::begin_anew() noexcept {
  part_of_.assign(part_of_.size(), kNobody);
  used_.assign(used_.size(), 0);
  front_of_.assign(front_of_.size(), kNobody);
  choice_.assign(choice_.size(), Certificate::front);
  vain_ = {};
  cells_->clear();
  headway_.restart();
  take_up_near();
  asked_ = false;
}

CertifyReport PatchMotionCheck::ask_front(std::uint32_t part, const Pose& X, const Displacement& d, double clearance,
                                          const WorkLimit& limit) noexcept {
  PatchFront& front = fronts_[front_of_[part]];
  front.set_clearance(clearance);
  const Quat q_BW = poses_[part].q.conjugate();
  return front.certify(poses_[part].inverse() * X, {q_BW * d.dp, q_BW * d.dr}, limit);
}

MotionAnswer PatchMotionCheck::check(const Pose& X, const Displacement& d, double clearance,
                                     std::vector<FacePair>& blocking) noexcept {
  const bool asked = std::exchange(asked_, true);
  const MotionAnswer answer = ask(X, d, clearance, blocking);
  if (answer != MotionAnswer::unknown && instead_ && !offered_.declined(X, now_)) offered_.add(X, *instead_, now_);
  // Nothing is in the way but work, which pairs that were taken apart for motions elsewhere may have used up: each of
  // them costs a search, and few go together again in a call that ends so.
  if (answer != MotionAnswer::unknown || !asked || limit_.deadline_ns != kNoDeadline || effort_ == ProofEffort::quick)
    return answer;
  begin_anew();
  return check(X, d, clearance, blocking);
}

MotionAnswer PatchMotionCheck::ask(const Pose& X, const Displacement& wanted, double clearance,
                                   std::vector<FacePair>& blocking) noexcept {
  share_ = 1;
  clearance_ = clearance;
  instead_.reset();
  count_still(X);
  take_turns(X);
  if (sweeping_ && sweeps(X, wanted)) return ask_sweep(X, wanted, blocking);
  sweeping_ = false;
  if (!heading_.whole && !offered_.declined(X, now_)) {
    if (goes_along(X, wanted, blocking)) return answer(blocking);
    instead_ = onto_way(X, wanted);
  }
  const Displacement d = instead_ ? *instead_ : wanted;
  const std::int64_t deadline_ns = limit_.deadline_ns;
  const bool sweeps_now = may_sweep() && behind_for_ >= ticks_behind() && !rests(X, d) && !cells_turn();
  if (sweeps_now) {
    const std::int64_t now_ns = monotonic_ns();
    limit_.deadline_ns = now_ns + static_cast<std::int64_t>(kShareBehind * static_cast<double>(deadline_ns - now_ns));
  }
  const std::int64_t begun_ns = may_sweep() ? monotonic_ns() : 0;
  const bool fronts_behind = ask_fronts(X, d, clearance, blocking);
  if (may_sweep())
    fronts_busy_ =
        static_cast<double>(monotonic_ns() - begun_ns) > kBusy * static_cast<double>(limit_.deadline_ns - begun_ns);
  if (!near_cells_.empty() && effort_ == ProofEffort::quick) {
    share_ = 0;
  } else if (!near_cells_.empty() && only_leaves(X, d, clearance)) {
    forget_small_cells(d);
  } else {
    behind_ = fronts_behind;
    if (!near_cells_.empty()) behind_ |= ask_all_cells(X, d, clearance, blocking);
  }
  limit_.deadline_ns = deadline_ns;
  count_behind();
  // What was begun ahead of it may have come to here.
  const bool begun = behind_ && looks_ahead_ && sweeps(X, wanted) && (sweeps_now || at_end_of_way(X));
  const bool pays = stands_still() || (share_ < (heading_.whole ? 1 : kSharePays) && blocking.empty());
  if (begun || (behind_ && sweeps_now && pays)) {
    sweeping_ = begun || begin_sweep(X, wanted, clearance);
    swept_since_ = now_;
    looks_ahead_ = false;
    if (sweeping_) return ask_sweep(X, wanted, blocking);
  }
  return answer(blocking);
}

/// A tick in which they ran out of time is one of those, whatever they answered before.
void PatchMotionCheck::count_behind() noexcept {
  if (std::exchange(behind_since_, now_) != now_) {
    behind_before_ = behind_for_;
    behind_for_ = 0;
  }
  if (behind_) behind_for_ = behind_before_ + 1;
}

bool PatchMotionCheck::ask_all_cells(const Pose& X, const Displacement& d, double clearance,
                                     std::vector<FacePair>& blocking) noexcept {
  limit_.searches = kCellSearches;
  limit_.blocking = kMaxBlocking;
  const CertifyReport report = ask_through(limit_.deadline_ns, kMaxRounds, [&] { return ask_cells(X, d, clearance); });
  overflow_ |= report.overflow;
  const bool behind = report.exhausted && limit_.deadline_ns != kNoDeadline;
  if (!behind) left_ = 0;
  judge_cells(report);
  share_ = std::min(share_, report.share);
  tell(cells_->blocking(), blocking);
  return behind;
}

MotionAnswer PatchMotionCheck::answer(std::vector<FacePair>& blocking) noexcept {
  if (share_ == 1 && blocking.empty()) return MotionAnswer::free;
  share_ *= kShareKept;
  return blocking.empty() ? MotionAnswer::unknown : MotionAnswer::blocked;
}

void PatchMotionCheck::tell(const std::vector<FacePair>& pairs, std::vector<FacePair>& blocking) const noexcept {
  for (const FacePair& pair : pairs)
    if (blocking.size() < blocking.capacity())
      blocking.push_back(pair.part < fixed_.size() ? pair : bundle_->of_part(pair));
}

/// The front of parts that slide along each other holds what was taken apart and not put together again: where it is
/// full it begins anew, which takes some milliseconds, since cells would be slower in every tick. Not again soon: then
/// it is too small.
bool PatchMotionCheck::empty_full_front(std::uint32_t part, const CertifyReport& report) noexcept {
  const std::uint32_t front = front_of_[part];
  const bool full = report.overflow && report.status == CertifyStatus::out_of_budget;
  if (!full || axes_[part]->empty()) return false;
  if (emptied_[front] > 0 && now_ < emptied_[front] + kTicksBetweenEmptied) return false;
  emptied_[front] = now_;
  fronts_[front].attach(*held_, center_, *fixed_[part], axes_[part]);
  return true;
}

/// Parts whose fronts are too small or too slow go over to the cells.
bool PatchMotionCheck::ask_fronts(const Pose& X, const Displacement& d, double clearance,
                                  std::vector<FacePair>& blocking) noexcept {
  bool moved = false, behind = false;
  const bool timed = limit_.deadline_ns != kNoDeadline;
  limit_.searches = kFrontSearches;
  for (const std::uint32_t part : near_fronts_) {
    limit_.blocking = blocking.size() < kEnoughBlocking ? kMaxBlocking : kFewBlocking;
    const auto ask = [&] { return ask_front(part, X, d, clearance, limit_); };
    const auto ask_all = [&] {
      return effort_ == ProofEffort::quick ? ask() : ask_through(limit_.deadline_ns, kMaxIdleRounds, ask);
    };
    CertifyReport report = ask_all();
    if (empty_full_front(part, report)) report = ask_all();
    std::uint32_t& exhausted = exhausted_[front_of_[part]];
    exhausted = report.status == CertifyStatus::out_of_budget ? exhausted + 1 : 0;
    behind = behind || (timed && exhausted > 0);
    const bool slides = !axes_[part]->empty();
    const bool tried = choice_[part] == Certificate::front_for_good;
    if ((exhausted > kMaxExhausted && report.pairs > kManyPairs && !slides && !tried) ||
        (report.overflow && report.status == CertifyStatus::out_of_budget && (!timed || exhausted > kMaxExhausted))) {
      move_to_cells(part);
      near_cells_.push_back(part);
      moved = true;
      continue;
    }
    share_ = std::min(share_, report.share);
    if (report.status == CertifyStatus::certified) {
      if (many(report.pairs)) ++ahead_[front_of_[part]].proved_with_many;
      continue;
    }
    for (const BlockingPair& pair : fronts_[front_of_[part]].blocking())
      if (blocking.size() < blocking.capacity()) blocking.push_back({part, pair.face_a, pair.face_b});
    if (report.exhausted && past(limit_.deadline_ns)) break;
  }
  if (moved) fronts_left();
  return behind;
}

void PatchMotionCheck::fronts_left() noexcept {
  near_fronts_.erase(std::remove_if(near_fronts_.begin(), near_fronts_.end(),
                                    [this](std::uint32_t part) { return choice_[part] == Certificate::cells; }),
                     near_fronts_.end());
  cells_->set_near(near_cells_);
}

void PatchMotionCheck::judge_cells(const CertifyReport& report) noexcept {
  if (limit_.deadline_ns != kNoDeadline && now_ % kTicksBetweenSides == 0 && report.pairs <= kCellsOfAFront) {
    for (const std::uint32_t part : near_cells_)
      if (part < fixed_.size() && choice_[part] == Certificate::cells && cells_->one_sidedness(part) < kSurrounded)
        choice_[part] = Certificate::front;
  }
  if (report.status != CertifyStatus::out_of_budget || vain_.last == now_ || bundled_) return;
  const bool begins = vain_.last + kTicksBetween < now_ || report.pairs > 2 * vain_.cells;
  if (begins) vain_ = {report.pairs, 0, 0};
  vain_.last = now_;
  const bool begun = report.pairs > kCellsToBegin * static_cast<int>(near_cells_.size());
  vain_.exhausted = begun && report.pairs <= kFewCells ? vain_.exhausted + 1 : 0;
  if (vain_.exhausted <= kMaxExhausted) return;
  for (const std::uint32_t part : near_cells_)
    if (choice_[part] == Certificate::cells) choice_[part] = Certificate::front_for_good;
}

CertifyReport PatchMotionCheck::ask_cells(const Pose& X, const Displacement& d, double clearance) noexcept {
  cells_->set_clearance(clearance);
  const bool moves = headway_.go(X, d);
  cells_->foresee(moves ? headway_.motion() : Displacement{});
  const CertifyReport report = cells_->certify(X, d, limit_);
  if (moves) headway_.learn(0, cells_->met());
  return report;
}

bool PatchMotionCheck::many(int pairs) const noexcept {
  return pairs > std::max(kSomePairs, static_cast<int>(held_->mesh().triangles.size()) / kFacesPerPair);
}

bool PatchMotionCheck::lies_on(const CertifyReport& report, std::uint32_t part) const noexcept {
  if (choice_[part] == Certificate::front_for_good) return false;
  // On one flank of its thread a nut is one-sided, and cells are slower there by far.
  if (fronts_[front_of_[part]].in_thread()) return false;
  // What has had so many pairs for long does well with them: a peg that leans in its hole.
  if (ahead_[front_of_[part]].proved_with_many > kProvedWithMany) return false;
  if (!many(report.pairs * static_cast<int>(near_fronts_.size()))) return false;
  int pairs = 0;
  for (const std::uint32_t near : near_fronts_)
    if (front_of_[near] != kNobody) pairs += fronts_[front_of_[near]].pairs();
  return many(pairs) && fronts_[front_of_[part]].one_sidedness() > kOneSided;
}

MotionAnswer PatchMotionCheck::stands(const Pose& X, std::uint32_t part, double clearance,
                                      std::int64_t deadline_ns) noexcept {
  one_[0] = part;
  begin(one_, deadline_ns, OtherParts::ignored);
  WorkLimit limit = limit_;
  limit.blocking = 1;
  limit.searches = kStandSearches;
  CertifyReport report;
  if (near_cells_.empty()) {
    report = ask_front(part, X, Displacement{}, clearance, limit);
  } else {
    cells_->set_clearance(clearance);
    cells_->foresee({});
    report = cells_->certify(X, Displacement{}, limit);
  }
  if (report.status == CertifyStatus::out_of_budget) return MotionAnswer::unknown;
  return report.status == CertifyStatus::certified ? MotionAnswer::free : MotionAnswer::blocked;
}

}  // namespace tegotae
