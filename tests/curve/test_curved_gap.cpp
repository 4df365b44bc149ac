// The margin of the curved certificate against the profile coordinates of points along their paths.
#include "catch.hpp"
#include "core/numbers.hpp"
#include "curve_oracle.hpp"
#include "narrowphase/curved_lanes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Axes close to each other and a motion of some size; sizes over many decades.
Path random_path(std::mt19937& rng, double r) {
  Path p;
  const double lean = std::abs(spread(rng, 1e-6, 0.19)), azimuth = uniform(rng, -kPi, kPi);
  p.R0 = rotation(lean * Vec3(std::cos(azimuth), std::sin(azimuth), 0)).toRotationMatrix() *
         rotation(Vec3(0, 0, uniform(rng, -kPi, kPi))).toRotationMatrix();
  const double offset = r * std::abs(spread(rng, 1e-5, 0.4));
  p.t0 = Vec3(0, 0, uniform(rng, -3, 3) * r) + offset * direction(rng);
  p.center = uniform(rng, 0, 3) * r * direction(rng);
  p.origin = uniform(rng, 0, 6) * r * direction(rng);
  // Turns about the axis, about a line across it, about anything, or none.
  const double turn = spread(rng, 1e-5, 0.45);
  switch (rng() % 4) {
    case 0:
      p.turn = Vec3(0, 0, turn);
      break;
    case 1:
      p.turn = std::min(std::abs(turn), 0.1) * Vec3(std::cos(azimuth + 1), std::sin(azimuth + 1), 0);
      break;
    case 2:
      p.turn = std::abs(turn) * 0.5 * direction(rng);
      break;
    default:
      p.turn = Vec3::Zero();
  }
  p.dp = r * std::abs(spread(rng, 1e-6, 0.3)) * direction(rng);
  // Half of the turns are nearly about B's axis, though the center is elsewhere.
  if (rng() % 2 == 0) {
    const Vec3 c0 = p.R0 * p.center + p.t0;
    p.dp = 0.01 * p.dp + (rotation(p.turn).toRotationMatrix() * c0 - c0);
  }
  return p;
}

struct Tally {
  long claims = 0;
  Real worst = 1;  ///< least of what was there beyond what was claimed
};

/// All directions of one piece on one path.
void check_piece(std::mt19937& rng, Tally& tally) {
  const double r = std::abs(spread(rng, 2e-3, 0.03));
  const double rise = rng() % 3 == 0 ? 0 : spread(rng, 2e-5, 0.3 * r);
  const auto piece = random_piece(rng, r, rise, r * std::pow(10.0, uniform(rng, -3, -0.5)));
  const ProfileSum sum = bounds_of(piece, rise);
  if (!sum.usable()) return;
  const ProfileBox box = rounded(sum, rise);
  ProfileBox origin{};  // B: the profile's origin
  origin.r_lo = origin.r_hi = 1;
  const auto points = points_of(piece, rng, 2);
  const Path path = random_path(rng, r);
  const double floor = 1e-7;
  const AxisMotion m = axis_motion(path.frame_motion(points), rise, floor, floor, uniform(rng, -20, 20));
  if (!m.usable) return;

  // Every point at some times, its angle followed from the start.
  constexpr int kTimes = 9;
  std::vector<std::array<Cylindrical, 2 * kTimes>> seen;
  for (const Vec3& p : points) {
    Real phi = 0;
    outside(box, p, rise, &phi);
    std::array<Cylindrical, 2 * kTimes> at = [&] {
      const Cylindrical first(path.at(p, 0, false), phi + Real(m.start.psi));
      std::array<Cylindrical, 2 * kTimes> all{first, first, first, first, first, first, first, first, first,
                                              first, first, first, first, first, first, first, first, first};
      return all;
    }();
    for (const bool by_origin : {false, true}) {
      Real near = at[0].phi;
      for (int i = 0; i < kTimes; ++i) {
        // Followed in small steps.
        for (int k = 1; k <= 4; ++k) {
          const Real s = i == 0 ? 0 : (i - 1 + k / 4.0L) / (kTimes - 1);
          at[static_cast<std::size_t>(i + kTimes * by_origin)] = Cylindrical(path.at(p, s, by_origin), near);
          near = at[static_cast<std::size_t>(i + kTimes * by_origin)].phi;
        }
      }
    }
    seen.push_back(at);
  }
  const ProfileDirections& d = profile_directions();
  for (int k = 0; k < kProfileDirections; ++k) {
    for (const int sign : {1, -1}) {
      const CurvedChoice::Side side{static_cast<std::int8_t>(k), static_cast<std::int8_t>(sign)};
      double claimed = curved_margin(box, origin, m, {{side, side}, 0});
      const double alpha = sign * d.c[k], beta = sign * d.s[k];
      // Of the two copies of B the farther one is about a pitch more.
      if (rise != 0 && beta > 0) claimed += beta * 2 * kPi * std::abs(rise);
      Real least = 1e9L;
      for (const auto& at : seen)
        for (const Cylindrical& c : at) least = std::min(least, c.along(alpha, beta, rise));
      REQUIRE(least - Real(claimed) - Real(floor) >= 0);
      ++tally.claims;
      tally.worst = std::min(tally.worst, least - Real(claimed) - Real(floor));
    }
  }
}

}  // namespace

