// What holds a part must be contacts, whatever its surface is made of: fans of needles, slivers, T-junctions, open flat
// sheets, poles, noise. FCL is the judge: no motion that the constraints of a tick allow may make triangles intersect.
#include <cstdio>

#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "lp/least_distance.hpp"
#include "models/shapes.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/mesh/mass.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr int kMotions = 200;
// Tried motions carry points so far (m): what is farther than a contact may be is not reached, what is known to be
// nearer keeps half of its gap, and what is not known is entered.
constexpr double kLength = 2e-5;
// Of a pen that presses, how much the hand may turn its wish to other sides.
constexpr double kTremor = 0.3;

/// A disk of triangles about z that meet in its middle, height `z`, with the rest of a cylinder under it.
TriangleMesh fan_cylinder(double radius, double depth, int n) {
  TriangleMesh m;
  for (const double z : {-depth, 0.0})
    for (int i = 0; i < n; ++i) {
      const double a = 2 * M_PI * (i + 0.3) / n;
      m.vertices.push_back({radius * std::cos(a), radius * std::sin(a), z});
    }
  m.vertices.push_back({0, 0, -depth});
  m.vertices.push_back({0, 0, 0});
  const auto N = static_cast<std::uint32_t>(n);
  for (std::uint32_t i = 0; i < N; ++i) {
    const std::uint32_t j = (i + 1) % N;
    m.triangles.push_back({i, j, N + j});
    m.triangles.push_back({i, N + j, N + i});
    m.triangles.push_back({2 * N, j, i});
    m.triangles.push_back({2 * N + 1, N + i, N + j});
  }
  return m;
}

/// An open sheet over [-size/2, size/2]², height from `z(x, y)`.
template <typename Z>
TriangleMesh sheet(double size, std::uint32_t nx, std::uint32_t ny, Z z) {
  TriangleMesh m;
  for (std::uint32_t i = 0; i <= nx; ++i)
    for (std::uint32_t k = 0; k <= ny; ++k) {
      const double x = size * (i / double(nx) - 0.5), y = size * (k / double(ny) - 0.5);
      m.vertices.push_back({x, y, z(x, y)});
    }
  for (std::uint32_t i = 0; i < nx; ++i)
    for (std::uint32_t k = 0; k < ny; ++k) {
      const std::uint32_t a = i * (ny + 1) + k, b = a + ny + 1;
      m.triangles.push_back({a, b, b + 1});
      m.triangles.push_back({a, b + 1, a + 1});
    }
  return m;
}

TriangleMesh flat_sheet(double size, std::uint32_t nx, std::uint32_t ny) {
  return sheet(size, nx, ny, [](double, double) { return 0.0; });
}

/// Two halves with different divisions along the line where they meet.
TriangleMesh t_junctions() {
  TriangleMesh m = shapes::moved(flat_sheet(0.04, 1, 1), {-0.02, 0, 0});
  const TriangleMesh fine = shapes::moved(flat_sheet(0.04, 3, 7), {0.02, 0, 0});
  const auto first = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.insert(m.vertices.end(), fine.vertices.begin(), fine.vertices.end());
  for (auto t : fine.triangles) {
    for (std::uint32_t& v : t) v += first;
    m.triangles.push_back(t);
  }
  return m;
}

TriangleMesh noise(double size, std::uint32_t n, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> height(-2e-5, 2e-5);
  return sheet(size, n, n, [&](double, double) { return height(rng); });
}

struct Case {
  const char* name;
  TriangleMesh fixed, held;
  Pose start;
  bool flat = true;  ///< contacts are to hold against motions to all sides, otherwise against the pen and tremor
};

std::vector<Case> cases() {
  const TriangleMesh block = shapes::moved(box({0.012, 0.012, 0.01}), {0, 0, 0.005});
  const TriangleMesh floor = shapes::moved(shapes::box({0.1, 0.1, 0.02}), {0, 0, -0.01});
  const auto at = [](double x, double y, double z, double turn = 0) {
    return Pose{Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())), {x, y, z}};
  };
  std::vector<Case> list;
  list.push_back({"block on a fan of 90", fan_cylinder(0.03, 0.01, 90), block, at(-0.014, 0.006, 0.0005, 0.4)});
  list.push_back({"block on a fan of 1440", fan_cylinder(0.03, 0.01, 1440), block, at(-0.014, 0.006, 0.0005, 1.1)});
  list.push_back(
      {"block over the middle of a fan", fan_cylinder(0.03, 0.01, 360), block, at(0.001, 0.0005, 0.0005, 0.2)});
  list.push_back({"block over the rim of a fan", fan_cylinder(0.03, 0.01, 180), block, at(0.024, 0.004, 0.0005, 0.3)});
  list.push_back(
      {"fan on a floor", floor, shapes::moved(fan_cylinder(0.02, 0.01, 720), {0, 0, 0.01}), at(0.01, 0, 0.0005)});
  list.push_back({"fan on a fan", fan_cylinder(0.03, 0.01, 200),
                  shapes::moved(fan_cylinder(0.02, 0.01, 130), {0, 0, 0.01}), at(0.018, 0.007, 0.0005)});
  list.push_back(
      {"open sheet on an open sheet", flat_sheet(0.08, 1, 1), flat_sheet(0.03, 1, 1), at(0.01, 0.005, 0.0005, 0.5)});
  list.push_back(
      {"open sheets that cross", flat_sheet(0.04, 1, 1), flat_sheet(0.04, 12, 9), at(0.015, 0.012, 0.0005, 0.6)});
  list.push_back({"block on T-junctions", t_junctions(), block, at(0.002, 0.003, 0.0005, 0.7)});
  list.push_back({"block on slivers", flat_sheet(0.06, 1, 2000), block, at(0.004, 0.002, 0.0005, 0.7)});
  list.push_back({"pole of a sphere on a floor", floor, shapes::moved(shapes::sphere(0.02, 96, 48), {0, 0, 0.0101}),
                  at(0, 0, 0.0004), false});
  list.push_back({"block on the pole of a sphere", shapes::moved(shapes::sphere(0.04, 128, 64), {0, 0, -0.02}), block,
                  at(0.001, 0.0005, 0.0005, 0.3), false});
  list.push_back({"noise on noise", noise(0.05, 40, 5), noise(0.02, 23, 6), at(0.003, 0.002, 0.0005, 0.35), false});
  return list;
}

