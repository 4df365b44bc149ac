#include "models/helical.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/numbers.hpp"
#include "models/mesh_builder.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {
namespace {

constexpr double kTurn = 2 * kPi;

void check(const WavyThread& t) {
  if (!(t.depth > 0 && t.radius > t.depth && t.pitch > 0 && t.low < t.high && t.segments >= 3 && t.rings >= 2))
    throw Error("a thread needs a radius over its depth, a pitch, a length, and divisions");
}

/// The thread's rings, from its low end to the high one.
std::vector<Ring> thread_rings(const WavyThread& t, MeshBuilder& b) {
  const int n = std::max(1, static_cast<int>(std::ceil(t.rings * (t.high - t.low) / t.pitch)));
  std::vector<Ring> rings;
  for (int k = 0; k <= n; ++k) {
    const double z = k == n ? t.high : t.low + (t.high - t.low) * k / n;
    Ring ring;
    for (int i = 0; i < t.segments; ++i) {
      const double angle = kTurn * i / t.segments;
      const double r = t.radius + t.depth / 2 * std::cos(kTurn * z / t.pitch - angle);
      ring.push_back(b.vertex({r * std::cos(angle), r * std::sin(angle), z}));
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

void check(const BentBar& b) {
  if (!(b.radius > 0 && b.bend > b.radius && b.from < b.to && b.to < b.from + kTurn && b.along >= 1 && b.around >= 3))
    throw Error("a bent bar needs a radius less than its bend's, two ends and divisions");
}

/// Rings of radius `radius` around the bar's center line, from its one end to the other.
std::vector<Ring> bent_rings(const BentBar& bar, double radius, MeshBuilder& b) {
  std::vector<Ring> rings;
  for (int k = 0; k <= bar.along; ++k) {
    const double angle = bar.from + (bar.to - bar.from) * k / bar.along;
    const Vec3 outward(std::cos(angle), 0, std::sin(angle));
    Ring ring;
    for (int i = 0; i < bar.around; ++i) {
      const double around = kTurn * i / bar.around;
      ring.push_back(
          b.vertex(bar.bend * outward + radius * (std::cos(around) * outward + std::sin(around) * Vec3::UnitY())));
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

void bands(const std::vector<Ring>& rings, MeshBuilder& b) {
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) b.band(rings[i], rings[i + 1]);
}

/// The solid between the surface of `outer` and that of `inner`, from the first to the last ring of both.
TriangleMesh hollow(MeshBuilder& b, const std::vector<Ring>& outer, std::vector<Ring> inner) {
  b.band(inner.front(), outer.front());
  bands(outer, b);
  b.band(outer.back(), inner.back());
  std::reverse(inner.begin(), inner.end());
  bands(inner, b);
  return b.take();
}

/// The solid inside the surface of `rings`, with flat ends about these points.
TriangleMesh full(MeshBuilder& b, const std::vector<Ring>& rings, const Vec3& first, const Vec3& last) {
  const Ring& low = rings.front();
  b.disk(Ring(low.rbegin(), low.rend()), b.vertex(first));
  bands(rings, b);
  b.disk(rings.back(), b.vertex(last));
  return b.take();
}

}  // namespace

TriangleMesh screw(const WavyThread& t) {
  check(t);
  MeshBuilder b("screw");
  const std::vector<Ring> rings = thread_rings(t, b);
  return full(b, rings, {0, 0, t.low}, {0, 0, t.high});
}

TriangleMesh nut(const WavyThread& t, double outside) {
  check(t);
  if (!(outside > t.radius + t.depth)) throw Error("a nut is larger than its thread");
  MeshBuilder b("nut");
  const std::vector<Ring> inner = thread_rings(t, b);
  const std::vector<Ring> outer = {b.ring(outside, t.low, t.segments), b.ring(outside, t.high, t.segments)};
  return hollow(b, outer, inner);
}

TriangleMesh bent_bar(const BentBar& bar) {
  check(bar);
  MeshBuilder b("bent bar");
  const std::vector<Ring> rings = bent_rings(bar, bar.radius, b);
  const auto end = [&](double angle) { return Vec3(bar.bend * std::cos(angle), 0, bar.bend * std::sin(angle)); };
  return full(b, rings, end(bar.from), end(bar.to));
}

TriangleMesh bent_pipe(const BentBar& bore, double wall) {
  check(bore);
  if (!(wall > 0 && bore.bend > bore.radius + wall))
    throw Error("a bent pipe needs a wall, and a bend over its radius");
  MeshBuilder b("bent pipe");
  const std::vector<Ring> inner = bent_rings(bore, bore.radius, b);
  const std::vector<Ring> outer = bent_rings(bore, bore.radius + wall, b);
  return hollow(b, outer, inner);
}

}  // namespace tegotae::shapes
