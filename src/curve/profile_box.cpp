#include "curve/profile_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"

namespace tegotae {
namespace {

/// A triangle is cut into pieces over which r deviates from linear by at most this part of it, as far as so many cuts
/// go.
constexpr double kSagitta = 3e-5;
constexpr int kMaxExhausted = 8;
/// Rounding of the sums that make one bound, relative to their terms (some 10 operations of 1.1e-16).
constexpr double kRounding = 1e-14;
/// Enlargement of arcs: covers the rounding of angles and of their sines and cosines.
constexpr double kArcSlack = 1e-6;

double wrapped(double angle) {
  return angle - 2 * kPi * std::round(angle / (2 * kPi));
}

double cross2(const Vec3& a, const Vec3& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Distance of the triangle from the z axis; 0 where it meets it.
double distance_from_axis(const std::array<Vec3, 3>& v) {
  double least = std::numeric_limits<double>::infinity();
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = v[i], e = v[(i + 1) % 3] - a;
    const double length2 = e.head<2>().squaredNorm();
    const double t = length2 > 0 ? std::clamp(-a.head<2>().dot(e.head<2>()) / length2, 0.0, 1.0) : 0.0;
    least = std::min(least, (a + t * e).head<2>().norm());
    const double side = cross2(a, e);
    left += side >= 0;
    right += side <= 0;
  }
  // On one side of all edges; a triangle seen edge-on is on both sides of all and has no inside.
  return (left == 3) != (right == 3) ? 0 : least;
}

}  // namespace

ScrewFrame ScrewFrame::of(const ScrewAxis& axis, double rise) {
  ScrewFrame f;
  const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), axis.direction).normalized();
  f.R = q.toRotationMatrix();
  f.origin = axis.origin;
  f.rise = rise;
  return f;
}

const ProfileDirections& profile_directions() {
  static const ProfileDirections directions = [] {
    ProfileDirections d;
    for (int k = 0; k < kProfileDirections; ++k) {
      d.c[k] = std::cos(k * kPi / kProfileDirections);
      d.s[k] = std::sin(k * kPi / kProfileDirections);
    }
    d.s[0] = 0;
    d.c[kProfileDirections / 2] = 0;
    return d;
  }();
  return directions;
}

// See docs/decisions/0077-curved-certificate.md for the bounds between the sampled points.
ProfileSum profile_of(const std::array<Vec3, 3>& v, double rise) {
  const ProfileDirections& d = profile_directions();
  ProfileSum p;
  p.lo.fill(std::numeric_limits<double>::infinity());
  p.hi.fill(-std::numeric_limits<double>::infinity());
  p.z_lo = std::min({v[0].z(), v[1].z(), v[2].z()});
  p.z_hi = std::max({v[0].z(), v[1].z(), v[2].z()});
  p.r_hi = 0;
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    p.r_hi = std::max(p.r_hi, v[i].head<2>().norm());
    longest = std::max(longest, (v[(i + 1) % 3] - v[i]).head<2>().norm());
  }
  p.r_lo = distance_from_axis(v) * (1 - kRounding) - kRounding * p.r_hi;
  // An arc is known from its ends as long as it is less than half a turn.
  if (!(p.r_lo > 0) || !(longest < p.r_lo)) {
    p.r_lo = p.azimuth = 0;
    p.half = kPi;
    p.lo.fill(0);
    p.hi.fill(0);
    return p;
  }
  const double ratio = longest / p.r_lo;
  const int cuts = std::clamp(static_cast<int>(std::ceil(ratio / std::sqrt(6 * kSagitta))), 1, kMaxExhausted);
  const Vec3 middle = (v[0] + v[1] + v[2]) / 3;
  const double about = std::atan2(middle.y(), middle.x());
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (int i = 0; i <= cuts; ++i) {
    for (int j = 0; i + j <= cuts; ++j) {
      const Vec3 x = v[0] + (v[1] - v[0]) * i / cuts + (v[2] - v[0]) * j / cuts;
      const double r = x.head<2>().norm(), phi = about + wrapped(std::atan2(x.y(), x.x()) - about);
      const double w = x.z() - rise * phi;
      first = std::min(first, phi);
      last = std::max(last, phi);
      for (int k = 0; k < kProfileDirections; ++k) {
        const double f = d.c[k] * r + d.s[k] * w;
        p.lo[k] = std::min(p.lo[k], f);
        p.hi[k] = std::max(p.hi[k], f);
      }
    }
  }
  const double angle = ratio * ratio / (6 * cuts * cuts), sag = angle * p.r_lo;
  for (int k = 0; k < kProfileDirections; ++k) {
    const double turn = std::abs(d.s[k] * rise) * angle;
    p.lo[k] -= std::max(0.0, d.c[k]) * sag + turn;
    p.hi[k] += std::max(0.0, -d.c[k]) * sag + turn;
  }
  p.azimuth = 0.5 * (first + last);
  p.half = 0.5 * (last - first) + angle + kArcSlack;
  return p;
}

