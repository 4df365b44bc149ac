#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Spring and damper between the held part and the pen (the paper's section 4.2). The defaults are the closed-loop
/// stiffness that a PHANTOM Premium 1.5/6DOF renders without vibrating.
struct CouplingSettings {
  double stiffness = 800.0;          ///< N/m
  double damping = 5.0;              ///< N·s/m
  double torsional_stiffness = 0.3;  ///< N·m/rad
  double torsional_damping = 0.004;  ///< N·m·s/rad
};

/// How much a turn weighs against a shift in the springs' energy, as a length (m): √(k_t / k), 19 mm by default, in the
/// lengths of the world when the part moves `scale` meters for a meter of the pen. The held part goes where this energy
/// is least, which is why what the hand feels is the sum of the contact forces. Within 0.1 mm to 10 m whatever the
/// stiffnesses are (one of them may be zero).
double coupling_radius(const CouplingSettings& settings, double scale = 1) noexcept;

/// The torsional stiffness (N·m/rad) that fits a part whose radius of gyration is `radius` (m, in the pen's lengths):
/// stiffness × radius², so that turning it and shifting it feel equally hard; at least the default of
/// CouplingSettings, which small parts need no less of, and at most `most`, what device and stability allow
/// (torsional_stiffness_bound()).
double fitted_torsional_stiffness(double stiffness, double radius, double most) noexcept;

/// What the coupling needs of the held part: its pose `X` and the velocity of its center of mass, in the world.
struct ProxyState {
  Pose X;                 ///< X_WF of its file frame
  Twist velocity;         ///< `v` of its center of mass
  bool touching = false;  ///< held back, by contacts or because the contact loop lags
  /// World, at the center of mass: what pulls at the part beside the contacts, as the hand feels it. The part's weight,
  /// and a guide (HapticLoop::pull). The part is drawn away from the pen by load / stiffness; see loaded().
  Wrench load = {};
};

/// Where the springs of the coupling draw the held part while `load` pulls at it: off the pen at `Y` by F / k and
/// turned by T / k_t about its center of mass (`center`, file frame, m), in the world, of which `scale` meters are a
/// meter of the pen. `Y` itself without load, and for a stiffness of zero.
Pose loaded(const Pose& Y, const Vec3& center, const CouplingSettings& settings, double scale,
            const Wrench& load) noexcept;

/// Wrench on the pen at the held part's center of mass, expressed in the world:
/// F = k (X − Y) + d (Ẋ − Ẏ), T = k_t rotvec(R_X R_Yᵀ) + d_t (ω_X − ω_Y); when not touching the load alone.
/// `center` is the center of mass in the file frame (m); `Y_velocity.v` is the velocity of that point of the pen's
/// body.
Wrench coupling_wrench(const CouplingSettings& settings, const ProxyState& x, const Pose& Y, const Twist& Y_velocity,
                       const Vec3& center) noexcept;

}  // namespace tegotae
