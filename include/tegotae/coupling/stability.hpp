#pragma once

#include <optional>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Upper bounds of a coupling's stiffness. Below them a sampled wall never gives energy to a hand, whatever the hand
/// does.
///
/// b is the damping of the device, B that of the coupling, T the period, f_c the Coulomb friction and Δ the position
/// resolution. Sampling requires b > K T / 2 + |B| (Colgate and Schenkel, "Passivity of a class of sampled-data
/// systems", 1997). Quantization requires K <= 2 f_c / Δ (Abbott and Okamura, "Effects of position quantization and
/// sampling rate on virtual-wall passivity", 2005). A hand that holds the pen adds damping, so a coupling above a bound
/// can still be stable in a hand. No coupling below both is unstable.
struct StabilityReport {
  double rate_hz = 0;                               ///< rate of the servo
  CouplingSettings coupling;                        ///< the requested one
  std::optional<double> sampling_limit;             ///< N/m, 2 (b - |B|) / T, at least 0; none when b is not known
  double quantization_limit = 0;                    ///< N/m, 2 f_c / Δ; infinite without quantization
  std::optional<double> stiffness_limit;            ///< N/m, the smaller of both; none when b is not known
  std::optional<double> torsional_stiffness_limit;  ///< N·m/rad, by sampling alone; none when not known
  /// Returns the report in one line, for people.
  std::string text() const;
};

/// Returns the report on `coupling` with `device` and a servo of `rate_hz`.
StabilityReport stability(const DeviceInfo& device, const CouplingSettings& coupling, double rate_hz);

/// Returns the upper bound (N·m/rad) for fitted_torsional_stiffness(). `limit` is
/// StabilityReport::torsional_stiffness_limit of the device, `torque` its peak (N·m). The bound is half of the limit,
/// and at most torque / 0.05 rad: with a stiffer coupling a hand would feel the steps of the pen's angle. When the
/// limit is not known (none or 0), the bound is the default of CouplingSettings.
double torsional_stiffness_bound(std::optional<double> limit, double torque) noexcept;

}  // namespace tegotae
