// Parts that stand on points: what a screw's flank, a taper or a corner does there is that of its tangent plane.
#include "experiments/friction_tips.hpp"

#include <cmath>
#include <memory>

#include "experiments/load_rig.hpp"
#include "models/shapes.hpp"

namespace tegotae::experiments {
namespace {

constexpr double kTipHair = 5e-6;  // m of the tips above their plates
constexpr double kLoad = 1;        // N
constexpr double kFlankAngle = M_PI / 6;
// Torques begin with none, so that the tips come down where their plates are tangent, and end at so many times what is
// expected.
constexpr double kMaxShare = 1.1;

/// Adds a square pyramid of 4 mm that stands on its tip.
void add_tip(const Vec3& tip, const Vec3& n, TriangleMesh& m) {
  constexpr double kHeight = 0.004, kHalf = 0.001;
  const Vec3 a = n.unitOrthogonal(), b = n.cross(a);
  const auto first = static_cast<std::uint32_t>(m.vertices.size());
  m.vertices.push_back(tip);
  for (const auto& [s, t] : {std::pair(1, 1), {-1, 1}, {-1, -1}, {1, -1}})
    m.vertices.push_back(tip + kHeight * n + kHalf * (s * a + t * b));
  for (std::uint32_t i = 0; i < 4; ++i) m.triangles.push_back({first, first + 1 + (i + 1) % 4, first + 1 + i});
  m.triangles.push_back({first + 1, first + 2, first + 3});
  m.triangles.push_back({first + 1, first + 3, first + 4});
}

/// Tips around the axis z at `radius`, each on a plate whose normal leans by tan `lean` to the axis and by tan `rise`
/// against the way round.
Scene standing(int tips, double radius, double lean, double rise, double mu) {
  Scene scene;
  scene.friction.mu = mu;
  TriangleMesh held;
  for (int i = 0; i < tips; ++i) {
    const double a = 0.2 + 2 * M_PI * i / tips;
    const Vec3 out(std::cos(a), std::sin(a), 0), along(-std::sin(a), std::cos(a), 0);
    const Vec3 n = (Vec3::UnitZ() - rise * along - lean * out).normalized(), tip = radius * out;
    constexpr double kThick = 0.001;
    scene.parts.push_back({"plate " + std::to_string(i),
                           std::make_shared<const TriangleMesh>(shapes::box({0.003, 0.003, kThick})),
                           {Quat::FromTwoVectors(Vec3::UnitZ(), n), tip - 0.5 * kThick * n},
                           false});
    add_tip(tip + kTipHair * n, n, held);
  }
  scene.parts.push_back({"held", std::make_shared<const TriangleMesh>(std::move(held)), Pose(), true});
  return scene;
}

Scene screw_scene(const Screw& s, double mu) {
  return standing(3, 0.5 * s.pitch_diameter, std::tan(kFlankAngle), s.lead(), mu);
}

/// Turned by a torque along the thread's rise (+1) or against it (-1), loaded all the while.
Threshold turned(const Screw& s, double sign, double mu) {
  const double phi = std::atan(mu / s.flank());
  const double expected = kLoad * 0.5 * s.pitch_diameter * std::tan(phi + sign * std::atan(s.lead()));
  char name[64];
  std::snprintf(name, sizeof name, "%s, %s, mu %.2g", s.name, sign > 0 ? "raised" : "lowered", mu);
  return {name,
          sign > 0 ? "T = W r tan(phi + lead)" : "T = W r tan(phi - lead)",
          expected,
          screw_scene(s, mu),
          [sign](double torque) {
            return Wrench{Vec3(0, 0, -kLoad), Vec3(0, 0, sign * torque)};
          },
          0,
          kMaxShare * expected};
}

/// A plug whose seat opens by `half` on each side, pressed in and turned.
Threshold taper(double half, double mu) {
  constexpr double kRadius = 0.01;
  const double expected = mu * kLoad * kRadius / std::sin(half);
  char name[64];
  std::snprintf(name, sizeof name, "loaded taper of %.0f deg, mu %.2g", 180 / M_PI * half, mu);
  return {name,
          "T = mu W r / sin a",
          expected,
          standing(6, kRadius, 1 / std::tan(half), 0, mu),
          [](double torque) {
            return Wrench{Vec3(0, 0, -kLoad), Vec3(0, 0, torque)};
          },
          0,
          kMaxShare * expected};
}

/// One of the corners, each of which turns a rope by `turn`: a shoe between the rope's two ends. The slack end pulls
/// with what the corners before have made of the first newton.
Threshold capstan(int corner, double turn, double mu) {
  const double s = std::sin(0.5 * turn), c = std::cos(0.5 * turn), ratio = (c + mu * s) / (c - mu * s);
  const double slack = 0.5 * std::pow(ratio, corner), expected = slack * ratio;
  char name[64];
  std::snprintf(name, sizeof name, "capstan, corner %d of %.0f deg, mu %.2g", corner + 1, 180 / M_PI * turn, mu);
  return {name,
          "T2 / T1 = (c + mu s) / (c - mu s)",
          expected,
          block_on_floor({0.02, 0.02, 0.004}, mu),
          [slack, s, c](double pull) {
            return Wrench{Vec3((pull - slack) * c, 0, -(pull + slack) * s), Vec3::Zero()};
          },
          slack,
          1.5 * expected};
}

}  // namespace

double Screw::lead() const {
  return pitch / (M_PI * pitch_diameter);
}

double Screw::flank() const {
  return std::cos(std::atan(std::tan(kFlankAngle) * std::cos(std::atan(lead()))));
}

const std::vector<Screw>& screws() {
  static const std::vector<Screw> list = {{"M16 x 2", 2e-3, 14.701e-3}, {"M20 x 2.5", 2.5e-3, 18.376e-3}};
  return list;
}

std::vector<Threshold> tip_thresholds(bool quick) {
  std::vector<Threshold> out;
  for (const Screw& s : screws())
    for (const double mu : quick ? std::vector<double>{0.2} : std::vector<double>{0.1, 0.2})
      for (const double sign : {1.0, -1.0}) out.push_back(turned(s, sign, mu));
  for (const double half : quick ? std::vector<double>{10} : std::vector<double>{5, 10, 30})
    out.push_back(taper(M_PI / 180 * half, 0.1));
  for (int corner = 0; corner < (quick ? 1 : 4); ++corner) out.push_back(capstan(corner, M_PI / 4, 0.3));
  return out;
}

double self_locking_mu(const Screw& screw) {
  constexpr double kMoves = 1e-5;  // m and rad of a screw that goes down by itself
  constexpr int kHalvings = 12;
  double low = 0.01, high = 0.1;
  for (int i = 0; i < kHalvings; ++i) {
    const double mu = 0.5 * (low + high);
    LoadRig rig(screw_scene(screw, mu));
    rig.settle({Vec3(0, 0, -kLoad), Vec3::Zero()});
    const Pose from = rig.X();
    rig.settle({Vec3(0, 0, -kLoad), Vec3::Zero()});
    const Displacement moved = displacement(from, rig.X(), rig.loop().center());
    (moved.dp.norm() + moved.dr.norm() > kMoves ? low : high) = mu;
  }
  return 0.5 * (low + high);
}

}  // namespace tegotae::experiments
