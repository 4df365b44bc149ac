#include <cmath>

#include "core/numbers.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/operator/operator.hpp"

namespace tegotae {
namespace {

// A grip of this stiffness and mass (N/m, kg), near critical damping with the pen's own mass on it.
HandSettings grip(double stiffness, double mass, double torsional_stiffness) {
  constexpr double kPenMass = 0.075, kPenInertia = 1.2e-4;
  HandSettings h;
  h.stiffness = stiffness;
  h.mass = mass;
  h.damping = 2.0 * std::sqrt(stiffness * (mass + kPenMass));
  h.torsional_stiffness = torsional_stiffness;
  h.torsional_damping = 2.0 * std::sqrt(torsional_stiffness * (h.inertia + kPenInertia));
  return h;
}

std::vector<OperatorProfile> made() {
  OperatorProfile careful;
  careful.name = "careful";
  careful.hand = grip(300, 0.3, 1.2);
  careful.tremor = 15e-6;
  careful.tremor_angle = 3e-4;
  careful.visual_delay = 0.25;
  careful.carry_speed = 0.03;
  careful.insertion_speed = 0.012;
  careful.aim_error = 0.6e-3;
  careful.tilt_error = 1.0 * kDegree;
  careful.eye_error = 0.3e-3;
  careful.eye_tilt_error = 0.7 * kDegree;
  careful.press = 1.0;
  careful.patience = 0.5;
  careful.wiggle = 0.5 * kDegree;

  OperatorProfile average;
  average.name = "average";
  average.hand = grip(400, 0.3, 1.5);
  average.tremor = 30e-6;
  average.tremor_angle = 6e-4;
  average.visual_delay = 0.20;
  average.carry_speed = 0.05;
  average.insertion_speed = 0.02;
  average.aim_error = 1.0e-3;
  average.tilt_error = 2.0 * kDegree;
  average.eye_error = 0.5e-3;
  average.eye_tilt_error = 1.2 * kDegree;
  average.press = 1.5;
  average.patience = 0.35;
  average.wiggle = 0.8 * kDegree;

  OperatorProfile hasty;
  hasty.name = "hasty";
  hasty.hand = grip(600, 0.35, 2.0);
  hasty.tremor = 60e-6;
  hasty.tremor_angle = 1.2e-3;
  hasty.visual_delay = 0.15;
  hasty.carry_speed = 0.08;
  hasty.insertion_speed = 0.035;
  hasty.aim_error = 1.6e-3;
  hasty.tilt_error = 3.0 * kDegree;
  hasty.eye_error = 0.8e-3;
  hasty.eye_tilt_error = 2.0 * kDegree;
  hasty.press = 2.5;
  hasty.patience = 0.25;
  hasty.wiggle = 1.2 * kDegree;
  return {careful, average, hasty};
}

}  // namespace

const std::vector<OperatorProfile>& operator_profiles() {
  static const std::vector<OperatorProfile> profiles = made();
  return profiles;
}

const OperatorProfile& operator_profile(const std::string& name) {
  for (const OperatorProfile& p : operator_profiles())
    if (p.name == name) return p;
  throw Error(ErrorKind::setting, "unknown operator \"" + name + "\"; known are careful, average, hasty");
}

}  // namespace tegotae
