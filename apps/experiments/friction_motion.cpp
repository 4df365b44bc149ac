#include "experiments/friction_motion.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "experiments/friction_scenes.hpp"
#include "experiments/load_rig.hpp"

namespace tegotae::experiments {
namespace {

const Vec3 kBlock(0.02, 0.02, 0.01);  // half widths, m
constexpr double kPress = 2e-3;       // m of the pen under where the block lies

/// The pen's pose at which the block is pressed, after it has been.
Pose press(LoadRig& rig) {
  Pose Y = rig.X();
  const double from = Y.p.z();
  for (int i = 1; i <= 300; ++i) {
    Y.p.z() = from - kPress * std::min(1.0, i / 200.0);
    rig.step(Y);
  }
  return Y;
}

/// The pen's pose that pulls the block by `share` of its friction, tilts it and twists it by `twist` (rad), after it
/// has come to rest there.
Pose hold(LoadRig& rig, double mu, double share, double twist) {
  Pose Y = press(rig);
  Y.p.x() += share * mu * kPress;
  Y.q = rotation({0.01, 0.005, twist}) * Y.q;
  for (int i = 0; i < 200; ++i) rig.step(Y);
  return Y;
}

}  // namespace

Sliding slide(double mu, double heading) {
  LoadRig rig(block_on_floor(kBlock, mu));
  Pose Y = press(rig);
  Sliding out{mu, heading, 0, 0, 0, 0, 0};
  const Vec3 way(std::cos(heading), std::sin(heading), 0), across = Vec3::UnitZ().cross(way);
  const Quat before = rig.X().q;
  constexpr int kTicks = 300, kStarting = 60;
  double least = 1, most = 0;
  for (int i = 0; i < kTicks; ++i) {
    Y.p += 1e-4 * way;
    const double gap = rig.step(Y).gap;
    if (i < kStarting) continue;
    const Vec3 f = rig.felt(Y).force;
    const double friction = mu * f.z();
    out.ratio -= f.dot(way) / friction / (kTicks - kStarting);
    out.worst = std::max(out.worst, std::abs(-f.dot(way) / friction - 1));
    out.aside = std::max(out.aside, std::abs(f.dot(across)) / friction);
    least = std::min(least, gap);
    most = std::max(most, gap);
  }
  out.gap_change = most - least;
  out.turn = rig.X().q.angularDistance(before);
  return out;
}

Slot slide_in_slot(double play, double mu) {
  LoadRig rig(plate_in_slot(play, mu));
  Pose Y = press(rig);
  const double from = rig.X().p.x();
  constexpr int kTicks = 300;
  for (int i = 0; i < kTicks; ++i) {
    Y.p.x() += 1e-4;
    rig.step(Y);
  }
  const Vec3 f = rig.felt(Y).force;
  // A plate that sticks until the springs pull mu N is behind by so much.
  const double behind = mu * f.z() / rig.loop().coupling().stiffness;
  return {play, mu, (rig.X().p.x() - from) / (1e-4 * kTicks - behind), -f.x() / (mu * f.z())};
}

Creep rest(double mu, int ticks) {
  LoadRig rig(block_on_floor(kBlock, mu));
  const Pose Y = hold(rig, mu, 0.8, 0.02);
  const Pose from = rig.X();
  for (int i = 0; i < ticks; ++i) rig.step(Y);
  const Displacement crept = displacement(from, rig.X(), rig.loop().center());
  return {mu, crept.dp.norm(), crept.dr.norm()};
}

Jitter jitter(double mu, int ticks) {
  std::mt19937 random(1);
  const auto off = [&random] {
    const auto one = [&random] {
      return kPenNoise * (2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1);
    };
    const double x = one(), y = one(), z = one();
    return Vec3(x, y, z);
  };
  Jitter out;
  out.mu = mu;
  {
    LoadRig rig(block_on_floor(kBlock, mu));
    // Well within its cone: at its border any push outwards moves a part for good, as Coulomb has it.
    const Pose Y = hold(rig, mu, 0.5, 0.02 * mu), from = rig.X();
    const Wrench still = rig.felt(Y);
    for (int i = 0; i < ticks; ++i) {
      const Vec3 e = off();
      const Pose pen{Y.q, Y.p + e};
      rig.step(pen);
      const Vec3 change = rig.felt(pen).force - still.force;
      out.share = std::max(out.share, change.norm() / (rig.loop().coupling().stiffness * e.norm()));
      out.way = std::max(out.way, displacement(from, rig.X(), rig.loop().center()).dp.norm());
    }
  }
  LoadRig rig(block_on_floor(kBlock, mu));
  Pose Y = press(rig);
  constexpr int kTicks = 300, kStarting = 60;
  for (int i = 0; i < kTicks; ++i) {
    Y.p.x() += 1e-4;
    const Pose pen{Y.q, Y.p + off()};
    const double before = rig.X().p.x();
    rig.step(pen);
    if (i < kStarting) continue;
    const Vec3 f = rig.felt(pen).force;
    out.worst = std::max(out.worst, std::abs(f.head<2>().norm() / (mu * f.z()) - 1));
    out.back += rig.X().p.x() < before ? 1 : 0;
  }
  return out;
}

Hysteresis to_and_fro(double mu) {
  constexpr double kReach = 5e-3;
  constexpr int kTicks = 4000;
  LoadRig rig(block_on_floor(kBlock, mu));
  const Pose home = press(rig);
  Hysteresis out;
  out.mu = mu;
  const double at_rest = rig.X().p.x();
  const double normal = rig.felt(home).force.z();
  double last_x = 0, last_f = 0;
  for (int i = 0; i <= 2 * kTicks; ++i) {
    const double x = kReach * std::sin(2 * M_PI * i / kTicks);
    Pose Y = home;
    Y.p.x() += x;
    rig.step(Y);
    const double f = rig.felt(Y).force.x();
    if (out.breakaway == 0 && rig.X().p.x() - at_rest > 1e-8) out.breakaway = x;
    if (i > kTicks) {
      out.lost -= 0.5 * (f + last_f) * (x - last_x);
      out.pen.push_back(1e3 * x);
      out.force.push_back(f);
    }
    last_x = x;
    last_f = f;
  }
  const double sticks = mu * normal / rig.loop().coupling().stiffness;
  out.breakaway_expected = sticks;
  out.step = kReach * 2 * M_PI / kTicks;
  out.expected = 4 * mu * normal * (kReach - sticks);
  return out;
}

double closed_way(double mu) {
  constexpr int kSteps = 20000;
  LoadRig rig(block_on_floor(kBlock, mu));
  Pose home = press(rig);
  home.p.z() += 0.5 * kPress;
  const auto at = [&](double s) {
    const double a = 2 * M_PI * s;
    return displaced(home, rig.loop().center(),
                     {Vec3(3e-3 * std::sin(a), 2e-3 * std::sin(2 * a), 0.7e-3 * (1 - std::cos(a))),
                      Vec3(0.01 * std::sin(2 * a), 0.02 * std::sin(a), 0.05 * std::sin(a))});
  };
  double given = 0;
  // In the first round friction leaves the part where it stays.
  for (int round = 0; round < 2; ++round) {
    given = 0;
    Wrench last;
    Pose last_Y;
    for (int i = 0; i <= kSteps; ++i) {
      const Pose Y = at(static_cast<double>(i % kSteps) / kSteps);
      rig.step(Y);
      const Wrench w = rig.felt(Y);
      if (i > 0) {
        const Displacement d = displacement(last_Y, Y, rig.loop().center());
        given += 0.5 * ((w.force + last.force).dot(d.dp) + (w.torque + last.torque).dot(d.dr));
      }
      last = w;
      last_Y = Y;
    }
  }
  return given;
}

}  // namespace tegotae::experiments
