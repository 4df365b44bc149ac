#include "experiments/load_rig.hpp"

#include <cmath>
#include <limits>

namespace tegotae::experiments {
namespace {

constexpr int kSettleRounds = 4, kSettleTicks = 60;
// A part that moves farther (m) or turns more (rad) than this no longer sticks.
constexpr double kMoves = 1e-7, kTurns = 1e-6;

Scene unhurried(Scene scene) {
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  return scene;
}

}  // namespace

LoadRig::LoadRig(Scene scene) : loop_(unhurried(std::move(scene))) {}

const TickReport& LoadRig::step(const Pose& Y) {
  return loop_.step(Y, 1e-3);
}

Pose LoadRig::pen_for(const Wrench& load) const {
  const CouplingSettings& k = loop_.coupling();
  return displaced(X(), loop_.center(), {load.force / k.stiffness, load.torque / k.torsional_stiffness});
}

Wrench LoadRig::felt(const Pose& Y) const {
  CouplingSettings springs = loop_.coupling();
  springs.damping = springs.torsional_damping = 0;
  return coupling_wrench(springs, {X(), {}, true, {}}, Y, {}, loop_.center());
}

void LoadRig::settle(const Wrench& load) {
  for (int round = 0; round < kSettleRounds; ++round) {
    const Pose Y = pen_for(load);
    for (int i = 0; i < kSettleTicks; ++i) step(Y);
  }
}

double LoadRig::onset(double low, double high, int steps, const std::function<Wrench(double)>& load) {
  settle(load(low));
  const Pose from = X();
  const CouplingSettings& k = loop_.coupling();
  for (int i = 0; i <= steps; ++i) {
    const double s = low + (high - low) * i / steps;
    const Wrench w = load(s);
    step(displaced(from, loop_.center(), {w.force / k.stiffness, w.torque / k.torsional_stiffness}));
    const Displacement moved = displacement(from, X(), loop_.center());
    if (moved.dp.norm() > kMoves || moved.dr.norm() > kTurns) return s;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tegotae::experiments
