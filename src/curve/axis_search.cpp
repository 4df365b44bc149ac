#include "curve/axis_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "curve/axis_family.hpp"
#include "curve/axis_judge.hpp"
#include "curve/axis_refine.hpp"
#include "curve/facet_angle.hpp"
#include "curve/facets.hpp"
#include "curve/rises.hpp"
#include "curve/screw_fit.hpp"

namespace tegotae {
namespace {

/// Places at which the search begins, and facets around each of them that the first fit takes.
constexpr int kSeeds = 40;
constexpr std::size_t kNearest[] = {1200, 300, 60};
/// Every so many facets are asked first, and this part of the surface must follow a motion or it is dropped.
constexpr std::size_t kFirstStride = 8;
constexpr double kMinShare = 0.01;
/// The last rounds weigh facets by their angle against this: a cone beside a flank must not bend the flank's rise.
constexpr double kSharpAngle = 0.008;
constexpr int kSharpRounds = 4, kRiseRounds = 3;
constexpr double kRounds[] = {4 * kAxisTolerance, 2 * kAxisTolerance, kAxisTolerance, kAxisTolerance};
/// Of facets that merely cross the motion as they happen to lie, four times as many are within four tolerances.
constexpr double kMaxWider = 1.35;
/// A rough surface spreads its normals; what is most of a part is taken all the same.
constexpr double kMuch = 0.3, kMaxWiderOfMuch = 1.75;
/// So many motions that turn out to be none end the search.
constexpr int kMaxFailures = 16;
/// Facets are of one rise where their own ones lie within so many times their spread.
constexpr double kSameSpread = 2;
/// Threads whose axes lean from each other by less (rad) are one, fitted well or badly.
constexpr double kNearly = 0.3;
/// Several motions about one axis are taken where they explain so much more of the surface closely, and so much of what
/// is said to follow them.
constexpr double kMuchMore = 1.05, kSharpPart = 0.8;
/// Two motions are one where axes and rises agree to this (rad, shares of the size).
constexpr double kSameAngle = 0.02, kSamePlace = 0.01, kSameRise = 0.1;

class Search {
 public:
  explicit Search(const TriangleMesh& mesh)
      : facets_(mesh), free_(facets_.all.size(), 1), judge_(facets_, free_), family_(facets_.all, free_) {}

  std::vector<ScrewAxis> run() {
    std::vector<double> apart(facets_.all.size(), std::numeric_limits<double>::infinity());
    for (int i = 0; i < kSeeds && found_.size() < kMaxAxes && failures_ < kMaxFailures; ++i) {
      const std::size_t seed = next_seed(apart);
      if (seed == facets_.all.size()) break;
      spread(seed, apart);
      for (const std::size_t k : kNearest)
        if (try_seed(seed, k)) break;
    }
    search_beside();
    std::stable_sort(found_.begin(), found_.end(),
                     [](const ScrewAxis& a, const ScrewAxis& b) { return a.area > b.area; });
    return found_;
  }

 private:
  /// A thread about the axis of what turns without a rise may have been missed, or fitted badly from a place where it
  /// is cut by chamfers.
  void search_beside() {
    const std::vector<ScrewAxis> known = found_;
    for (const ScrewAxis& axis : known) {
      if (axis.rise != 0) continue;
      std::fill(free_.begin(), free_.end(), 1);
      if (!family_.settle_about(motion_of(axis)) || family_.rises().size() < 2 || !is_sharp()) continue;
      const ScrewMotion thread = with_rise(family_.axis(), family_.rises()[0]);
      const double share = judge_.share_at(thread);
      // What leans from it a little and explains less is the same thread, badly fitted.
      std::vector<ScrewAxis> better;
      bool worse = false;
      for (const ScrewAxis& other : found_) {
        const bool same = other.rise != 0 && other.direction.cross(thread.c).norm() < kNearly;
        if (same && !(judge_.share_at(motion_of(other)) < share)) worse = true;
        if (!same || !(judge_.share_at(motion_of(other)) < share)) better.push_back(other);
      }
      if (worse) continue;
      better.swap(found_);
      if (!accept_of_family(0)) better.swap(found_);
    }
  }

