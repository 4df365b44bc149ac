// The wide check of planes that are fixed to one of the parts, against points followed along the motion in extended
// precision.
#include "catch.hpp"
#include "narrowphase/lane_motion.hpp"
#include "narrowphase/patch_front.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"
#include "random_motion.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// The corners of what moves past a plane, about the place of the part that they belong to: of B from the origin of its
/// tree, of A from its center of mass.
using Piece = std::vector<Real3>;

/// Least of n · x over the piece as the part that holds the plane sees it, over samples of the motion.
long double least(const Motion& m, bool on_a, const Real3& n, const Piece& piece, int samples) {
  long double lowest = std::numeric_limits<long double>::infinity();
  for (const bool by_origin : {false, true}) {
    for (int i = 0; i <= samples; ++i) {
      const Motion::At at = m.at(static_cast<long double>(i) / samples, by_origin);
      for (const Real3& x : piece) {
        const Real3 seen = on_a ? Real3(at.R.transpose() * (x - at.center)) : Real3(at.R * x + at.center);
        lowest = std::min(lowest, n.dot(seen));
      }
    }
  }
  return lowest;
}

struct Count {
  long asked = 0, apart = 0, wrong = 0;
  double closest = 1e9;  ///< of the claims: what was left, in parts of what was taken off for the motion
};

/// The corners of a box about `center` of up to 0.3 of `size`, put into lane `i`.
Piece put_box(std::mt19937& rng, const Vec3& center, double size, std::size_t i, LaneBlocks& lanes) {
  Piece piece;
  const Quat q = rotation(random_in_ball(rng, 3));
  std::array<Real3, 3> edge;
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = q * Vec3::Unit(k) * (0.3 * size * std::pow(10.0, uniform(rng, -3, 0)));
    for (int j = 0; j < 3; ++j) edge[k][j] = lanes.at(i, kBoxEdges + 3 * k + j) = static_cast<float>(e[j]);
    lanes.at(i, kBoxCenter + k) = static_cast<float>(center[k]);
  }
  for (int corner = 0; corner < 8; ++corner) {
    Real3 x = center.cast<long double>();
    for (int k = 0; k < 3; ++k) x += (corner >> k & 1 ? 1 : -1) * edge[k];
    piece.push_back(x);
  }
  return piece;
}

/// The same of a triangle.
Piece put_triangle(std::mt19937& rng, const Vec3& center, double size, std::size_t i, LaneBlocks& lanes) {
  Piece piece;
  for (int k = 0; k < 3; ++k) {
    const Vec3 x = center + random_in_ball(rng, 0.3 * size);
    for (int j = 0; j < 3; ++j) lanes.at(i, kTriCorners + 3 * k + j) = static_cast<float>(x[j]);
    piece.push_back(x.cast<long double>());
  }
  return piece;
}

double reach_of(const Piece& piece) {
  double far = 0;
  for (const Real3& x : piece) far = std::max(far, static_cast<double>(x.norm()));
  return far;
}

/// kLanes pieces that go past planes at distances where the bulge decides.
void ask(std::mt19937& rng, const PatchTree& tree_b, bool on_a, bool boxes, Count& count) {
  const Motion m(rng, tree_b);
  LaneBlocks lanes(kLanes, boxes ? std::size_t{kBoxFields} : std::size_t{kTriFields});
  const double reach = 2 * m.size;
  std::array<Piece, kLanes> pieces;
  std::array<Real3, kLanes> normals;
  std::array<long double, kLanes> offsets;
  const double away = m.sweep.start.t.norm();
  const PairSizes sizes{reach, reach, reach + away, reach + away};
  const LaneSweep seen = on_a ? seen_from_a(m.sweep, sizes) : seen_from_b(m.sweep, sizes);
  for (std::size_t i = 0; i < kLanes; ++i) {
    // About where A is, so that B's pieces are near it.
    const Vec3 about = on_a ? m.sweep.start.t : Vec3(Vec3::Zero());
    const Vec3 center = about + random_in_ball(rng, m.size);
    Vec3 n = random_in_ball(rng, 1).normalized();
    // What turns and goes across the axis of the turn leaves its chord this way.
    const Vec3 aside = m.sweep.start.R.transpose() * m.d.dr.cross(m.d.dp);
    if (on_a && i % 2 == 0 && aside.norm() > 0) n = (aside.normalized() + 0.1 * n).normalized() * (i % 4 == 0 ? 1 : -1);
    for (int k = 0; k < 3; ++k) {
      lanes.at(i, kBoxNormal + k) = static_cast<float>(n[k]);
      normals[i][k] = lanes.at(i, kBoxNormal + k);
    }
    pieces[i] = (boxes ? put_box : put_triangle)(rng, center, m.size, i, lanes);
    const double far = reach_of(pieces[i]);
    (boxes ? lanes.at(i, kBoxReach) : lanes.at(i, kTriReach)) = round_up<float>(far);
    // Its corner at the ends of the motion, and the plane below it by about what is taken off.
    const double taken = far * seen.fine.bulge + seen.fine.bulge_offset + seen.fine.error;
    const long double low = least(m, on_a, normals[i], pieces[i], 1);
    offsets[i] = low - uniform(rng, 0.9, 1.1) * taken;
    lanes.at(i, kBoxOffset) = static_cast<float>(offsets[i]);
  }
  std::array<std::uint32_t, kLanes> failed;
  const std::size_t failures = (boxes ? box_failures : triangle_failures)(lanes, 0, kLanes, seen, failed.data());
  std::array<bool, kLanes> fails{};
  for (std::size_t i = 0; i < failures; ++i) fails[failed[i]] = true;
  for (std::size_t i = 0; i < kLanes; ++i) {
    ++count.asked;
    if (fails[i]) continue;
    ++count.apart;
    const long double left = least(m, on_a, normals[i], pieces[i], 8) - offsets[i];
    count.wrong += !(left > 0);
    const double bulge = seen.fine.bulge * static_cast<double>(pieces[i][0].norm()) + seen.fine.bulge_offset;
    if (bulge > 100 * seen.fine.error) count.closest = std::min(count.closest, static_cast<double>(left) / bulge);
  }
}

