// Fits down to 10 um of diametral clearance, with a hand that gets stuck, straightens and wiggles.
#include <cstdio>

#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "loop/ladder_pen.hpp"
#include "peg_in_hole/peg_scene.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kHalfLength = 0.025, kDepth = 0.04;  // m, of the peg and of the hole

struct Insertion {
  double depth = 0;     ///< of the tip at the end, m
  double back = 0;      ///< longest way that the peg went away from the pen in a tick, m
  int penetrating = 0;  ///< of every 20th pose
};

/// Distance between part and pen, over both position and rotation.
double apart(const Pose& X, const Pose& Y, const Vec3& center) {
  const Displacement d = displacement(X, Y, center);
  return d.dp.norm() + kHalfLength * d.dr.norm();
}

Insertion insert(const SceneFile& file, const LadderStart& start) {
  const StylusScript script = ladder_script(start, kHalfLength, kDepth);
  Scene scene = file.scene;
  scene.contact.tick_budget = INFINITY;
  for (Part& p : scene.parts)
    if (p.held) p.pose = script.pose(0);
  HapticLoop loop(scene);
  const FclOracle oracle(scene);
  SimulatedDevice pen(file.device, script, loop.center());
  pen.start();
  Insertion out;
  int pieces = 0;
  for (int tick = 0; tick < 8000; ++tick) {
    const DeviceState state = pen.read();
    const double before = apart(loop.report().proxy.X, state.pose, loop.center());
    const TickReport& r = loop.step(state.pose, 1e-3);
    out.back = std::max(out.back, apart(r.proxy.X, state.pose, loop.center()) - before);
    for (const Pose& X : r.substeps)
      if (++pieces % 20 == 0) out.penetrating += oracle.intersecting(X).empty() ? 0 : 1;
    pen.write(coupling_wrench(scene.coupling, r.proxy, state.pose, state.velocity, loop.center()));
    pen.advance(1e-3);
  }
  out.depth = -(loop.report().proxy.X * Vec3(0, 0, -kHalfLength)).z();
  return out;
}

void check(double ratio, const std::vector<LadderStart>& starts) {
  const SceneFile file = apps::make_peg_scene(ratio);
  for (const LadderStart& start : starts) {
    CAPTURE(ratio, start.tilt, start.offset, start.seed);
    const Insertion in = insert(file, start);
    CHECK(in.depth == Approx(kDepth).margin(3e-5));
    CHECK(in.penetrating == 0);
    CHECK(in.back < 1e-3);
  }
}

double least_distance_from_axis(const Vec3& a, const Vec3& b) {
  const Eigen::Vector2d p = a.head<2>(), d = b.head<2>() - p;
  const double t = d.squaredNorm() > 0 ? std::clamp(-p.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p + t * d).norm();
}

}  // namespace

TEST_CASE("starts that once ended at the rim or threw the peg back go in", "[ladder]") {
  check(0.9995, {{3.5 * M_PI / 180, 1e-3, 1}, {5 * M_PI / 180, 0, 2}, {2 * M_PI / 180, 0, 1}});
}

TEST_CASE("every rung goes in from tilted and off center starts", "[.][ladder_long]") {
  for (const double ratio : {0.91, 0.94, 0.987, 0.99, 0.995, 0.999, 0.9995}) {
    std::vector<LadderStart> starts;
    for (const double tilt : {0.0, 1.0, 3.0, 5.0})
      for (const double offset : {0.0, 1e-3})
        for (const unsigned seed : {11u, 12u}) starts.push_back({tilt * M_PI / 180, offset, seed});
    check(ratio, starts);
  }
}

TEST_CASE("facets leave the clearance of the round parts, however the peg is turned", "[ladder]") {
  for (const double ratio : {0.99, 0.999, 0.9995}) {
    CAPTURE(ratio);
    const SceneFile file = apps::make_peg_scene(ratio);
    const double hole_radius = 0.01, peg_radius = ratio * hole_radius;
    double peg = 0, wall = INFINITY, widest = 0;
    for (const Part& part : file.scene.parts) {
      for (const auto& t : part.mesh->triangles)
        for (int k = 0; k < 3; ++k) {
          const Vec3 &a = part.mesh->vertices[t[k]], &b = part.mesh->vertices[t[(k + 1) % 3]];
          if (part.held) {
            peg = std::max(peg, a.head<2>().norm());
          } else if (std::max(a.z(), b.z()) < -1.5e-3 && std::min(a.z(), b.z()) > -0.0399 &&
                     a.head<2>().norm() < 0.015) {
            wall = std::min(wall, least_distance_from_axis(a, b));
            widest = std::max(widest, a.head<2>().norm());
          }
        }
    }
    // Corners of the peg on its circle, facets of the hole on its own: files are read in single precision, 1 nm here.
    CHECK(peg == Approx(peg_radius).margin(2e-9));
    CHECK(wall == Approx(hole_radius).margin(2e-9));
    CHECK(wall - peg == Approx((1 - ratio) * hole_radius).margin(4e-9));
    // What the facets add, at a corner over a facet, is less than the clearance itself.
    CHECK(widest - wall < (1 - ratio) * hole_radius);
  }
}