  ScrewMotion motion_of(const ScrewAxis& axis) const {
    ScrewMotion m;
    m.c = axis.direction;
    m.c_bar = -axis.direction.cross((axis.origin - facets_.middle) / facets_.size);
    return with_rise(m, axis.rise / facets_.size);
  }

  /// The largest facet first, then whatever is farthest from all seeds and follows no axis yet.
  std::size_t next_seed(const std::vector<double>& apart) const {
    std::size_t best = facets_.all.size();
    for (std::size_t i = 0; i < facets_.all.size(); ++i) {
      if (!free_[i] || !(apart[i] > 0)) continue;
      if (best == facets_.all.size() || apart[i] > apart[best] ||
          (apart[i] == apart[best] && facets_.all[i].area > facets_.all[best].area))
        best = i;
    }
    return best;
  }

  static double distance2(const Facet& a, const Facet& b) {
    constexpr double kTurn = 0.1;  // a normal of another direction is like a way of this part of the size
    return (a.center - b.center).squaredNorm() + kTurn * kTurn * (1 - std::pow(a.normal.dot(b.normal), 2));
  }

  void spread(std::size_t seed, std::vector<double>& apart) const {
    for (std::size_t i = 0; i < apart.size(); ++i)
      apart[i] = std::min(apart[i], distance2(facets_.all[seed], facets_.all[i]));
  }

  bool try_seed(std::size_t seed, std::size_t count) {
    if (facets_.all.size() < 12) return false;
    near_.clear();
    for (std::size_t i = 0; i < facets_.all.size(); ++i)
      near_.emplace_back(distance2(facets_.all[seed], facets_.all[i]), i);
    const std::size_t n = std::min(count, near_.size());
    std::nth_element(near_.begin(), near_.begin() + static_cast<std::ptrdiff_t>(n - 1), near_.end());
    of_.clear();
    for (std::size_t i = 0; i < n; ++i) of_.push_back(near_[i].second);
    std::sort(of_.begin(), of_.end());
    ScrewMotion motion;
    if (!fit_locally(motion)) return false;
    if (judge_.share_within(motion, kRounds[0], kFirstStride) < kMinShare) return false;
    const bool grown = grow(motion);
    failures_ += !grown;
    return grown;
  }

  /// Weights that fall off with the angle keep what belongs to another surface out.
  bool fit_locally(ScrewMotion& motion) {
    double scale = 0.3;
    for (int round = 0; round < 5; ++round, scale = std::max(kAxisTolerance, 0.5 * scale)) {
      weight_.clear();
      for (const std::size_t i : of_) {
        const Facet& f = facets_.all[i];
        const double x = round == 0 ? 0 : angle_off(f, motion) / scale;
        weight_.push_back(f.area / ((1 + x * x) * (1 + x * x)));
      }
      const ScrewFit fit = fit_screw(facets_.all, of_, weight_);
      if (!fit.found) return false;
      motion = fit.motion;
    }
    return true;
  }

  /// From a first motion to the one of all facets that follow it, and whether that is a surface that turns.
  bool grow(ScrewMotion motion) {
    ScrewFit fit;
    for (const double tolerance : kRounds) {
      take(motion, tolerance);
      if (of_.size() < 8) return false;
      fit = fit_screw(facets_.all, of_, weight_);
      if (!fit.found) return false;
      motion = fit.motion;
    }
    for (int round = 0; round < kSharpRounds; ++round) {
      take(motion, kAxisTolerance);
      sharpen(motion);
      fit = fit_screw(facets_.all, of_, weight_, &motion);
      if (!fit.found) return false;
      motion = fit.motion;
    }
    for (int round = 0; round < kRiseRounds; ++round)
      if (!settle_rise(motion)) return false;
    const bool distinct = is_distinct(fit);
    // What turns without a rise about the same axis may have drawn the fit to an axis between both.
    if (family_.settle(motion) && family_.rises().size() == 2 && is_distinct(family_.fit()) && is_sharp() &&
        family_share() > kMuchMore * judge_.share_at(motion)) {
      bool any = false;
      for (std::size_t k = 0; k < family_.rises().size(); ++k) any |= accept_of_family(k);
      return any;
    }
    return distinct && accept(motion);
  }

