#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/device/input_source.hpp"
#include "tegotae/device/simulated_device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How an operator works. Where no source is named the figure is an assumption of ours, chosen so that the three
/// profiles span what people do with a pen.
struct OperatorProfile {
  std::string name;   ///< "careful", "average", "hasty"
  HandSettings hand;  ///< mass, stiffness and damping of the grip
  /// Root mean square of the tremor in each coordinate, m and rad, all of it in 8 to 12 Hz. Postural tremor of healthy
  /// hands peaks at 0.0015 to 0.035 g (Arch. Neurol. 39, 1982, 97 subjects), which at 10 Hz is 4 to 90 µm.
  double tremor;
  double tremor_angle;  ///< rad
  /// From seeing to correcting, s: 0.15 to 0.25 (Keele & Posner, J. Exp. Psychol. 77, 1968; Carlton 1981).
  double visual_delay;
  double carry_speed;      ///< mean speed of carrying the part to the hole, m/s
  double insertion_speed;  ///< mean speed of pushing it in while nothing resists, m/s
  double aim_error;        ///< standard deviation of where the tip is first brought to, each direction, m
  double tilt_error;       ///< of how the part is first held, each direction, rad
  double eye_error;        ///< of the offset that the eye sees, each direction, m
  double eye_tilt_error;   ///< of the tilt that the eye sees, each direction, rad
  double press;            ///< force with which the hand pushes against resistance, N
  double patience;         ///< time without progress after which it wiggles, s
  double wiggle;           ///< tilt of the first wiggle, rad; it grows from there
};

/// The three profiles: "careful", "average", "hasty".
const std::vector<OperatorProfile>& operator_profiles();
/// Throws Error for an unknown name.
const OperatorProfile& operator_profile(const std::string& name);

/// What an operator is to do: bring the tip of the held part to a hole and push the part in along the hole's axis.
struct InsertionTask {
  Pose start;                    ///< X_WF where the hand begins, at rest
  Pose goal;                     ///< X_WF of the part when it is all the way in
  Vec3 tip = Vec3::Zero();       ///< of the part, m, file frame
  Vec3 inward = -Vec3::UnitZ();  ///< unit vector along the hole, world
  double depth = 0;              ///< of the goal's tip below the surface that the hole is in, m
  double hover = 4e-3;           ///< height over the surface from which the tip is brought down, m
  Vec3 offset = Vec3::Zero();    ///< added to where the tip is first brought to, m, world, across `inward`
  Vec3 tilt = Vec3::Zero();      ///< added to how the part is first held, rotation vector, rad, world
  bool own_errors = true;        ///< whether the profile's aim_error and tilt_error are added to those two
};

/// A model of a person at a simulated pen: carries the part over the hole on a minimum-jerk path, brings it down, sees
/// offset and tilt late and not exactly and aims again about five times a second, feels how far the pen stays behind
/// and pushes no harder than it means to, and when nothing goes on wiggles: small circles and tilts that grow while it
/// straightens the part. With a tremor throughout. The same profile, task, seed and calls give the same bits.
class Operator final : public InputSource {
 public:
  /// Throws Error for a task or a profile that cannot be.
  Operator(const OperatorProfile& profile, const InsertionTask& task, std::uint64_t seed);
  ~Operator() override;

  /// Shows the operator where the held part is (X_WF) at `t` (s). It acts on it `visual_delay` later.
  void see(double t, const Pose& X) noexcept;

  double begin() const noexcept override { return 0; }
  Pose start() const noexcept override;
  HandTarget target(double t, const Pose& pen) noexcept override;

  /// Whether it is wiggling because nothing goes on.
  bool stuck() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tegotae
