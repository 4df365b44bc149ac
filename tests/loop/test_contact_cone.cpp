// Few contacts must support like many: every motion that the contacts of a tick allow must be one that all near
// features allow, found by asking all triangle pairs.
#include <cstdio>

#include "bodies.hpp"
#include "catch.hpp"
#include "feature/simplex_distance.hpp"
#include "loop/contact_loop.hpp"
#include "lp/least_distance.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr int kTwists = 500;
// Rows of the brute force are taken up to this much (m) above the gap that contacts are counted to.
constexpr double kBand = 1e-7;

/// The unit rows of all near features of two meshes at `X` (both in the world), face–vertex and edge–edge.
std::vector<Vec6> near_rows(const TriangleMesh& a, const Pose& X, const TriangleMesh& b, const Vec3& center,
                            double radius, double within) {
  std::vector<Vec6> rows;
  for (const auto& ta : a.triangles) {
    const Simplex sa{3, {X * a.vertices[ta[0]], X * a.vertices[ta[1]], X * a.vertices[ta[2]]}};
    for (const auto& tb : b.triangles) {
      const Simplex sb{3, {b.vertices[tb[0]], b.vertices[tb[1]], b.vertices[tb[2]]}};
      const ClosestPoints c = closest_points(sa, sb);
      const bool face = c.mask_a == 7 || c.mask_b == 7;
      if (!face || c.squared_distance > within * within || c.squared_distance == 0) continue;
      const Vec3 n = (c.a - c.b).normalized(), r = c.a - X * center;
      Vec6 row;
      row << n, r.cross(n) / radius;
      rows.push_back(row.normalized());
    }
  }
  return rows;
}

/// Presses the held part of `scene` (the last part) with the pens of `pen` and compares cones at the end.
template <typename Pen>
void compare(const char* name, Scene scene, int ticks, Pen pen) {
  scene.contact.tick_budget = INFINITY;
  scene.contact.l_min = 2e-5;
  scene.contact.l_0 = 2e-4;
  const TriangleMesh& held = *scene.parts.back().mesh;
  const MassProperties mass = mass_properties(held, report(held).closed);
  ContactLoop loop(scene, scene.contact, mass);
  TickReport tick;
  for (int i = 0; i < ticks; ++i) loop.step(pen(i), 0.001, kNoDeadline, tick);
  const double radius = radius_about(held, mass.center);
  LowRankMatrix contacts(1024);
  std::vector<double> zero;
  double farthest = 0;
  for (const Contact& c : loop.constraints()) {
    if (c.gap > *scene.contact.l_min) continue;
    Vec6 row;
    row << c.n, c.r.cross(c.n) / radius;
    contacts.push_row(row.normalized());
    zero.push_back(0);
    farthest = std::max(farthest, c.gap);
  }
  const auto rows = near_rows(held, loop.pose(), *scene.parts.front().mesh, mass.center, radius, farthest + kBand);
  REQUIRE(rows.size() > zero.size());
  std::mt19937 rng(71);
  std::normal_distribution<double> g;
  LeastDistanceSolver solver(1024);
  double worst = 0;
  for (int i = 0; i < kTwists; ++i) {
    Vec6 z0;
    for (int k = 0; k < 6; ++k) z0[k] = g(rng);
    const Vec6 z = solver.solve(contacts, zero.data(), z0.normalized()).z;
    for (const Vec6& row : rows) worst = std::min(worst, row.dot(z));
  }
  std::printf("cone, %s: %zu contacts for %zu near face pairs; a motion they allow enters another by at most %.2g\n",
              name, zero.size(), rows.size(), -worst);
  // A unit motion that the contacts allow goes into no other near feature by more than this share of itself.
  CHECK(worst > -0.1);
}

}  // namespace

TEST_CASE("a finely divided box on a finely divided floor is held by contacts that span the cone of all", "[cone]") {
  Scene scene;
  scene.parts.push_back(
      {"floor", shared(shapes::moved(shapes::box({0.1, 0.1, 0.02}, {20, 20, 1}), {0, 0, -0.01})), Pose{}, false});
  scene.parts.push_back(
      {"box", shared(shapes::box({0.04, 0.03, 0.02}, {8, 6, 4})), {Quat::Identity(), {0, 0, 0.012}}, true});
  compare("box on floor", scene, 600, [](int i) {
    // Pressed 2 mm under the floor, leaning to all sides, then upright.
    const double lean = i < 400 ? 0.15 : 0, turn = 2 * M_PI * i / 100;
    return Pose{rotation({lean * std::cos(turn), lean * std::sin(turn), 0}),
                {0.001, 0.002, 0.012 - 1e-4 * std::min(i, 40)}};
  });
}

TEST_CASE("a tilted peg in its hole is held on both sides along its length", "[cone]") {
  Scene scene;
  shapes::Peg peg;
  peg.diameter = 0.0198;
  peg.segments = 32;
  peg.rings = 6;
  shapes::Block block;
  block.segments = 32;
  block.rings = 6;
  scene.parts.push_back({"hole", shared(shapes::block_with_hole(block)), Pose{}, false});
  scene.parts.push_back({"peg", shared(shapes::peg(peg)), {Quat::Identity(), {0, 0, 0.03}}, true});
  compare("peg in hole", scene, 900, [](int i) {
    // To half depth, then wrenched round and held to one side.
    const double lean = 0.05 * std::clamp((i - 400) / 100.0, 0.0, 1.0), turn = i < 800 ? 2 * M_PI * i / 100 : 0;
    return Pose{rotation({lean * std::cos(turn), lean * std::sin(turn), 0}), {0, 0, 0.03 - 1e-4 * std::min(i, 400)}};
  });
}