  /// Keeps the facets of_ as a surface about `motion`, if it is one that turns.
  bool accept(const ScrewMotion& motion) {
    if (!judge_.turns(of_, motion)) return false;
    const double in = judge_.share_within(motion, kAxisTolerance, 1), wider = judge_.share_beside(motion);
    if (in < kMinShare || wider > (in > kMuch ? kMaxWiderOfMuch : kMaxWider) * in) return false;
    const ScrewMotion fine = refined(facets_.all, of_, motion);
    use_up(fine);
    add(fine, in);
    return true;
  }

  bool accept_of_family(std::size_t place) {
    of_.clear();
    for (std::size_t i = 0; i < facets_.all.size(); ++i)
      if (family_.rise_of(i) == static_cast<std::int8_t>(place)) of_.push_back(i);
    if (of_.size() < 8) return false;
    spread_ = family_.spread();
    return accept(with_rise(family_.axis(), family_.rises()[place]));
  }

  /// Whether what is said to follow the family does so closely.
  bool is_sharp() const {
    double all = 0;
    for (std::size_t i = 0; i < facets_.all.size(); ++i)
      if (family_.rise_of(i) != AxisFamily::kNone) all += facets_.all[i].area;
    return family_share() * facets_.area > kSharpPart * all;
  }

  /// The same of all motions of the family together.
  double family_share() const {
    double in = 0;
    for (std::size_t i = 0; i < facets_.all.size(); ++i) {
      if (family_.rise_of(i) == AxisFamily::kNone) continue;
      for (const double rise : family_.rises()) {
        if (!(angle_at_middle(facets_.all[i], with_rise(family_.axis(), rise)) < kSharpTolerance)) continue;
        in += facets_.all[i].area;
        break;
      }
    }
    return in / facets_.area;
  }

  /// What follows the motion, or nearly, begins no other search, nor do ends and shoulders; a cone beside a thread
  /// does.
  void use_up(const ScrewMotion& motion) {
    const ScrewMotion plain = with_rise(motion, -motion.rise());
    for (std::size_t i = 0; i < facets_.all.size(); ++i) {
      const Facet& f = facets_.all[i];
      if (is_end(f, motion)) free_[i] = 0;
      if (!free_[i] || !is_within(f, motion, 4 * kAxisTolerance)) continue;
      if (std::abs(f.normal.dot(motion.c)) >= kMinLean) {
        const double own = own_rise(f, plain, rough_).rise, rise = motion.rise();
        const bool other = std::abs(rise) < kMinSpread ? std::abs(own) > 2 * kSameSpread * spread_
                                                       : std::abs(own) < std::abs(own - rise);
        if (other) continue;
      }
      free_[i] = 0;
    }
  }

  /// The facets that follow the motion, weighted so that squares are of angles.
  void take(const ScrewMotion& motion, double tolerance) {
    of_.clear();
    weight_.clear();
    for (std::size_t i = 0; i < facets_.all.size(); ++i) {
      const Facet& f = facets_.all[i];
      if (!free_[i] || is_end(f, motion) || !is_within(f, motion, tolerance)) continue;
      const double speed2 = motion.velocity(f.center).squaredNorm();
      of_.push_back(i);
      weight_.push_back(f.area / std::max(speed2, 1e-4));
    }
  }

  void sharpen(const ScrewMotion& motion) {
    for (std::size_t k = 0; k < of_.size(); ++k) {
      const double x = angle_at_middle(facets_.all[of_[k]], motion) / kSharpAngle;
      weight_[k] /= (1 + x * x) * (1 + x * x);
    }
  }

  /// How far normals are off anyway, rad: a part of the facets follows any rise, so a quantile of them tells.
  double roughness(const ScrewMotion& motion) const {
    std::vector<double> angle;
    for (const std::size_t i : of_) angle.push_back(angle_at_middle(facets_.all[i], motion));
    const auto place = angle.begin() + static_cast<std::ptrdiff_t>(0.3 * static_cast<double>(angle.size()));
    std::nth_element(angle.begin(), place, angle.end());
    return 2.6 * *place;  // of a normal distribution, 30 % are within 1 / 2.6 of the deviation
  }