/// How many of many motions that the constraints allow, of those that a hand at `Y` may wish, FCL finds intersecting.
int entering(const HapticLoop& loop, const Scene& scene, const TickReport& tick, const Pose& Y, bool all_sides) {
  const Vec3& center = loop.center();
  const Pose& X = tick.proxy.X;
  const double radius = coupling_radius(scene.coupling, scene.scale);
  LowRankMatrix rows(4096);
  std::vector<double> bounds;
  for (const Contact& c : loop.constraints()) {
    if (c.age == kOneShotAge) continue;
    Vec6 row;
    row << c.n, c.r.cross(c.n) / radius;
    rows.push_row(row);
    bounds.push_back(-0.5 * c.gap);
  }
  const FclOracle oracle(scene);
  LeastDistanceSolver solver(4096);
  std::mt19937 rng(71);
  std::normal_distribution<double> g;
  const Displacement d = displacement(X, Y, center);
  Vec6 pen;
  pen << d.dp, radius * d.dr;
  int bad = 0;
  for (int i = 0; i < kMotions; ++i) {
    Vec6 wanted;
    for (int k = 0; k < 6; ++k) wanted[k] = g(rng);
    wanted.normalize();
    if (!all_sides) wanted = pen.normalized() + kTremor * wanted;
    const Vec6 z = solver.solve(rows, bounds.data(), kLength * wanted.normalized()).z;
    for (int k = 0; k < rows.rows(); ++k) REQUIRE(rows.row(k).dot(z) >= bounds[static_cast<std::size_t>(k)] - 1e-9);
    const Pose moved = displaced(X, center, {z.head<3>(), z.tail<3>() / radius});
    bad += oracle.intersecting(moved).empty() ? 0 : 1;
  }
  return bad;
}

}  // namespace

TEST_CASE("what holds a pressed part are contacts, on any kind of triangles", "[support]") {
  for (Case& c : cases()) {
    for (const char* resolver : {"qp", "lp"}) {
      Scene scene;
      scene.parts.push_back({"fixed", shared(c.fixed), Pose{}, false});
      scene.parts.push_back({"held", shared(c.held), c.start, true});
      scene.contact.tick_budget = INFINITY;
      scene.contact.l_min = 2e-5;
      scene.contact.resolver = resolver_kind(resolver);
      HapticLoop loop(scene);
      int silent = 0, most = 0;
      double worst_lag = 0;
      // Down by 1.5 mm, pressed for a while, then pushed aside by 3 mm, turning.
      for (int i = 0; i < 400; ++i) {
        Pose Y = c.start;
        Y.p.z() -= 0.002 * std::min(1.0, i / 60.0);
        const double aside = std::clamp((i - 150) / 200.0, 0.0, 1.0);
        Y.p += aside * Vec3(0.003, -0.001, 0);
        Y.q = Quat(Eigen::AngleAxisd(0.2 * aside, Vec3::UnitZ())) * Y.q;
        const TickReport& tick = loop.step(Y, 0.001);
        silent += i > 70 && tick.contacts == 0 ? 1 : 0;
        most = std::max(most, tick.constraints);
        if (tick.lag_reason != LagReason::contact) worst_lag = std::max(worst_lag, tick.lag);
        if (i != 140 && i != 399) continue;
        INFO(c.name << ", " << resolver << ", tick " << i);
        CHECK(tick.contacts >= 1);
        CHECK(tick.lag_reason == LagReason::contact);
        // What `lp` makes of a wish is not a projection, so that it need not have met what is in the way of one. After
        // the slide the contacts that the part slid onto are known as far as the pen has pressed on them.
        const bool all_sides = c.flat && i == 140;
        if (all_sides || scene.contact.resolver == ResolverKind::qp)
          CHECK(entering(loop, scene, tick, Y, all_sides) == 0);
      }
      std::printf(
          "support, %s, %s: %d contacts, at most %d constraints, %d ticks without a contact, worst unexplained %.3f "
          "mm\n",
          c.name, resolver, loop.report().contacts, most, silent, 1e3 * worst_lag);
      INFO(c.name << ", " << resolver);
      CHECK(silent == 0);
      CHECK(loop.report().unexplained_lag_ticks == 0);
    }
  }
}
