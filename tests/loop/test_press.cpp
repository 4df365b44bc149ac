// A hand that presses a part into corners and grooves and then holds still: part and force come to rest, with the force
// that springs in series give, however hard the hand pushes. Judged by geometry alone.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bodies.hpp"
#include "catch.hpp"
#include "loop/pen_run.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

// What contacts keep is at most this (m); the encoders' steps and the pen's friction make the force uncertain.
constexpr double kMaxGap = 2e-5;
constexpr double kArrives = 0.3, kSettles = 0.2, kStays = 0.7;  // s

/// k of coupling and grip, one behind the other, N/m.
double in_series() {
  return 1 / (1 / CouplingSettings{}.stiffness + 1 / HandSettings{}.stiffness);
}

/// By how much the force may be off for what the pen's readings and its dry friction hide, N.
double uncertain() {
  const SimulatedDeviceSettings pen;
  return in_series() * (pen.position_resolution + pen.friction / pen.hand.stiffness);
}

struct Rest {
  Pose X;             ///< at its end
  Wrench wrench;      ///< at its end
  double moved = 0;   ///< m, of the part's center in the last quarter
  double turned = 0;  ///< rad, the same
  double step = 0;    ///< N, the largest change of a coordinate of the force from one tick to the next
};

/// Presses to one pose after the other and rests at each.
std::vector<Rest> press(const Scene& scene, const std::vector<Pose>& poses) {
  std::vector<StylusScript::Key> keys = {{0, scene.parts.back().pose}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double t = static_cast<double>(i) * (kArrives + kStays) + kArrives;
    keys.push_back({t, poses[i]});
    keys.push_back({t + kStays, poses[i]});
  }
  PenRun hand(scene, StylusScript(keys));
  const auto ticks = [](double s) { return static_cast<int>(std::lround(1000 * s)); };
  std::vector<Rest> rests;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Rest rest;
    Pose from;
    Vec3 before = Vec3::Zero();
    for (int tick = 0; tick < ticks(kArrives + kStays); ++tick) {
      const PenSample pen = hand.tick();
      const Pose& X = hand.loop.latest();
      if (tick > ticks(kArrives + kSettles))
        rest.step = std::max(rest.step, (pen.wrench.force - before).cwiseAbs().maxCoeff());
      before = pen.wrench.force;
      if (tick == ticks(kArrives + 0.75 * kStays)) from = X;
      if (tick <= ticks(kArrives + 0.75 * kStays)) continue;
      const Displacement way = displacement(from, X, hand.loop.center());
      rest.moved = std::max(rest.moved, way.dp.norm());
      rest.turned = std::max(rest.turned, way.dr.norm());
      rest.X = X;
      rest.wrench = pen.wrench;
    }
    rests.push_back(rest);
  }
  return rests;
}

/// Still, and in steps of no more than the spring gives for two of the pen's.
void check_rest(const Rest& rest) {
  CHECK(rest.moved < 2e-6);
  CHECK(rest.turned < 2e-4);
  CHECK(rest.step < 2 * CouplingSettings{}.stiffness * SimulatedDeviceSettings{}.position_resolution);
}

Scene corner(const Quat& q, bool boards, const Vec3& size) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.max_torsional_stiffness = kMaxTorsional;
  const double w = 0.08, t = 0.01;
  if (boards) {
    for (int k = 0; k < 3; ++k) {
      Vec3 extent = Vec3::Constant(w), middle = Vec3::Constant(0.5 * w - t);
      extent[k] = t;
      middle[k] = -0.5 * t;
      scene.parts.push_back({"wall" + std::to_string(k), shared(box(extent)), {q, q * middle}});
    }
  } else {
    TriangleMesh shell;
    shell.vertices = {{0, 0, 0}, {w, 0, 0}, {w, w, 0}, {0, w, 0}, {0, 0, w}, {w, 0, w}, {0, w, w}};
    shell.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 4, 5}, {0, 5, 1}, {0, 3, 6}, {0, 6, 4}};
    scene.parts.push_back({"shell", shared(shell), {q, Vec3::Zero()}});
  }
  scene.parts.push_back({"block", shared(box(size)), {q, q * Vec3(0.5 * size + Vec3(0.002, 0.003, 0.004))}, true});
  return scene;
}

}  // namespace

