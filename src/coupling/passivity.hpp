#pragma once

#include "tegotae/core/pose.hpp"

namespace tegotae {

/// What the passivity observer may take for granted.
struct PassivitySettings {
  double device_damping = 0;            ///< N·s/m that the device takes out by itself
  double device_torsional_damping = 0;  ///< N·m·s/rad
  double damping_most = 10;             ///< N·s/m that the controller may add
  double credit = 1e-3;                 ///< J, dissipated energy is remembered up to this
  double idle = 0;                      ///< J, generated energy up to this is let be
};

/// Time-domain passivity observer and controller (Hannaford and Ryu, "Time-domain passivity control of haptic
/// interfaces", 2002) of the port at which the hand holds the pen. The energy that the hand has put in, less what the
/// coupling's springs store and what the device has damped, cannot fall for a passive coupling; a sampled one loses
/// ½ K Δx² in each tick. When it falls below zero, the controller damps the pen until it is back.
class Passivity {
 public:
  explicit Passivity(const PassivitySettings& settings) : settings_(settings) {}

  /// Accounts for the last `dt` seconds: the pen moved by `moved` under the constant wrench `rendered`, and the springs
  /// now store `stored` (J). Unless `whole`, the wrench was not the coupling's (faded or cut): the time does not count.
  /// `steps` (J): see PenSteps; so much may be missing in this time without being called generated.
  void observe(const Displacement& moved, const Wrench& rendered, double stored, bool whole, double dt,
               double steps = 0) noexcept;
  /// The wrench that damps the pen moving as in the last observe(); `arm2` (m²) weighs rotation: its damping is
  /// the translation's times this. Zero unless acts().
  Wrench controller(double arm2) const noexcept;

  /// J, at most the credit; below zero: generated. A servo turns the force off below its bound.
  double energy() const noexcept { return energy_; }
  /// Whether the controller has something to damp.
  bool acts() const noexcept { return energy_ < -settings_.idle; }
  void reset() noexcept { energy_ = 0; }

 private:
  PassivitySettings settings_;
  double energy_ = 0;
  double stored_ = 0;
  Twist velocity_;
  double dt_ = 0;
};

}  // namespace tegotae
