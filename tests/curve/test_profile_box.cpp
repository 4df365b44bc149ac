// Bounds in profile coordinates hold every point of their triangles.
#include "catch.hpp"
#include "curve_oracle.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

bool in_arc(const ProfileBox& box, const Vec3& p) {
  const double turn =
      std::remainder(std::atan2(p.y(), p.x()) - static_cast<double>(box.azimuth), 2 * static_cast<double>(kRealPi));
  return box.half >= 3.14f || std::abs(turn) <= box.half;
}

}  // namespace

TEST_CASE("profile bounds hold all points of a piece", "[curve]") {
  std::mt19937 rng(1);
  int usable = 0;
  double widest = 0;
  for (int i = 0; i < 3000; ++i) {
    const double r = std::abs(spread(rng, 1e-3, 0.05));
    const double rise = i % 3 == 0 ? 0 : spread(rng, 1e-5, 3e-3);
    const auto piece = random_piece(rng, r, rise, r * std::pow(10.0, uniform(rng, -4, -0.3)));
    const ProfileSum sum = bounds_of(piece, rise);
    if (!sum.usable()) continue;
    ++usable;
    const ProfileBox box = rounded(sum, rise), turned = flipped(box);
    for (const Vec3& p : points_of(piece, rng, 6)) {
      REQUIRE(outside(box, p, rise) <= 0);
      const double rp = p.head<2>().norm();
      REQUIRE((box.r_lo <= rp && rp <= box.r_hi && box.z_lo <= p.z() && p.z() <= box.z_hi));
      REQUIRE(in_arc(box, p));
      const Vec3 q(p.x(), -p.y(), -p.z());
      REQUIRE(outside(turned, q, rise) <= 0);
      REQUIRE((turned.z_lo <= q.z() && q.z() <= turned.z_hi));
      REQUIRE(in_arc(turned, q));
    }
    widest = std::max(widest, static_cast<double>(box.half));
  }
  CHECK(usable > 2000);
  CHECK(widest > 2.5);
}

TEST_CASE("profile bounds of a triangle are tight", "[curve]") {
  // Against bounds from 2000 points: what they are wider by is what the certificate cannot see.
  std::mt19937 rng(2);
  for (int i = 0; i < 300; ++i) {
    const double r = 0.01, rise = i % 2 == 0 ? 0 : 3e-4;
    const double width = 0.06;  // rad: 100 facets around
    Triangle t;
    for (Vec3& v : t) {
      const double a = uniform(rng, 0, width);
      v = Vec3(r * std::cos(a), r * std::sin(a), uniform(rng, 0, 1e-3));
    }
    const ProfileSum sum = profile_of(t, rise);
    const ProfileDirections& d = profile_directions();
    std::array<Real, kProfileDirections> lo, hi;
    lo.fill(1e9L);
    hi.fill(-1e9L);
    for (const Vec3& p : points_of({t}, rng, 2000)) {
      const Cylindrical c(p.cast<Real>(), 0);
      for (int k = 0; k < kProfileDirections; ++k) {
        const Real f = c.along(d.c[k], d.s[k], rise);
        lo[k] = std::min(lo[k], f);
        hi[k] = std::max(hi[k], f);
      }
    }
    // The sagitta of such a facet is 4.5 um.
    for (int k = 0; k < kProfileDirections; ++k) {
      CHECK(lo[k] - Real(sum.lo[k]) < 1e-6L);
      CHECK(Real(sum.hi[k]) - hi[k] < 1e-6L);
    }
  }
}

TEST_CASE("pieces at the axis are not usable", "[curve]") {
  CHECK(!profile_of({Vec3(-1, -1, 0), Vec3(1, -1, 0.5), Vec3(0, 1, 0)}, 0).usable());
  CHECK(!profile_of({Vec3(-1, 0, 0), Vec3(1, 0, 0.5), Vec3(0.1, 0, 1)}, 0.3).usable());
  // A triangle in a plane through the axis, beside it.
  CHECK(profile_of({Vec3(1, 0, 0), Vec3(1.2, 0, 0.5), Vec3(1.1, 0, 1)}, 0.3).usable());
  const ProfileSum off = profile_of({Vec3(1, 0, 0), Vec3(1.2, 0, 0.5), Vec3(1.1, 0.1, 1)}, 0.1);
  const ProfileSum on = profile_of({Vec3(-1, -1, 0), Vec3(1, -1, 0.5), Vec3(0, 1, 0)}, 0.1);
  CHECK(!joined(off, on, 0.1).usable());
  CHECK(!joined(on, off, 0.1).usable());
}