TEST_CASE("no point comes nearer along a direction than its margin says", "[curve]") {
  std::mt19937 rng(7);
  Tally tally;
  for (int i = 0; i < 4000; ++i) check_piece(rng, tally);
  INFO(tally.claims << " claims, least excess " << static_cast<double>(tally.worst));
  CHECK(tally.claims > 40000);
}

TEST_CASE("no point comes nearer than its margin says, at length", "[.long]") {
  std::mt19937 rng(1007);
  Tally tally;
  for (int i = 0; i < 70000; ++i) check_piece(rng, tally);
  CHECK(tally.claims > 1000000);
}

TEST_CASE("a margin is what is there, where axes are close and motions short", "[curve]") {
  // A peg's wall, 10 um beside the axis, leaning by 1 mrad, and a turn of 10 mrad.
  std::mt19937 rng(9);
  std::vector<Triangle> wall;
  constexpr int kFacets = 64;
  const double r = 0.01;
  for (int i = 0; i < kFacets; ++i) {
    const double a = 2 * kPi * i / kFacets, b = 2 * kPi * (i + 1) / kFacets;
    const Vec3 p(r * std::cos(a), r * std::sin(a), 0), q(r * std::cos(b), r * std::sin(b), 0), up(0, 0, 0.01);
    wall.push_back({p, q, q + up});
    wall.push_back({p, q + up, p + up});
  }
  const ProfileBox box = rounded(bounds_of(wall, 0), 0);
  Path path;
  path.R0 = rotation(Vec3(1e-3, 0, 0)).toRotationMatrix();
  path.t0 = Vec3(1e-5, 0, 0);
  path.turn = Vec3(0, 0, 0.01);
  path.dp = Vec3::Zero();
  path.center = Vec3(0, 0, 0.005);
  path.origin = Vec3::Zero();
  const AxisMotion m = axis_motion(path.frame_motion(points_of(wall, rng, 0)), 0, 0, 0, 0);
  REQUIRE(m.usable);
  ProfileBox hole{};
  hole.lo[0] = 0.0101f;
  hole.hi[0] = 0.012f;
  const double margin = curved_margin(box, hole, m, {{CurvedChoice::Side{0, -1}, CurvedChoice::Side{0, -1}}, 0});
  // The wall's farthest corner: 10 um beside, and 1 mrad over 10 mm, at right angles to each other.
  const double far = r + std::hypot(1e-5, 1e-5);
  CHECK(margin <= 0.0101 - far + 1e-8);
  CHECK(margin > 0.0101 - far - 2e-6);
}

TEST_CASE("the search finds a choice that has the margin it asks for, one by one and in rows", "[curve]") {
  std::mt19937 rng(13);
  CurvedBlocks blocks(64);
  std::vector<std::uint32_t> failed(64);
  int found = 0, failures = 0;
  for (int i = 0; i < 3000; ++i) {
    const double r = 0.01, rise = i % 3 == 0 ? 0 : spread(rng, 1e-4, 1e-3);
    const ProfileSum sa = bounds_of(random_piece(rng, r, rise, 3e-4), rise);
    const ProfileSum sb = bounds_of(random_piece(rng, r + uniform(rng, -6e-4, 6e-4), rise, 3e-4), rise);
    if (!sa.usable() || !sb.usable()) continue;
    const ProfileBox a = rounded(sa, rise), b = rounded(sb, rise);
    Path path = random_path(rng, r);
    path.t0.head<2>() *= 0.01;
    const AxisMotion m = axis_motion(path.frame_motion({Vec3(r, 0, 3 * r), Vec3(r, 0, -3 * r)}), rise, 1e-6, 1e-6, 0);
    if (!m.usable) continue;
    const double spare = i % 2 == 0 ? 0 : 1e-6;
    const auto choice = separate_curved(a, b, m, spare);
    if (!choice) continue;
    ++found;
    REQUIRE(curved_margin(a, b, m, *choice) > spare);
    // The row says the same at this motion and at another one.
    const std::size_t slot = static_cast<std::size_t>(i % 5);
    for (std::size_t k = 0; k <= slot; ++k) blocks.set(k, a, b, rise, *choice);
    REQUIRE(curved_failures(blocks, slot + 1, m, failed.data()) == 0);
    Path other = random_path(rng, r);
    other.t0.head<2>() *= 0.01;
    const AxisMotion n = axis_motion(other.frame_motion({Vec3(r, 0, 3 * r), Vec3(r, 0, -3 * r)}), rise, 1e-6, 1e-6, 0);
    const bool fails = !(curved_margin(a, b, n, *choice) > 0);
    REQUIRE(curved_failures(blocks, slot + 1, n, failed.data()) == (fails ? slot + 1 : 0));
    failures += fails;
    blocks.spoil(0);
    REQUIRE(curved_failures(blocks, 1, m, failed.data()) == 1);
  }
  CHECK(found > 300);
  CHECK(failures > 30);
}
