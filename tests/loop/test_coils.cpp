// Two coils that a hand pushes into each other, turns and pulls: round edges on all sides, which curve away under
// every step, and a pen far from the part.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kCoilRadius = 0.02, kWire = 0.002, kPitch = 0.01;
constexpr int kTurns = 4, kLength = kTurns * 60;

/// A closed helical tube around z, its wire with `sides` sides.
TriangleMesh coil(int sides) {
  TriangleMesh mesh;
  for (int i = 0; i < kLength; ++i) {
    const double turn = 2 * M_PI * kTurns * i / (kLength - 1);
    for (int k = 0; k < sides; ++k) {
      const double a = 2 * M_PI * k / sides, r = kCoilRadius + kWire * std::cos(a);
      mesh.vertices.emplace_back(r * std::cos(turn), r * std::sin(turn),
                                 kPitch * (turn / (2 * M_PI) - 0.5 * kTurns) + kWire * std::sin(a));
    }
  }
  const auto at = [&](int ring, int k) { return static_cast<std::uint32_t>(ring * sides + k % sides); };
  for (int i = 0; i + 1 < kLength; ++i)
    for (int k = 0; k < sides; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
      mesh.triangles.push_back({at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)});
    }
  for (int k = 1; k + 1 < sides; ++k) {
    mesh.triangles.push_back({at(0, 0), at(0, k), at(0, k + 1)});
    mesh.triangles.push_back({at(kLength - 1, 0), at(kLength - 1, k + 1), at(kLength - 1, k)});
  }
  return mesh;
}

struct Knot {
  double t;
  Vec3 p, r;
};

/// Down on the coil, into it by 4 mm, aside, a jab, back, and out again.
std::vector<Knot> pulling_hand(std::mt19937& rng, double height) {
  Vec3 aside = random_vector(rng, 0.004);
  aside.z() = 0;
  const auto turn = [&](double most) { return random_vector(rng, most); };
  std::vector<Knot> way = {{0, {0, 0, height}, Vec3::Zero()}};
  const auto add = [&](double dt, const Vec3& p, const Vec3& r) { way.push_back({way.back().t + dt, p, r}); };
  add(0.7, 0.3 * aside, turn(0.1));
  add(0.3, 0.3 * aside + Vec3(0, 0, -0.004), turn(0.3));
  add(0.4, aside + Vec3(0, 0, -0.002), turn(0.5));
  add(0.05, aside + Vec3(0, 0, 0.002), turn(0.5));
  add(0.05, aside + Vec3(0, 0, -0.002), turn(0.5));
  add(0.3, -aside + Vec3(0, 0, -0.001), turn(0.8));
  add(0.3, {0, 0, height}, Vec3::Zero());
  add(0.5, {0, 0, height}, Vec3::Zero());
  return way;
}

Pose on_way(const std::vector<Knot>& way, double t) {
  std::size_t i = 1;
  while (i + 1 < way.size() && way[i].t < t) ++i;
  const Knot &a = way[i - 1], &b = way[i];
  const double s = std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0), w = s * s * (3 - 2 * s);
  return {rotation(a.r + w * (b.r - a.r)), a.p + w * (b.p - a.p)};
}

/// Counts ticks in which the part comes back most of the way that it made in the tick before.
class SwingCounter {
 public:
  void add(const Pose& X) {
    const Vec3 made = X.p - last_.p;
    if (first_) {
      first_ = false;
    } else {
      count_ += std::min(made.norm(), made_.norm()) > kLeast && made.dot(made_) < -0.5 * made.norm() * made_.norm();
    }
    made_ = made;
    last_ = X;
  }
  int count() const { return count_; }

 private:
  static constexpr double kLeast = 3e-5;  // m
  bool first_ = true;
  Pose last_;
  Vec3 made_ = Vec3::Zero();
  int count_ = 0;
};

}  // namespace

TEST_CASE("coils that are pressed into each other hold by contacts, and do not swing to and fro", "[lag][coils]") {
  constexpr double kHeight = 0.075;
  Scene scene;
  scene.parts.push_back({"coil", shared(coil(10)), Pose(), false});
  scene.parts.push_back({"held", shared(coil(9)), {Quat::Identity(), {0, 0, kHeight}}, true});
  scene.contact.tick_budget = INFINITY;
  int touching = 0, swings = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    std::mt19937 rng(seed);
    const std::vector<Knot> way = pulling_hand(rng, kHeight);
    HapticLoop loop(scene);
    SwingCounter counter;
    for (double t = 0; t < way.back().t; t += 1e-3) {
      const TickReport& tick = loop.step(on_way(way, t), 1e-3);
      touching += tick.contacts > 0;
      counter.add(tick.proxy.X);
    }
    CHECK(loop.report().unexplained_lag_ticks == 0);
    swings += counter.count();
  }
  CHECK(touching > 40 * 1000);
  CHECK(swings < touching / 40);
  std::printf("coils: %d swings in %d ticks\n", swings, touching);
}
