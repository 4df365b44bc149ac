#include "contact/contact_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tegotae {
namespace {

// Motions that are sampled: spread over the sphere in six dimensions they are about 50° apart.
constexpr int kDirections = 96;
constexpr std::uint32_t kNobody = 0xffffffffu;
// Of gaps that are this much (m) larger than the smallest the pairs do not support the part now.
constexpr double kSupportBand = 2e-5;

/// The sequence with the least discrepancy known that has a closed form (powers of the root of x^7 = x + 1).
std::vector<Vec6> spread_directions() {
  double root = 1.1;
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1.0 / 7);
  std::vector<Vec6> out;
  for (int i = 1; i <= kDirections; ++i) {
    std::array<double, 6> u;
    double power = 1;
    for (double& x : u) {
      power /= root;
      x = std::fmod(0.5 + i * power, 1.0);
    }
    // Pairs of uniform numbers become pairs of normal ones (Box and Muller), whose direction is uniform.
    Vec6 d;
    for (int k = 0; k < 3; ++k) {
      const double r = std::sqrt(-2 * std::log(1e-9 + u[static_cast<std::size_t>(2 * k)]));
      const double angle = 2 * M_PI * u[static_cast<std::size_t>(2 * k + 1)];
      d[2 * k] = r * std::cos(angle);
      d[2 * k + 1] = r * std::sin(angle);
    }
    out.push_back(d.normalized());
  }
  return out;
}

}  // namespace

ContactChoice::ContactChoice(std::size_t capacity)
    : directions_(spread_directions()), best_(directions_.size()), supports_(directions_.size()) {
  kept_.reserve(capacity);
  near_.reserve(capacity);
}

void ContactChoice::keep(std::uint32_t pair) {
  if (kept_[pair] != 0) return;
  kept_[pair] = 1;
  ++count_;
}

void ContactChoice::keep_supports(const std::vector<Contact>& constraints, const std::vector<std::uint32_t>& owners,
                                  std::size_t most) {
  double least = INFINITY, arm2 = 0;
  for (const Contact& c : constraints) {
    least = std::min(least, c.gap);
    arm2 = std::max(arm2, c.r.squaredNorm());
  }
  const double per_arm = arm2 > 0 ? 1 / std::sqrt(arm2) : 0;
  std::fill(best_.begin(), best_.end(), INFINITY);
  std::fill(supports_.begin(), supports_.end(), kNobody);
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const Contact& c = constraints[i];
    if (c.gap > least + kSupportBand) continue;
    Vec6 row;
    row << c.n, per_arm * c.r.cross(c.n);
    for (std::size_t k = 0; k < directions_.size(); ++k) {
      const double opening = row.dot(directions_[k]);
      if (!(opening < best_[k])) continue;
      best_[k] = opening;
      supports_[k] = owners[i];
    }
  }
  for (const std::uint32_t pair : supports_)
    if (pair != kNobody && count_ < most) keep(pair);
}

void ContactChoice::choose(const std::vector<Contact>& constraints, const std::vector<std::uint32_t>& owners,
                           std::size_t pairs, std::size_t most, const std::vector<std::uint8_t>& must) {
  count_ = 0;
  kept_.assign(pairs, 0);
  for (std::uint32_t i = 0; i < pairs; ++i)
    if (must[i] != 0 && count_ < most) keep(i);
  keep_supports(constraints, owners, most);
  near_.clear();
  for (std::size_t i = 0; i < constraints.size(); ++i)
    if (near_.size() < near_.capacity()) near_.push_back({constraints[i].gap, owners[i]});
  std::sort(near_.begin(), near_.end());
  for (const Near& n : near_) {
    if (count_ >= most) break;
    keep(n.pair);
  }
}

}  // namespace tegotae