ProfileSum joined(const ProfileSum& a, const ProfileSum& b, double rise) {
  const ProfileDirections& d = profile_directions();
  ProfileSum p = a;
  if (!a.usable() || !b.usable()) {
    p.r_lo = 0;
    p.half = kPi;
  }
  // The turns of b's angles that bring its w nearest to a's.
  constexpr int kAlong = kProfileDirections / 2;
  double shift = 0;
  if (rise != 0) {
    const double pitch = 2 * kPi * rise;
    shift = pitch * std::round((a.lo[kAlong] + a.hi[kAlong] - b.lo[kAlong] - b.hi[kAlong]) / (2 * pitch));
  }
  for (int k = 0; k < kProfileDirections; ++k) {
    p.lo[k] = std::min(a.lo[k], b.lo[k] + d.s[k] * shift);
    p.hi[k] = std::max(a.hi[k], b.hi[k] + d.s[k] * shift);
  }
  p.r_lo = std::min(p.r_lo, b.r_lo);
  p.r_hi = std::max(a.r_hi, b.r_hi);
  p.z_lo = std::min(a.z_lo, b.z_lo);
  p.z_hi = std::max(a.z_hi, b.z_hi);
  const double turn = wrapped(b.azimuth - a.azimuth);
  const double first = std::min(-a.half, turn - b.half), last = std::max(a.half, turn + b.half);
  p.azimuth = wrapped(a.azimuth + 0.5 * (first + last));
  p.half = std::min(kPi, 0.5 * (last - first) + 1e-15);
  return p;
}

ProfileBox rounded(const ProfileSum& p, double rise) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const double error = kRounding * (p.r_hi + std::abs(p.z_lo) + std::abs(p.z_hi) + 4 * kPi * std::abs(rise));
  const auto down = [&](double x) { return std::nextafter(static_cast<float>(x - error), -kInf); };
  const auto up = [&](double x) { return std::nextafter(static_cast<float>(x + error), kInf); };
  ProfileBox out;
  for (int k = 0; k < kProfileDirections; ++k) {
    out.lo[k] = down(p.lo[k]);
    out.hi[k] = up(p.hi[k]);
  }
  out.r_lo = p.r_lo > 0 ? std::max(0.0f, down(p.r_lo)) : 0;
  out.r_hi = up(p.r_hi);
  out.z_lo = down(p.z_lo);
  out.z_hi = up(p.z_hi);
  out.azimuth = static_cast<float>(p.azimuth);
  out.half = std::nextafter(static_cast<float>(p.half + kArcSlack), kInf);
  return out;
}

ProfileBox flipped(const ProfileBox& p) {
  // w changes its sign with z and φ: the direction (c, s) becomes (c, −s), the opposite of the one at 180° less.
  ProfileBox out = p;
  for (int k = 1; k < kProfileDirections; ++k) {
    out.lo[k] = -p.hi[kProfileDirections - k];
    out.hi[k] = -p.lo[kProfileDirections - k];
  }
  out.z_lo = -p.z_hi;
  out.z_hi = -p.z_lo;
  out.azimuth = -p.azimuth;
  return out;
}

}  // namespace tegotae
