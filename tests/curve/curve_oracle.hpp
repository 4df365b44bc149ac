// Profile coordinates along rigid paths, point by point in extended precision: what the curved certificate bounds.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "curve/axis_motion.hpp"
#include "curve/profile_box.hpp"

namespace tegotae::test {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using RealMat = Eigen::Matrix<Real, 3, 3>;
inline constexpr Real kRealPi = 3.14159265358979323846264338327950288L;

inline double uniform(std::mt19937& rng, double lo, double hi) {
  return std::uniform_real_distribution<double>(lo, hi)(rng);
}
/// 10^u, u uniform between the logarithms, with a random sign.
inline double spread(std::mt19937& rng, double lo, double hi) {
  const double x = std::pow(10.0, uniform(rng, std::log10(lo), std::log10(hi)));
  return rng() % 2 == 0 ? x : -x;
}
inline Vec3 direction(std::mt19937& rng) {
  for (;;) {
    const double x = uniform(rng, -1, 1), y = uniform(rng, -1, 1), z = uniform(rng, -1, 1);
    const Vec3 v(x, y, z);
    if (v.squaredNorm() <= 1 && v.squaredNorm() > 0.01) return v.normalized();
  }
}

inline Real angle_near(Real angle, Real near) {
  return angle + 2 * kRealPi * std::round((near - angle) / (2 * kRealPi));
}

using Triangle = std::array<Vec3, 3>;

/// Corners of the triangles and points inside.
inline std::vector<Vec3> points_of(const std::vector<Triangle>& piece, std::mt19937& rng, int inside) {
  std::vector<Vec3> out;
  for (const Triangle& t : piece) {
    out.insert(out.end(), t.begin(), t.end());
    for (int i = 0; i < inside; ++i) {
      double u = uniform(rng, 0, 1), v = uniform(rng, 0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      out.push_back(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
    }
  }
  return out;
}

/// r, φ, z of a point, φ next to `near`.
struct Cylindrical {
  Real r, phi, z;
  Cylindrical(const Real3& x, Real near)
      : r(std::hypot(x.x(), x.y())), phi(angle_near(std::atan2(x.y(), x.x()), near)), z(x.z()) {}
  Real along(double alpha, double beta, double rise) const { return alpha * r + beta * (z - rise * phi); }
};

/// How far the bounds leave out the best of a point's angles: ≤ 0 where they hold it.
template <typename Box>
Real outside(const Box& box, const Vec3& p, double rise, Real* phi = nullptr) {
  const ProfileDirections& d = profile_directions();
  Real least = 1e9L;
  const Real3 x = p.cast<Real>();
  const Cylindrical first(x, 0);
  // All turns that bring w between its bounds.
  constexpr int kAlong = kProfileDirections / 2;
  long begin = 0, end = 0;
  if (rise != 0) {
    const Real w = first.z - rise * first.phi, pitch = 2 * kRealPi * rise;
    const Real u = (w - Real(box.lo[kAlong])) / pitch, v = (w - Real(box.hi[kAlong])) / pitch;
    begin = static_cast<long>(std::floor(std::min(u, v)));
    end = static_cast<long>(std::ceil(std::max(u, v)));
  }
  for (long turns = begin; turns <= end; ++turns) {
    Cylindrical c = first;
    c.phi += 2 * kRealPi * turns;
    Real worst = -1e9L;
    for (int k = 0; k < kProfileDirections; ++k) {
      const Real f = c.along(d.c[k], d.s[k], rise);
      worst = std::max({worst, Real(box.lo[k]) - f, f - Real(box.hi[k])});
    }
    if (worst >= least) continue;
    least = worst;
    if (phi != nullptr) *phi = c.phi;
  }
  return least;
}

/// A motion of A's frame with two points of A that may go linearly.
struct Path {
  Mat3 R0;
  Vec3 t0, turn, dp;
  Vec3 center, origin;  ///< in A's frame

  RealMat turned(Real s) const {
    const Real angle = turn.cast<Real>().norm();
    if (angle == 0) return R0.cast<Real>();
    return Eigen::AngleAxis<Real>(s * angle, turn.cast<Real>() / angle).toRotationMatrix() * R0.cast<Real>();
  }
  Real3 fixed_at(const Vec3& p, Real s) const {  // of a point p that goes linearly because `center` does
    const Real3 c0 = R0.cast<Real>() * center.cast<Real>() + t0.cast<Real>();
    return turned(s) * (p - center).cast<Real>() + c0 + s * dp.cast<Real>();
  }
  /// Where p is at s when the center goes linearly, or the origin between the same ends.
  Real3 at(const Vec3& p, Real s, bool by_origin) const {
    if (!by_origin) return fixed_at(p, s);
    const Real3 o = (1 - s) * fixed_at(origin, 0) + s * fixed_at(origin, 1);
    return turned(s) * (p - origin).cast<Real>() + o;
  }

  FrameMotion frame_motion(const std::vector<Vec3>& points) const {
    FrameMotion m;
    m.R0 = R0;
    m.t0 = t0;
    m.R1 = turned(1).cast<double>();
    m.t1 = fixed_at(Vec3::Zero(), 1).cast<double>();
    m.turn = turn;
    m.center0 = fixed_at(center, 0).cast<double>();
    m.center1 = fixed_at(center, 1).cast<double>();
    m.origin0 = fixed_at(origin, 0).cast<double>();
    m.origin1 = fixed_at(origin, 1).cast<double>();
    m.size = t0.norm() + m.t1.norm() + center.norm() + origin.norm();
    for (const Vec3& p : points) {
      m.reach_center = std::max(m.reach_center, (p - center).norm());
      m.reach_origin = std::max(m.reach_origin, (p - origin).norm());
      m.size = std::max(m.size, t0.norm() + p.norm());
    }
    return m;
  }
};

/// Triangles on and about a screw surface.
inline std::vector<Triangle> random_piece(std::mt19937& rng, double r, double rise, double width) {
  const double phi = uniform(rng, -3.5, 3.5), z = uniform(rng, -2, 2) * r;
  const double arc = std::pow(10.0, uniform(rng, -2, 0.8)), tall = width;
  std::vector<Triangle> piece;
  const int n = 1 + static_cast<int>(rng() % 12);
  for (int i = 0; i < n; ++i) {
    const double a = phi + uniform(rng, -0.5, 0.5) * arc, h = z + uniform(rng, -0.5, 0.5) * tall + rise * (a - phi);
    Triangle t;
    for (Vec3& v : t) {
      const double b = a + uniform(rng, -0.15, 0.15), q = r + uniform(rng, -0.5, 0.5) * tall;
      v = Vec3(q * std::cos(b), q * std::sin(b), h + rise * (b - a) + uniform(rng, -0.3, 0.3) * tall);
    }
    piece.push_back(t);
  }
  return piece;
}

inline ProfileSum bounds_of(const std::vector<Triangle>& piece, double rise) {
  ProfileSum sum = profile_of(piece[0], rise);
  for (std::size_t i = 1; i < piece.size(); ++i) sum = joined(sum, profile_of(piece[i], rise), rise);
  return sum;
}

}  // namespace tegotae::test
