#include "experiments/wrench_scenes.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "core/numbers.hpp"
#include "models/shapes.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kPlay = 1e-4;  // from the middle to either side, m
// Pushed farther than ρ² by the contact's distance from the center (ρ² = k_t / k; 37 mm for the sphere, 17 mm for the
// cone) a part on its tip or facet falls over, like a ball on a ball: the pushes below stay under that.

constexpr double kLMin = 4e-6;  // m: contacts keep half of it

Part part(const char* name, TriangleMesh mesh, const Pose& X, bool held) {
  return {name, std::make_shared<const TriangleMesh>(weld(mesh)), X, held};
}

Pose at(double x, double y, double z) {
  return {Quat::Identity(), Vec3(x, y, z)};
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

void append(const TriangleMesh& more, TriangleMesh& mesh) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({n + a, n + b, n + c});
}

/// Direction `i` of `n`, spread evenly over the sphere.
Vec3 direction(int i, int n) {
  const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z), a = i * kPi * (3 - std::sqrt(5.0));
  return {r * std::cos(a), r * std::sin(a), z};
}

WrenchScene ball_in_sphere(int probes) {
  WrenchScene w{"sphere in a spherical socket", "F = −k (d − c) u, T = 0", {}, {}};
  constexpr double kRadius = 0.01, kPush = 1.5e-3;
  TriangleMesh socket = shapes::sphere(4 * kRadius, 16, 8);  // a ball with a cavity
  append(inside_out(shapes::sphere(2 * (kRadius + kPlay), 192, 96)), socket);
  w.scene.parts.push_back(part("socket", socket, {}, false));
  w.scene.parts.push_back(part("sphere", shapes::sphere(2 * kRadius, 192, 96), {}, true));
  const double k = w.scene.coupling.stiffness;
  for (int i = 0; i < probes; ++i) {
    const Vec3 u = direction(i, probes);
    w.probes.push_back({{Quat::Identity(), kPush * u}, {-k * (kPush - kPlay) * u, Vec3::Zero()}});
  }
  return w;
}

WrenchScene ball_in_tube(int probes) {
  WrenchScene w{"sphere in a cylindrical socket", "F = −k (d − c) u across the axis, T = 0", {}, {}};
  constexpr double kRadius = 0.01, kPush = 1.5e-3;
  shapes::Block block;
  block.hole_diameter = 2 * (kRadius + kPlay);
  block.segments = 128;
  block.through = true;
  w.scene.parts.push_back(part("socket", shapes::block_with_hole(block), at(0, 0, 0.025), false));
  w.scene.parts.push_back(part("sphere", shapes::sphere(2 * kRadius, 192, 96), {}, true));
  const double k = w.scene.coupling.stiffness;
  for (int i = 0; i < probes; ++i) {
    const double a = 2.4 * i, along = 6e-3 * std::cos(1.7 * i);  // along the axis nothing holds it
    const Vec3 u(std::cos(a), std::sin(a), 0);
    w.probes.push_back({{Quat::Identity(), kPush * u + Vec3(0, 0, along)}, {-k * (kPush - kPlay) * u, Vec3::Zero()}});
  }
  return w;
}

/// A cone on its tip: center of mass at the origin, axis z.
TriangleMesh cone(double radius, double height, int segments) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, -0.75 * height});
  mesh.vertices.push_back({0, 0, 0.25 * height});
  for (int i = 0; i < segments; ++i)
    mesh.vertices.push_back(
        {radius * std::cos(2 * kPi * i / segments), radius * std::sin(2 * kPi * i / segments), 0.25 * height});
  for (int i = 0; i < segments; ++i) {
    const auto a = static_cast<std::uint32_t>(2 + i), b = static_cast<std::uint32_t>(2 + (i + 1) % segments);
    mesh.triangles.push_back({0, b, a});
    mesh.triangles.push_back({1, a, b});
  }
  return mesh;
}

WrenchScene cone_on_block(int probes) {
  WrenchScene w{"cone on a block", "tip on the plane: min (h cos θ − z)² + ρ² (θ − θ_Y)² over θ", {}, {}};
  constexpr double kRadius = 0.012, kHeight = 0.03, kTip = 0.75 * kHeight, kPush = 1.2e-3;
  w.scene.parts.push_back(part("block", shapes::box({0.06, 0.06, 0.02}, {6, 6, 2}), at(0, 0, -0.01), false));
  w.scene.parts.push_back(part("cone", cone(kRadius, kHeight, 128), at(0, 0, kTip + 1e-3), true));
  const CouplingSettings& c = w.scene.coupling;
  const double rho2 = c.torsional_stiffness / c.stiffness;
  for (int i = 0; i < probes; ++i) {
    const double tilt = 0.08 * i / std::max(1, probes - 1), a = 2.4 * i;
    const Vec3 axis(std::cos(a), std::sin(a), 0);
    const double z = kTip * std::cos(tilt) - kPush;
    // The part falls over a little as it is pushed down on its tip: Newton's method on the derivative.
    double theta = tilt;
    for (int n = 0; n < 50; ++n) {
      const double f = (kTip * std::cos(theta) - z) * (-kTip * std::sin(theta)) + rho2 * (theta - tilt);
      const double slope = kTip * kTip * std::sin(theta) * std::sin(theta) -
                           (kTip * std::cos(theta) - z) * kTip * std::cos(theta) + rho2;
      theta -= f / slope;
    }
    w.probes.push_back(
        {{rotation(tilt * axis), Vec3(0, 0, z)},
         {Vec3(0, 0, c.stiffness * (kTip * std::cos(theta) - z)), c.torsional_stiffness * (theta - tilt) * axis}});
  }
  return w;
}

