#pragma once

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Spring and damper between the held part and the pen (section 4.2 of the paper). The defaults are the closed-loop
/// stiffness that a PHANTOM Premium 1.5/6DOF renders without vibrating.
struct CouplingSettings {
  double stiffness = 800.0;          ///< N/m
  double damping = 5.0;              ///< N·s/m
  double torsional_stiffness = 0.3;  ///< N·m/rad
  double torsional_damping = 0.004;  ///< N·m·s/rad
};

/// Returns the length (m) that weighs a rotation against a translation in the springs' energy: scale × √(k_t / k), 19
/// mm by default. It is a length of the world, in which the part moves `scale` meters for a meter of the pen. The held
/// part goes where this energy is least, and so the hand feels the sum of the contact forces. The result is at least
/// 0.1 mm and at most 10 m, also when a stiffness is zero.
double coupling_radius(const CouplingSettings& settings, double scale = 1) noexcept;

/// Returns the torsional stiffness (N·m/rad) that fits a part with a radius of gyration of `radius` (m, in the pen's
/// lengths): stiffness × radius². With it, rotating the part and moving it feel equally hard. The result is at least
/// the default of CouplingSettings, which is enough for small parts. It is at most `max_stiffness` (but not less than
/// that default), which device and stability allow (torsional_stiffness_bound()).
double fitted_torsional_stiffness(double stiffness, double radius, double max_stiffness) noexcept;

/// State of the held part that the coupling needs: its pose `X` and the velocity of its center of mass, in the world.
struct ProxyState {
  Pose X;                 ///< X_WF of its file frame
  Twist velocity;         ///< `v` of its center of mass
  bool touching = false;  ///< contacts hold it back, or the contact loop lags
  /// Wrench that pulls at the part besides the contacts, as the hand feels it: its weight, and a guide
  /// (HapticLoop::pull). In the world, at the center of mass. It draws the part away from the pen; see loaded().
  Wrench load = {};
};

/// Returns the pose to which the coupling's springs draw the held part while `load` (N and N·m, world) pulls at it. It
/// is the pen's pose `Y` displaced by scale × F / k, and rotated by T / k_t about the center of mass. `center` is that
/// center (m, file frame), and `scale` is Scene::scale. A spring of zero stiffness adds no displacement.
Pose loaded(const Pose& Y, const Vec3& center, const CouplingSettings& settings, double scale,
            const Wrench& load) noexcept;

/// Returns the wrench on the pen at the held part's center of mass, expressed in the world: F = k (X − Y) + d (Ẋ − Ẏ),
/// T = k_t rotvec(R_X R_Yᵀ) + d_t (ω_X − ω_Y). While nothing holds the part back (ProxyState::touching), it is the load
/// alone. `center` is the center of mass in the file frame (m). `Y_velocity.v` is the velocity of that point of the
/// pen's body.
Wrench coupling_wrench(const CouplingSettings& settings, const ProxyState& x, const Pose& Y, const Twist& Y_velocity,
                       const Vec3& center) noexcept;

}  // namespace tegotae