  /// The most frequent rise of the facets that have one (mean shift), and the facets of it alone: the cone beside a
  /// thread turns about the same axis, and would draw the fit to a rise between both.
  bool settle_rise(ScrewMotion& motion) {
    ScrewMotion plain = motion;
    plain.c_bar -= motion.rise() * motion.c;
    take(motion, kAxisTolerance);
    if (of_.size() < 8) return false;
    rough_ = roughness(motion);
    std::vector<OwnRise> own;
    double spread = 0, weight = 0;
    for (const std::size_t i : of_) {
      if (std::abs(facets_.all[i].normal.dot(motion.c)) < kMinLean) continue;
      own.push_back(own_rise(facets_.all[i], plain, rough_));
      spread += own.back().weight * own.back().spread;
      weight += own.back().weight;
    }
    double rise = 0;
    if (weight > 0) {
      spread = std::max(kMinSpread, spread / weight);
      rise = most_frequent(own, spread);
      if (std::abs(rise) < spread) rise = 0;
    }
    const bool turned_only = rise == 0;
    const ScrewMotion wanted = with_rise(plain, rise);
    keep_rise(wanted, plain, rise, spread);
    if (of_.size() < 8) return false;
    if (turned_only) {
      motion = without_rise(facets_.all, of_, weight_, wanted);
    } else {
      const ScrewFit fit = fit_screw(facets_.all, of_, weight_, &wanted);
      if (!fit.found) return false;
      motion = fit.motion;
    }
    take(motion, kAxisTolerance);
    spread_ = spread;
    plain = with_rise(motion, -motion.rise());
    keep_rise(motion, plain, motion.rise(), spread);
    return of_.size() >= 8;
  }

  /// Drops those of of_ whose own rise is another.
  void keep_rise(const ScrewMotion& motion, const ScrewMotion& plain, double rise, double spread) {
    std::size_t kept = 0;
    for (const std::size_t i : of_) {
      const Facet& f = facets_.all[i];
      if (std::abs(f.normal.dot(motion.c)) >= kMinLean &&
          std::abs(own_rise(f, plain, rough_).rise - rise) > kSameSpread * spread)
        continue;
      of_[kept++] = i;
    }
    of_.resize(kept);
    weight_.clear();
    for (const std::size_t i : of_)
      weight_.push_back(facets_.all[i].area / std::max(motion.velocity(facets_.all[i].center).squaredNorm(), 1e-4));
  }

  void add(const ScrewMotion& motion, double share) {
    ScrewAxis axis;
    // The same axis comes out with either sign; the first coordinate that is not nearly zero is positive.
    Vec3 c = motion.c;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(c[k]) < 1e-6) continue;
      if (c[k] < 0) c = -c;
      break;
    }
    axis.direction = c;
    axis.origin = facets_.middle + facets_.size * motion.axis_point();
    axis.rise = std::abs(motion.rise()) < kMinSpread ? 0 : facets_.size * motion.rise();
    axis.area = share * facets_.area * facets_.size * facets_.size;
    for (ScrewAxis& known : found_) {
      const Vec3 apart = axis.origin - known.origin;
      const double rises = std::max(std::abs(axis.rise), std::abs(known.rise));
      if (known.direction.cross(c).norm() > kSameAngle || apart.cross(c).norm() > kSamePlace * facets_.size ||
          std::abs(axis.rise - known.rise) > kSameRise * rises)
        continue;
      known.area += axis.area;
      return;
    }
    found_.push_back(axis);
  }

  Facets facets_;
  std::vector<char> free_;  ///< follows no axis yet
  std::vector<ScrewAxis> found_;
  int failures_ = 0;
  AxisJudge judge_;
  AxisFamily family_;              ///< the motion that is looked at, with what turns beside it
  double rough_ = 0, spread_ = 0;  ///< of that motion
  std::vector<std::pair<double, std::size_t>> near_;
  std::vector<std::size_t> of_;
  std::vector<double> weight_;
};

}  // namespace

std::vector<ScrewAxis> find_axes(const TriangleMesh& mesh) {
  return Search(mesh).run();
}

}  // namespace tegotae
