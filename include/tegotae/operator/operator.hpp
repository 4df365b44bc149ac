#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/device/input_source.hpp"
#include "tegotae/device/simulated_device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How an operator works. A figure without a named source is our assumption. We chose the figures so that the three
/// profiles span the range of people with a pen.
struct OperatorProfile {
  std::string name;   ///< "careful", "average", "hasty"
  HandSettings hand;  ///< mass, stiffness and damping of the grip
  /// Root mean square of the tremor in each coordinate, m and rad, all of it in 8 to 12 Hz. Postural tremor of healthy
  /// hands peaks at 0.0015 to 0.035 g (Arch. Neurol. 39, 1982, 97 subjects), which at 10 Hz is 4 to 90 µm.
  double tremor;
  double tremor_angle;  ///< rad
  /// Delay from seeing to correcting, s: 0.15 to 0.25 (Keele & Posner, J. Exp. Psychol. 77, 1968; Carlton 1981).
  double visual_delay;
  double carry_speed;      ///< mean speed of carrying the part to the hole, m/s
  double insertion_speed;  ///< mean speed of pushing it in while nothing resists, m/s
  double aim_error;        ///< standard deviation of the tip's first target, in each direction, m
  double tilt_error;       ///< standard deviation of the part's first orientation, in each direction, rad
  double eye_error;        ///< standard deviation of the offset that the eye sees, in each direction, m
  double eye_tilt_error;   ///< standard deviation of the tilt that the eye sees, in each direction, rad
  double press;            ///< force with which the hand pushes against resistance, N
  double patience;         ///< time without progress before the hand wiggles, s
  double wiggle;           ///< tilt of the first wiggle, rad; later ones grow
};

/// Returns the three profiles: "careful", "average", "hasty".
const std::vector<OperatorProfile>& operator_profiles();
/// Returns the profile of that name. Throws Error (kind setting) for an unknown one.
const OperatorProfile& operator_profile(const std::string& name);

/// Task of an operator: bring the tip of the held part to a hole, and push the part in along the hole's axis.
struct InsertionTask {
  Pose start;                    ///< X_WF where the hand begins, at rest
  Pose goal;                     ///< X_WF of the part when it is fully inserted
  Vec3 tip = Vec3::Zero();       ///< of the part, m, file frame
  Vec3 inward = -Vec3::UnitZ();  ///< unit vector along the hole, world
  double depth = 0;              ///< m, depth of the goal's tip below the surface that the hole is in
  double hover = 4e-3;           ///< height over the surface from which the operator brings the tip down, m
  Vec3 offset = Vec3::Zero();    ///< added to the tip's first target, m, world, across `inward`
  Vec3 tilt = Vec3::Zero();      ///< added to the part's first orientation, rotation vector, rad, world
  bool own_errors = true;        ///< adds the profile's aim_error and tilt_error to these two
};

/// A model of a person at a simulated pen. The model carries the part over the hole on a minimum-jerk path and brings
/// it down. It sees offset and tilt late and inexactly, and aims again about five times a second. It feels how far the
/// pen lags and pushes no harder than it intends. When it makes no progress it wiggles: it moves in small circles and
/// tilts that grow, while it straightens the part. Every two seconds without progress it draws the part back for a
/// moment and tries again. Its hand trembles throughout. The same profile, task, seed and calls give the same bits.
class Operator final : public InputSource {
 public:
  /// Throws Error (kind setting) for an impossible task or profile.
  Operator(const OperatorProfile& profile, const InsertionTask& task, std::uint64_t seed);
  ~Operator() override;

  /// Shows the operator where the held part is (X_WF) at `t` (s). The operator responds `visual_delay` later.
  void see(double t, const Pose& X) noexcept;

  double begin() const noexcept override { return 0; }
  Pose start() const noexcept override;
  HandTarget target(double t, const Pose& pen) noexcept override;

  /// Returns whether the operator wiggles because it makes no progress.
  bool stuck() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