TEST_CASE("a block pressed into three walls rests, with the force of the springs in series", "[law][press]") {
  const bool boards = GENERATE(true, false);
  const unsigned seed = GENERATE(1u, 2u, 3u);
  CAPTURE(boards, seed);
  std::mt19937 rng(seed);
  const Quat q = rotation(3 * random_direction(rng));
  const Vec3 size(0.016, 0.022, 0.03), way(0.9 + 0.1 * seed, 0.7, 0.4);
  const Scene scene = corner(q, boards, size);
  // 0.3 to 1.3 N, which the motors sustain as long as it lasts, and far more.
  const std::vector<double> deep = {1e-3, 4e-3, 16e-3};
  std::vector<Pose> poses;
  for (double d : deep) poses.push_back({q, q * Vec3(0.5 * size - d * way)});
  const std::vector<Rest> rests = press(scene, poses);
  for (std::size_t i = 0; i < rests.size(); ++i) {
    CAPTURE(deep[i]);
    check_rest(rests[i]);
    const Vec3 at = q.conjugate() * rests[i].X.p - 0.5 * size, force = q.conjugate() * rests[i].wrench.force;
    CHECK(at.minCoeff() > 0);
    CHECK(at.maxCoeff() < kMaxGap);
    // Where nothing turns, nothing is felt to turn.
    CHECK(rests[i].wrench.torque.norm() < 1e-4 * size.norm());
    if (i == 2) continue;
    CAPTURE(force.transpose());
    CHECK((force - in_series() * deep[i] * way).cwiseAbs().maxCoeff() < std::sqrt(3) * uncertain());
  }
}

TEST_CASE("a block turned into three walls rests, and is pushed by them alone", "[law][press]") {
  const bool boards = GENERATE(true, false);
  const unsigned seed = GENERATE(4u, 5u, 6u);
  CAPTURE(boards, seed);
  std::mt19937 rng(seed);
  const Quat q = rotation(3 * random_direction(rng)), turn = rotation(q * Vec3(0.3 * random_direction(rng)));
  const Vec3 size(0.022, 0.018, 0.02);
  std::vector<Pose> poses;
  for (double d : {2e-3, 6e-3, 16e-3}) poses.push_back({turn * q, q * Vec3(0.5 * size - d * Vec3(0.8, 0.6, 0.7))});
  for (const Rest& rest : press(corner(q, boards, size), poses)) {
    check_rest(rest);
    // Walls push out, and at corners of the block: never farther from its center than those.
    const Vec3 force = q.conjugate() * rest.wrench.force;
    CAPTURE(force.transpose());
    CHECK(force.minCoeff() > 0);
    CHECK(rest.wrench.torque.norm() < force.sum() * 0.5 * size.norm());
  }
}

TEST_CASE("a round bar pressed into a groove rests in its middle", "[law][press]") {
  const double half = GENERATE(15.0, 40.0) * M_PI / 180;  // of the groove's angle, rad
  const double r = 0.006, length = 0.02;
  CAPTURE(half);
  const int facets = 48;
  std::vector<Vec3> rim;
  for (int i = 0; i < facets; ++i)
    for (double y : {-0.5 * length, 0.5 * length})
      rim.push_back({r * std::cos(2 * M_PI * i / facets), y, r * std::sin(2 * M_PI * i / facets)});
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.max_torsional_stiffness = kMaxTorsional;
  for (double side : {-1.0, 1.0}) {
    // A board whose face goes up from the origin at the angle `half` from the vertical.
    const Quat q = rotation(Vec3(0, side * (M_PI / 2 - half) * -1, 0));
    scene.parts.push_back(
        {side < 0 ? "left" : "right", shared(box({0.06, 0.06, 0.01})), {q, q * Vec3(side * 0.03, 0, -0.005)}});
  }
  // The bar's facets lie between these two heights on the walls.
  const double high = r / std::sin(half), low = high * std::cos(M_PI / facets);
  scene.parts.push_back({"bar", shared(convex_hull(rim)), {Quat::Identity(), {1e-4, 0, high + 2e-3}}, true});
  const std::vector<double> deep = {1e-3, 4e-3, 16e-3};
  std::vector<Pose> poses;
  for (double d : deep) poses.push_back({Quat::Identity(), {2e-4, 0, high - d}});
  const std::vector<Rest> rests = press(scene, poses);
  for (std::size_t i = 0; i < rests.size(); ++i) {
    CAPTURE(deep[i], rests[i].X.p.transpose(), rests[i].wrench.force.transpose());
    check_rest(rests[i]);
    CHECK(rests[i].X.p.z() > low);
    CHECK(rests[i].X.p.z() < high + kMaxGap / std::sin(half));
    CHECK(std::abs(rests[i].X.p.x()) < (high - low + kMaxGap / std::sin(half)) / std::tan(half));
    if (i == 2) continue;
    CHECK(rests[i].wrench.force.z() == Approx(in_series() * (rests[i].X.p.z() - high + deep[i])).margin(uncertain()));
  }
}