/// A pin between two walls.
WrenchScene slot(const std::string& name, const std::string& formula, double length, double width) {
  WrenchScene w{name, formula, {}, {}};
  constexpr double kThick = 0.01, kLong = 0.06;
  const double y = width / 2 + kPlay + kThick / 2;
  const TriangleMesh wall = shapes::box({kLong, kThick, 0.04}, {6, 1, 4});
  w.scene.parts.push_back(part("left", wall, at(0, y, 0), false));
  w.scene.parts.push_back(part("right", wall, at(0, -y, 0), false));
  w.scene.parts.push_back(part("pin", shapes::box({length, width, 0.02}, {6, 2, 4}), {}, true));
  return w;
}

constexpr double kPinLength = 0.03, kPinWidth = 0.008;

WrenchScene pin_pushed(int probes) {
  WrenchScene w = slot("pin pushed in a slot", "F = −k (d − c) across the slot, T = 0", kPinLength, kPinWidth);
  const double k = w.scene.coupling.stiffness;
  for (int i = 0; i < probes; ++i) {
    const double side = i % 2 == 0 ? 1 : -1, push = side * (2e-3 + 3e-3 * i / probes);
    w.probes.push_back({at(3e-3 * std::cos(1.7 * i), push, 2e-3 * std::sin(1.7 * i)),
                        {Vec3(0, -k * (push - side * kPlay), 0), Vec3::Zero()}});
  }
  return w;
}

/// The turn at which the corners of a box of `length` and `width` meet walls `width` + 2 kPlay apart.
double free_turn(double length, double width) {
  double t = 0;  // length sin t + width cos t = width + 2 kPlay, by Newton's method
  for (int n = 0; n < 50; ++n)
    t -=
        (length * std::sin(t) + width * std::cos(t) - width - 2 * kPlay) / (length * std::cos(t) - width * std::sin(t));
  return t;
}

void turn(WrenchScene& w, double free, int probes) {
  const double k = w.scene.coupling.torsional_stiffness;
  for (int i = 0; i < probes; ++i) {
    const double side = i % 2 == 0 ? 1 : -1, angle = side * (0.1 + 0.3 * i / probes);
    w.probes.push_back(
        {{rotation({0, 0, angle}), Vec3::Zero()}, {Vec3::Zero(), Vec3(0, 0, -k * (angle - side * free))}});
  }
}

WrenchScene pin_turned(int probes) {
  WrenchScene w =
      slot("pin turned in a slot", "T = −k_t (φ − φ*), L sin φ* + b cos φ* = w, F = 0", kPinLength, kPinWidth);
  turn(w, free_turn(kPinLength, kPinWidth), probes);
  return w;
}

WrenchScene shaft_turned(int probes) {
  constexpr double kSide = 0.02, kThick = 0.01;
  WrenchScene w =
      slot("square shaft turned in a square socket", "T = −k_t (φ − φ*), s (sin φ* + cos φ*) = w, F = 0", kSide, kSide);
  const double x = kSide / 2 + kPlay + kThick / 2;
  // Shorter than the two others are apart, so that the four do not meet.
  const TriangleMesh wall = shapes::box({kThick, kSide + 2 * kPlay - 1e-5, 0.04}, {1, 2, 4});
  w.scene.parts.push_back(part("front", wall, at(x, 0, 0), false));
  w.scene.parts.push_back(part("back", wall, at(-x, 0, 0), false));
  turn(w, free_turn(kSide, kSide), probes);
  return w;
}

}  // namespace

std::vector<WrenchScene> wrench_scenes(int probes) {
  std::vector<WrenchScene> all;
  for (const auto make : {ball_in_sphere, ball_in_tube, cone_on_block, pin_pushed, pin_turned, shaft_turned}) {
    all.push_back(make(probes));
    all.back().scene.contact.l_min = kLMin;
  }
  return all;
}

}  // namespace tegotae::experiments
