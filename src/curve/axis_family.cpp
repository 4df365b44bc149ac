#include "curve/axis_family.hpp"

#include <algorithm>
#include <cmath>

#include "curve/axis_judge.hpp"
#include "curve/facet_angle.hpp"

namespace tegotae {
namespace {

constexpr double kEndNormal = 0.98;
constexpr int kFamilyRounds = 6;
/// The second least mean square is as small as the least on a sphere.
constexpr double kDistinct = 8, kMinSecond = 1e-3;
/// A facet is of the nearest rise where its own one lies within so many spreads.
constexpr double kSameFamilySpread = 2;
/// Squares are of angles: facets nearer to the axis than this (of the size) do not count more.
constexpr double kMinSpeed2 = 1e-4;
/// Of a normal distribution, 30 % are within 1 / 2.6 of the deviation.
constexpr double kQuantile = 0.3, kOfQuantile = 2.6;

}  // namespace

bool is_end(const Facet& f, const ScrewMotion& m) {
  return std::abs(f.normal.dot(m.c)) > kEndNormal;
}

bool is_distinct(const ScrewFit& fit) {
  return fit.second > kDistinct * fit.best && fit.second > kMinSecond;
}

ScrewMotion with_rise(ScrewMotion plain, double rise) {
  plain.c_bar += rise * plain.c;
  return plain;
}

bool AxisFamily::settle(const ScrewMotion& near) {
  axis_ = with_rise(near, -near.rise());
  rises_ = {near.rise(), 0};
  rough_ = 0;
  collect();
  return settle_rounds();
}

bool AxisFamily::settle_about(const ScrewMotion& plain) {
  axis_ = plain;
  rough_ = 0;
  collect_leaning();
  return settle_rounds();
}

bool AxisFamily::settle_rounds() {
  for (int round = 0; round < kFamilyRounds; ++round) {
    if (round > 0) collect();
    find_rise();
    assign();
    if (!refit()) return false;
  }
  collect();
  find_rise();
  assign();
  return true;
}

/// Facets that follow the axis with one of the rises.
void AxisFamily::collect() {
  near_.clear();
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const Facet& f = facets_[i];
    if (!free_[i] || is_end(f, axis_)) continue;
    for (const double rise : rises_) {
      if (!is_within(f, with_rise(axis_, rise), kAxisTolerance)) continue;
      near_.push_back(i);
      break;
    }
  }
}

/// All that could say something about a rise.
void AxisFamily::collect_leaning() {
  near_.clear();
  for (std::size_t i = 0; i < facets_.size(); ++i)
    if (free_[i] && !is_end(facets_[i], axis_) && std::abs(facets_[i].normal.dot(axis_.c)) >= kMinLean)
      near_.push_back(i);
}

/// The rise that most of them ask for, beside none at all.
void AxisFamily::find_rise() {
  own_.clear();
  double spread = 0, weight = 0;
  for (const std::size_t i : near_) {
    const Facet& f = facets_[i];
    if (std::abs(f.normal.dot(axis_.c)) < kMinLean) continue;
    own_.push_back(own_rise(f, axis_, rough_));
    spread += own_.back().weight * own_.back().spread;
    weight += own_.back().weight;
  }
  spread_ = weight > 0 ? std::max(kMinSpread, spread / weight) : kMinSpread;
  rises_ = {0};
  if (own_.empty()) return;
  double rise = most_frequent(own_, spread_);
  if (std::abs(rise) < 2 * kSameFamilySpread * spread_) {
    // What turns without a rise is most of it; a thread may be beside it.
    own_.erase(std::remove_if(own_.begin(), own_.end(),
                              [&](const OwnRise& o) { return std::abs(o.rise) < 2 * kSameFamilySpread * spread_; }),
               own_.end());
    if (own_.empty()) return;
    rise = most_frequent(own_, spread_);
  }
  rises_.insert(rises_.begin(), rise);
}

/// Which rise each facet follows.
void AxisFamily::assign() {
  of_rise_.assign(facets_.size(), kNone);
  for (const std::size_t i : near_) {
    const Facet& f = facets_[i];
    if (std::abs(f.normal.dot(axis_.c)) < kMinLean) {
      of_rise_[i] = kAny;
      continue;
    }
    const OwnRise own = own_rise(f, axis_, rough_);
    double nearest = kSameFamilySpread * std::max(spread_, own.spread);
    for (std::size_t k = 0; k < rises_.size(); ++k) {
      const double off = std::abs(own.rise - rises_[k]);
      if (off < nearest) nearest = off, of_rise_[i] = static_cast<std::int8_t>(k);
    }
  }
}

/// The axis to which all of them are tangent, each with its rise.
bool AxisFamily::refit() {
  of_.clear();
  weight_.clear();
  rise_of_.clear();
  std::vector<double> angle;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    if (of_rise_[i] == kNone) continue;
    const Facet& f = facets_[i];
    const double rise = of_rise_[i] == kAny ? 0 : rises_[static_cast<std::size_t>(of_rise_[i])];
    of_.push_back(i);
    weight_.push_back(f.area / std::max(axis_.velocity(f.center).squaredNorm(), kMinSpeed2));
    rise_of_.push_back(rise);
  }
  if (of_.size() < 8) return false;
  fit_ = fit_screw(facets_, of_, weight_, &axis_, &rise_of_);
  if (!fit_.found) return false;
  axis_ = with_rise(fit_.motion, -fit_.motion.rise());
  for (std::size_t k = 0; k < of_.size(); ++k)
    angle.push_back(angle_at_middle(facets_[of_[k]], with_rise(axis_, rise_of_[k])));
  const auto place = angle.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(angle.size()));
  std::nth_element(angle.begin(), place, angle.end());
  rough_ = kOfQuantile * *place;
  return true;
}

}  // namespace tegotae
