#include "experiments/friction_scenes.hpp"

#include <cmath>
#include <memory>

#include "models/shapes.hpp"

namespace tegotae::experiments {
namespace {

constexpr int kFacets = 64;     // around pegs and holes
constexpr double kHair = 2e-5;  // m above what it will lie on

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

std::string text(const char* name, double mu) {
  char out[96];
  std::snprintf(out, sizeof out, "%.64s, mu %.2g", name, mu);
  return out;
}

/// A bar along y whose cross section is a symmetric trapezoid: half widths at its bottom and top.
TriangleMesh trapezoid_bar(double bottom, double top, double height, double length) {
  TriangleMesh m;
  for (const double y : {-0.5 * length, 0.5 * length})
    for (const double z : {0.0, height})
      for (const double side : {-1.0, 1.0}) m.vertices.push_back({side * (z == 0 ? bottom : top), y, z});
  // Corners as of a box: x first, then z, then y.
  m.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {5, 6, 7}, {0, 4, 1}, {1, 4, 5},
                 {2, 3, 6}, {3, 7, 6}, {0, 2, 4}, {2, 6, 4}, {1, 5, 3}, {3, 5, 7}};
  return m;
}

/// A square tube about z.
TriangleMesh square_tube(double inner, double outer, double length) {
  TriangleMesh m;
  for (const double z : {-0.5 * length, 0.5 * length})
    for (const double half : {inner, outer})
      for (int i = 0; i < 4; ++i)
        m.vertices.push_back({half * (i == 0 || i == 3 ? 1 : -1), half * (i < 2 ? 1 : -1), z});
  const auto quad = [&m](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    m.triangles.push_back({a, b, c});
    m.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4, in = i, jn = j, out = 4 + i, jout = 4 + j;
    quad(out, jout, jout + 8, out + 8);
    quad(jn, in, in + 8, jn + 8);
    quad(in, jn, jout, out);
    quad(out + 8, jout + 8, jn + 8, in + 8);
  }
  return m;
}

Threshold incline(const char* name, const char* formula, const Vec3& half, double mu, double expected) {
  return {text(name, mu),
          formula,
          expected,
          block_on_floor(half, mu),
          [](double tangent) {
            const double angle = std::atan(tangent);
            return Wrench{Vec3(1.5 * std::sin(angle), 0, -1.5 * std::cos(angle)), Vec3::Zero()};
          },
          0.5 * expected,
          1.5 * expected};
}

Threshold groove(double half_angle, double mu) {
  constexpr double kBottom = 0.005, kHeight = 0.02, kLength = 0.04, kWeight = 1;
  Scene scene;
  scene.friction.mu = mu;
  const double t = std::tan(half_angle);
  for (const double side : {-1.0, 1.0}) {
    // A plate whose upper face holds one side of the groove.
    const Vec3 n(-side * std::cos(half_angle), 0, std::sin(half_angle));
    const Vec3 on_face(side * (kBottom + 0.5 * kHeight) * t, 0, 0.5 * kHeight);
    const Quat q = Quat::FromTwoVectors(Vec3::UnitZ(), n);
    scene.parts.push_back(
        {side < 0 ? "left" : "right", shared(shapes::box({0.08, 0.08, 0.01})), {q, on_face - 0.005 * n}, false});
  }
  scene.parts.push_back({"bar",
                         shared(trapezoid_bar(kBottom * t, (kBottom + kHeight) * t, kHeight, kLength)),
                         {Quat::Identity(), {0, 0, 5 * kHair}},
                         true});
  const double expected = mu * kWeight / std::sin(half_angle);
  char name[64];
  std::snprintf(name, sizeof name, "V-groove of %.0f deg", 180 / M_PI * half_angle);
  return {text(name, mu),
          "F = mu W / sin a",
          expected,
          scene,
          [](double pull) {
            return Wrench{Vec3(0, pull, -kWeight), Vec3::Zero()};
          },
          0.5 * expected,
          1.5 * expected};
}

Threshold collar(double mu) {
  constexpr double kLength = 0.03, kHalf = 0.01, kPlay = 1e-5, kPush = 0.2;
  Scene scene;
  scene.friction.mu = mu;
  scene.parts.push_back({"post", shared(shapes::box({2 * kHalf, 2 * kHalf, 0.2})), Pose(), false});
  scene.parts.push_back({"collar", shared(square_tube(kHalf + kPlay, 0.018, kLength)), Pose(), true});
  const double expected = kLength / (2 * mu);
  // Down beside the axis; it is held from the expected arm on, so that the arm goes down.
  return {text("collar on a post", mu),
          "x = L / 2 mu",
          expected,
          scene,
          [](double arm) {
            return Wrench{Vec3(0, 0, -kPush), Vec3(0, kPush * arm, 0)};
          },
          1.5 * expected,
          0.5 * expected};
}

Threshold spin(double mu) {
  constexpr double kPush = 2;
  const Vec3 half(0.02, 0.02, 0.01);
  const double expected = mu * kPush * half.head<2>().norm();
  return {text("spin on four corners", mu),
          "T = mu N r",
          expected,
          block_on_floor(half, mu),
          [](double torque) {
            return Wrench{Vec3(0, 0, -kPush), Vec3(0, 0, torque)};
          },
          0.5 * expected,
          1.5 * expected};
}

}  // namespace

