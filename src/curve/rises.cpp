#include "curve/rises.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae {
namespace {

/// What is left of a chord's angle at its middle, for facets that are not half a chord.
constexpr double kChordError = 0.05;
/// Rises from which the most frequent one is looked for, steps of each.
constexpr int kStarts = 16, kSteps = 12;
/// What is so many spreads away does not count; a step of this part of the spread is the last.
constexpr double kReach = 3, kStill = 1e-3;

}  // namespace

OwnRise own_rise(const Facet& f, const ScrewMotion& plain, double rough) {
  const double lean = f.normal.dot(plain.c);
  const Vec3 v = plain.velocity(chord_middle(f, plain));
  double width = 0;
  for (const Vec3& e : f.edge) width = std::max(width, std::abs(e.dot(v)));
  const double speed = std::max(v.norm(), 1e-6),
               chord = kChordError * width / speed * std::sqrt(1 - std::min(1.0, lean * lean));
  return {-f.normal.dot(v) / lean, (chord + rough * speed) / std::abs(lean), f.area * lean * lean};
}

double most_frequent(std::vector<OwnRise>& own, double spread) {
  std::sort(own.begin(), own.end(), [](const OwnRise& a, const OwnRise& b) {
    return a.rise != b.rise ? a.rise < b.rise : a.weight < b.weight;
  });
  double best = 0, most = -1;
  for (int k = 0; k < kStarts; ++k) {
    double at = own[own.size() * static_cast<std::size_t>(2 * k + 1) / (2 * kStarts)].rise, density = 0;
    for (int step = 0; step < kSteps; ++step) {
      double sum = 0;
      density = 0;
      const auto begin = std::lower_bound(own.begin(), own.end(), at - kReach * spread,
                                          [](const OwnRise& o, double rise) { return o.rise < rise; });
      for (auto o = begin; o != own.end() && o->rise <= at + kReach * spread; ++o) {
        const double x = (o->rise - at) / spread, w = o->weight * std::exp(-0.5 * x * x);
        sum += w * o->rise;
        density += w;
      }
      if (!(density > 0)) break;
      const double next = sum / density, moved = std::abs(next - at);
      at = next;
      if (moved < kStill * spread) break;
    }
    if (density > most) most = density, best = at;
  }
  return best;
}

}  // namespace tegotae