void check(long each) {
  std::mt19937 rng(211);
  const PatchTree b(soup(rng, 20, 0.05, 0.01));
  for (const bool on_a : {false, true}) {
    for (const bool boxes : {false, true}) {
      Count count;
      while (count.asked < each) ask(rng, b, on_a, boxes, count);
      CAPTURE(on_a, boxes, count.asked, count.apart, count.closest);
      CHECK(count.wrong == 0);
      CHECK(5 * count.apart > count.asked);
      CHECK(count.closest < 0.7);  // the bulge is needed
    }
  }
}

}  // namespace

TEST_CASE("what keeps off a plane that is fixed to either part does so all the way", "[patch]") {
  check(20000);
}
TEST_CASE("what keeps off a plane that is fixed to either part, at length", "[.long]") {
  check(500000);
}

TEST_CASE("planes on the hollow side last while facets slide on each other", "[patch]") {
  // A pin of 36 facets in a ring of as many, that turn against each other at 5 µm, less than their sagittas.
  constexpr int kFacets = 36;
  constexpr double kPin = 0.01;
  std::vector<std::pair<double, double>> outer{{0, -0.005}}, inner;
  line(outer, kPin, -0.005, 1);
  line(outer, kPin, 0.025, 20);
  line(outer, 0, 0.025, 1);
  const double bore = (kPin + 5e-6) / std::cos(kPi / kFacets);
  inner.emplace_back(bore, 0);
  line(inner, bore, 0.02, 12);
  line(inner, 2 * kPin, 0.02, 1);
  line(inner, 2 * kPin, 0, 1);
  line(inner, bore, 0, 1);
  const MeshPtr pin = revolve(outer, kFacets), ring = revolve(inner, kFacets);
  const Vec3 center = Vec3::Zero();
  const auto searches = [&](const MeshPtr& held, const MeshPtr& fixed) {
    const PatchTree a(held), b(fixed);
    const Oracle oracle(held, fixed);
    const ScrewFrame axis;
    const std::vector<AxisPair> axes = {
        {std::make_shared<const ProfileTree>(a, axis), std::make_shared<const ProfileTree>(b, axis)}};
    PatchFront front(FrontCapacity{1u << 15, 32, 1u << 10});
    front.attach(a, center, b, &axes);
    long total = 0;
    for (int i = 0; i < 200; ++i) {
      const Pose X{rotation(Vec3(0, 0, 1e-3 * i)), Vec3(0, 0, 0)};
      const Displacement d{Vec3::Zero(), Vec3(0, 0, 1e-3)};
      const CertifyReport r = front.certify(X, d);
      REQUIRE(r.status == CertifyStatus::certified);
      if (i % 20 == 0) REQUIRE(oracle.hits(X, center, d, 8) == 0);
      if (i >= 20) total += r.searches;
    }
    return total;
  };
  const long ring_held = searches(ring, pin), pin_held = searches(pin, ring);
  CAPTURE(ring_held, pin_held);
  CHECK(ring_held > 0);
  CHECK(ring_held < 2 * pin_held);
  CHECK(pin_held < 2 * ring_held);
}

TEST_CASE("no number of the wide check is subnormal, however small a turn is", "[patch]") {
  // Such a number makes a check take ten times as long on some processors.
  const MeshPtr mesh = box({0.02, 0.01, 0.005});
  const PatchTree tree(mesh);
  const Vec3 center(0.001, 0.002, 0);
  std::mt19937 rng(5);
  const PairSizes sizes{0.03, 0.03, 0.03, 0.03};
  const auto normal = [](const auto& m) {
    const auto good = [](auto x) { return std::fpclassify(x) != FP_SUBNORMAL; };
    const auto all = [&](const auto& v) { return std::all_of(v.begin(), v.end(), good); };
    return all(m.R0) && all(m.R1) && all(m.t0) && all(m.t1) && good(m.bulge) && good(m.bulge_offset) && good(m.error);
  };
  for (int i = 0; i < 2000; ++i) {
    const auto tiny = [&](int k) { return i % k == 0 ? 0.0 : std::pow(10.0, uniform(rng, -330, 0)); };
    const Pose X{rotation(random_in_ball(rng, tiny(3))), random_in_ball(rng, tiny(5))};
    const Displacement d{random_in_ball(rng, 1e-3 * tiny(7)), random_in_ball(rng, tiny(2))};
    const Sweep sweep(X, d, center, tree, 0.03, i % 11 == 0 ? 0 : 1.1e-6);
    for (const LaneSweep& seen : {seen_from_b(sweep, sizes), seen_from_a(sweep, sizes)}) {
      REQUIRE(normal(seen.coarse));
      REQUIRE(normal(seen.fine));
      REQUIRE(seen.fine.bulge >= sweep.theta2 / 8);
    }
  }
}