Scene block_on_floor(const Vec3& half, double mu) {
  Scene scene;
  scene.friction.mu = mu;
  scene.parts.push_back({"floor", shared(shapes::box({0.4, 0.4, 0.02})), {Quat::Identity(), {0, 0, -0.01}}, false});
  scene.parts.push_back({"block", shared(shapes::box(2 * half)), {Quat::Identity(), {0, 0, half.z() + kHair}}, true});
  return scene;
}

Scene plate_in_slot(double play, double mu) {
  Scene scene;
  scene.friction.mu = mu;
  const double z = 0.01 + 0.5 * play;
  for (const double side : {-1.0, 1.0})
    scene.parts.push_back({side < 0 ? "under" : "over",
                           shared(shapes::box({0.2, 0.1, 0.01})),
                           {Quat::Identity(), {0, 0, side * z}},
                           false});
  scene.parts.push_back({"plate", shared(shapes::box({0.04, 0.04, 0.01})), Pose(), true});
  return scene;
}

Scene peg_in_hole(double depth, double play, double mu) {
  shapes::Block block;
  block.hole_diameter = 2 * kPegRadius;
  block.chamfer = 0;
  block.segments = kFacets;
  shapes::Peg peg;
  peg.diameter = 2 * (kPegRadius - play);
  peg.length = kPegLength;
  peg.chamfer = 0;
  peg.segments = kFacets;
  Scene scene;
  scene.friction.mu = mu;
  scene.contact.l_min = 4e-6;  // contacts keep half of it
  // A facet's middle, not a corner, lies across from the peg's corner at +x, so that the play there is what is asked
  // for.
  const Quat turned = rotation({0, 0, M_PI / block.segments});
  scene.parts.push_back({"hole", shared(shapes::block_with_hole(block)), {turned, Vec3::Zero()}, false});
  scene.parts.push_back({"peg", shared(shapes::peg(peg)), {Quat::Identity(), {0, 0, 0.5 * kPegLength - depth}}, true});
  return scene;
}

std::vector<Threshold> thresholds(bool quick) {
  std::vector<Threshold> out;
  const std::vector<double> all = quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.2, 0.3, 0.5, 0.8};
  for (const double mu : all) out.push_back(incline("incline, slides", "tan b = mu", {0.02, 0.02, 0.01}, mu, mu));
  out.push_back(incline("incline, tips", "tan b = b / h", {0.01, 0.01, 0.04}, 0.8, 0.25));
  for (const double angle : quick ? std::vector<double>{45} : std::vector<double>{20, 45, 60})
    for (const double mu : quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3})
      out.push_back(groove(M_PI / 180 * angle, mu));
  for (const double mu : quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.6})
    out.push_back(collar(mu));
  for (const double mu : all) out.push_back(spin(mu));
  return out;
}

}  // namespace tegotae::experiments
