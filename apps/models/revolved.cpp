#include "models/revolved.hpp"

#include <cmath>
#include <utility>

#include "core/numbers.hpp"
#include "models/mesh_builder.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {
namespace {}  // namespace

TriangleMesh revolved(const std::string& name, const std::vector<ProfilePoint>& profile, int segments) {
  const std::size_t n = profile.size();
  if (n < 3 || segments < 3) throw Error("a solid of revolution needs 3 points and 3 segments");
  const bool first_pole = profile.front().r == 0, last_pole = profile.back().r == 0;
  if (first_pole != last_pole) throw Error("a profile must have both of its ends on the axis, or none");
  MeshBuilder b(name);
  const auto ring_at = [&](std::size_t i) { return b.ring(profile[i].r, profile[i].z, segments); };
  const std::size_t begin = first_pole ? 1 : 0, end = last_pole ? n - 1 : n;
  for (std::size_t i = begin; i < end; ++i)
    if (!(profile[i].r > 0)) throw Error("a profile may touch the axis at its ends alone");
  const Ring first = ring_at(begin);
  if (first_pole) b.disk(Ring(first.rbegin(), first.rend()), b.vertex({0, 0, profile.front().z}));
  Ring ring = first;
  for (std::size_t i = begin + 1; i < end; ++i) {
    Ring upper = ring_at(i);
    b.band(ring, upper);
    ring = std::move(upper);
  }
  if (last_pole)
    b.disk(ring, b.vertex({0, 0, profile.back().z}));
  else
    b.band(ring, first);
  return b.take();
}

std::vector<ProfilePoint> arc(double r, double z, double radius, double from, double to, int n) {
  std::vector<ProfilePoint> points;
  for (int i = 0; i <= n; ++i) {
    const double angle = i == n ? to : from + (to - from) * i / n;
    points.push_back({r + radius * std::cos(angle), z + radius * std::sin(angle)});
  }
  return points;
}

TriangleMesh socket(const Socket& s) {
  const double radius = s.diameter / 2;
  if (!(radius > 0 && s.center >= 0 && s.center < radius && s.wall > 0 && s.rings >= 1))
    throw Error("a socket needs a size, a wall, a ring, and its center at most a radius above its face");
  const double rim = std::sqrt(radius * radius - s.center * s.center);
  const double outside = rim + s.wall, floor = s.center - radius - s.wall;
  std::vector<ProfilePoint> profile = {{0, floor}, {outside, floor}, {outside, 0}};
  std::vector<ProfilePoint> cavity = arc(0, s.center, radius, -std::asin(s.center / radius), -kPi / 2, s.rings);
  cavity.front() = {rim, 0};
  cavity.back().r = 0;
  profile.insert(profile.end(), cavity.begin(), cavity.end());
  return revolved("socket", profile, s.segments);
}

}  // namespace tegotae::shapes
