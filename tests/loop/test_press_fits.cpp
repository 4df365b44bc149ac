// A pin that starts in a sleeve without room is drawn out along its axis, however the rounding of the two meshes falls.
#include <cmath>
#include <limits>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "models/revolved.hpp"
#include "models/shapes.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kRadius = 0.005, kSleeve = 0.02, kPin = 0.03;  // m
constexpr double kStep = 3e-5;                                  // m, of the pen
// What a part may come deeper than it starts, and what rounding adds, m.
constexpr double kNoDeeperInSleeve = 2.2e-7;

/// The mesh turned by `R`, its coordinates rounded as in a file of floats.
std::shared_ptr<const TriangleMesh> in_file(TriangleMesh mesh, const Mat3& R) {
  for (Vec3& v : mesh.vertices) v = (R * v).cast<float>().cast<double>();
  return shared(mesh);
}

struct Fit {
  unsigned seed;
  int segments;
  double over;  ///< of the pin's radius, m
};

}  // namespace

TEST_CASE("a pin without room in its sleeve is drawn out of it", "[start]") {
  const Fit fit = GENERATE(Fit{0, 64, 0}, Fit{0, 63, 3e-6}, Fit{1, 64, 0}, Fit{2, 90, 4e-6}, Fit{3, 200, 2e-6});
  CAPTURE(fit.seed, fit.segments, fit.over);
  std::mt19937 rng(fit.seed);
  Quat turn = Quat::Identity();
  if (fit.seed > 0) turn = rotation(3 * random_vector(rng, 1).normalized());
  const Mat3 R = turn.toRotationMatrix();
  const Vec3 axis = R.col(2);
  Scene scene;
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  const double outside = 2 * kRadius, pin = kRadius + fit.over;
  const auto sleeve =
      shapes::revolved("sleeve", {{kRadius, 0}, {outside, 0}, {outside, kSleeve}, {kRadius, kSleeve}}, fit.segments);
  const auto solid = shapes::revolved("pin", {{0, 0}, {pin, 0}, {pin, kPin}, {0, kPin}}, fit.segments);
  scene.parts.push_back({"sleeve", in_file(sleeve, R), {}, false});
  scene.parts.push_back({"pin", in_file(solid, R), {Quat::Identity(), -0.005 * axis}, true});
  HapticLoop loop(scene);
  REQUIRE(loop.report().shrunk == 1);
  const Vec3 from = scene.parts.back().pose.p;
  constexpr int kTicks = 600;
  for (int i = 0; i <= kTicks + 100; ++i) {
    // As a hand draws it: slowly at first, and in steps of the pen.
    const double s = std::min(1.0, static_cast<double>(i) / kTicks), way = 0.04 * s * s * (3 - 2 * s);
    const Pose& X = loop.step({Quat::Identity(), from + kStep * std::round(way / kStep) * axis}, 1e-3).proxy.X;
    const Vec3 gone = X.p - from;
    const double along = gone.dot(axis);
    if (0.005 + kSleeve > along + 1e-3) REQUIRE((gone - along * axis).norm() < kNoDeeperInSleeve);
  }
  CHECK((loop.latest().p - from).dot(axis) > 0.04 - 2 * kStep);
  CHECK(loop.report().shrunk == 0);
  CHECK(loop.report().unexplained_lag_ticks == 0);
}
