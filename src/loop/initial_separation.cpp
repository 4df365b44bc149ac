#include "loop/initial_separation.hpp"

#include <algorithm>

#include "resolve/metric.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/resolve/resolver.hpp"

namespace tegotae {
namespace {

// Contacts are asked to leave this many times kGapFloor.
constexpr double kMargin = 1.2;
// Where a vertex of the copy went farther than its faces, its contacts must open by more: steps of this share of the
// offset.
constexpr double kStep = 0.25;
constexpr int kMaxRounds = 60, kMaxCalls = 16;
constexpr std::size_t kMaxInitialBlocking = 256;

class InitialSeparation {
 public:
  InitialSeparation(CollisionWorld& at, const MassProperties& mass, const Pose& X, double most)
      : at_(at),
        center_(mass.center),
        most_(most),
        X_(X),
        metric_(mass),
        resolver_(make_resolver(ResolverKind::qp, kMaxConstraints)),
        rows_(kMaxConstraints),
        bounds_(kMaxConstraints) {
    metric_.set_orientation(X.q);
    blocking_.reserve(kMaxInitialBlocking);
  }

  Pose run() {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i < at_.start.waiting(); ++i)
      if (shrunk(i)) all.push_back(at_.start.waiting(i).part);
    if (all.size() > 1 && open(all)) return X_;
    // Where not all can be had at once (a pin that is too thick for its hole), what can.
    for (const std::uint32_t part : all) open({part});
    return X_;
  }

 private:
  struct Wanted {
    PartId id;
    std::uint32_t part, stand_in;
    double offset, gap;  ///< gap (m) that contacts with the copy must leave
    bool blocked;        ///< the part is still nearer than kGapFloor
  };

  bool shrunk(std::size_t i) const { return at_.start.waiting(i).stand_in != InitialContacts::kNobody; }

  std::vector<Wanted> wanted(const std::vector<std::uint32_t>& parts) const {
    std::vector<Wanted> list;
    for (std::size_t i = 0; i < at_.start.waiting(); ++i) {
      const InitialContacts::Waiting& w = at_.start.waiting(i);
      if (!shrunk(i) || std::find(parts.begin(), parts.end(), w.part) == parts.end()) continue;
      const InitialContact& pair = at_.start.report().pairs[w.pair];
      const PartId id{static_cast<std::uint32_t>(pair.part)};
      list.push_back({id, w.part, w.stand_in, pair.inward_offset, pair.inward_offset + kMargin * kGapFloor, false});
    }
    return list;
  }

  /// Moves X_ so that all of `parts` are free of it; false, and nothing happens, when that is not found.
  bool open(const std::vector<std::uint32_t>& parts) {
    std::vector<Wanted> list = wanted(parts);
    at_.query(X_, center_, at_.reach, near_);
    at_.contacts->clear();
    at_.contacts->track(X_, at_.reach, kNoDeadline);
    for (int round = 0; round < kMaxRounds; ++round) {
      Displacement d;
      if (!solve(list, d) || d.dp.norm() + at_.radius * d.dr.norm() > most_) return false;
      int found = 0;
      bool is_open = is_path_free(d, found);
      for (Wanted& w : list) is_open &= stands_free(w, displaced(X_, center_, d), found);
      if (!is_open && found == 0) found = ask_for_more(list);
      if (is_open) {
        X_ = displaced(X_, center_, d);
        metric_.set_orientation(X_.q);
        retire(list);
        return true;
      }
      if (found == 0) return false;
    }
    return false;
  }

  bool solve(const std::vector<Wanted>& list, Displacement& d) {
    rows_.clear();
    for (const Contact& c : at_.contacts->constraints()) {
      const auto w = std::find_if(list.begin(), list.end(), [&](const Wanted& x) { return x.id == c.part; });
      const bool opens = w != list.end();
      const double gap = opens ? w->gap : std::min(c.gap, kMargin * kGapFloor);
      bounds_[static_cast<std::size_t>(rows_.rows())] = gap - c.gap;
      rows_.push_row(metric_.row(c));
    }
    const Resolution r = resolver_->resolve(rows_, bounds_.data(), Vec6::Zero());
    d = metric_.unwhiten(r.motion);
    return r.status == ResolveStatus::solved;
  }

  /// One answer of the narrow phase; where its work for one call runs out the next call goes on.
  MotionAnswer check(const std::vector<std::uint32_t>& parts, const Pose& X, const Displacement& d) {
    MotionAnswer answer = MotionAnswer::unknown;
    at_.check->begin(parts, kNoDeadline, OtherParts::ignored);
    for (int i = 0; i < kMaxCalls && answer == MotionAnswer::unknown; ++i) {
      blocking_.clear();
      answer = at_.check->check(X, d, kGapFloor, blocking_);
    }
    return answer;
  }

  bool is_path_free(const Displacement& d, int& found) {
    if (check(near_, X_, d) == MotionAnswer::free) return true;
    found += at_.contacts->seed(blocking_, X_, kNoDeadline);
    return false;
  }

  bool stands_free(Wanted& w, const Pose& P, int& found) {
    w.blocked = false;
    one_[0] = w.part;
    if (check(one_, P, Displacement{}) == MotionAnswer::free) return true;
    // The copy has the same faces, and gaps that mean something.
    for (FacePair& pair : blocking_) pair.part = w.stand_in;
    found += at_.contacts->seed(blocking_, X_, kNoDeadline);
    w.blocked = true;
    return false;
  }

  /// Lets the contacts of blocked parts open by more; returns how many parts that are.
  static int ask_for_more(std::vector<Wanted>& list) {
    int more = 0;
    for (Wanted& w : list) {
      if (!w.blocked || w.gap > 2 * w.offset + kMargin * kGapFloor) continue;
      w.gap += kStep * w.offset;
      ++more;
    }
    return more;
  }

  void retire(const std::vector<Wanted>& list) {
    for (std::size_t i = at_.start.waiting(); i-- > 0;) {
      const std::uint32_t part = at_.start.waiting(i).part;
      if (shrunk(i) && std::any_of(list.begin(), list.end(), [&](const Wanted& w) { return w.part == part; }))
        at_.start.free_at_start(i);
    }
  }

  CollisionWorld& at_;
  Vec3 center_;
  double most_;
  Pose X_;
  Metric metric_;
  std::unique_ptr<Resolver> resolver_;
  LowRankMatrix rows_;
  std::vector<double> bounds_;
  std::vector<std::uint32_t> near_, one_ = {0};
  std::vector<FacePair> blocking_;
};

}  // namespace

Pose initial_separation(CollisionWorld& at, const MassProperties& mass, const Pose& X, double most) {
  const Pose X_free = InitialSeparation(at, mass, X, most).run();
  at.contacts->clear();
  return X_free;
}

}  // namespace tegotae
