#include "narrowphase/proved_way.hpp"

#include <algorithm>

namespace tegotae {
namespace {

// A is on the way where it is off it by less than this share of the size of the scene: a tenth of the rounding that
// certificates leave room for.
constexpr double kOnWay = 1e-13;
// What comes no farther off it than this share of what it goes is beside it.
constexpr double kOffWay = 0.3;

}  // namespace

void ProvedWay::set(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& parts) noexcept {
  X_ = X;
  d_ = d;
  length2_ = product(d, d);
  parts_.assign(parts.begin(), parts.end());
  known_ = length2_ > 0;
  from_ = 1;
  to_ = 0;
}

void ProvedWay::cut(const Pose& X, const Pose& at) noexcept {
  X_ = X;
  d_ = displacement(X, at, center_);
  length2_ = product(d_, d_);
  known_ = length2_ > 0;
  from_ = to_ = 0;
}

void ProvedWay::come_to(const Pose& X) noexcept {
  if (!is_on(X)) return;
  from_ = std::min(from_, std::clamp(place(X), 0.0, 1.0));
  to_ = std::max(to_, place(X));
}

bool ProvedWay::is_on(const Pose& X) const noexcept {
  if (!known_) return false;
  const Displacement off = displacement(at(std::clamp(place(X), 0.0, 1.0)), X, center_);
  return size(off) <= kOnWay * (X.p.norm() + center_.norm() + radius_);
}

std::optional<Displacement> ProvedWay::toward(const Pose& X, const Displacement& d) const noexcept {
  if (!is_on(X)) return std::nullopt;
  return displacement(
      X, at(std::clamp(place(displaced(X, center_, d)), std::min(from_, std::clamp(place(X), 0.0, 1.0)), 1.0)),
      center_);
}

std::optional<Displacement> ProvedWay::join(const Pose& X, const Displacement& d) const noexcept {
  if (!known_) return std::nullopt;
  const double to = place(displaced(X, center_, d));
  if (to < 0 || to > 1) return std::nullopt;
  return displacement(X, at(to), center_);
}

bool ProvedWay::leads_on(const Pose& X, const Displacement& d) const noexcept {
  if (!known_) return false;
  const Pose to = displaced(X, center_, d);
  const double share = place(to);
  return share <= 1 && size(displacement(at(std::max(0.0, share)), to, center_)) <= kOffWay * size(d);
}

ProvedWays::ProvedWays(const Vec3& center, double radius, std::size_t parts, std::size_t met) {
  for (std::size_t i = 0; i < kMost; ++i) {
    stretches_.push_back({ProvedWay(center, radius, parts), {}});
    stretches_.back().met.reserve(met);
  }
}

void ProvedWays::come_to(const Pose& X) noexcept {
  if (count_ == 0) return;
  stretches_[0].way.come_to(X);
  while (count_ > 1 && stretches_[1].way.is_on(X)) {
    std::rotate(stretches_.begin(), stretches_.begin() + 1, stretches_.end());
    --count_;
    stretches_[0].way.come_to(X);
  }
}

void ProvedWays::add(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& parts,
                     const std::vector<FacePair>& met) noexcept {
  if (count_ > 0 && (full() || !last().way.is_on(X))) count_ = 0;
  Stretch& added = stretches_[count_++];
  added.way.set(X, d, parts);
  added.met.assign(met.begin(), met.end());
}

void ProvedWays::turn_off(const Pose& X, const Pose& at) noexcept {
  if (count_ == 0 || !first().way.is_on(X) || !first().way.is_on(at)) return;
  stretches_[0].way.cut(X, at);
  stretches_[0].met.clear();
  count_ = 1;
}

}  // namespace tegotae
