#pragma once

#include <optional>
#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/device/device.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How stiff a coupling may be so that a sampled wall never gives a hand energy, whatever the hand does. With b the
/// damping of the device, B that of the coupling, T the period, f_c the Coulomb friction and Δ the position resolution:
/// b > K T / 2 + |B| (Colgate and Schenkel, "Passivity of a class of sampled-data systems", 1997) and
/// K <= 2 f_c / Δ (Abbott and Okamura, "Effects of position quantization and sampling rate on virtual-wall passivity",
/// 2005). A hand that holds the pen adds damping: couplings above the limit can be stable in a hand, none below it is
/// unstable.
struct StabilityReport {
  double rate_hz = 0;                               ///< of the servo
  CouplingSettings coupling;                        ///< what is asked for
  std::optional<double> sampling_limit;             ///< N/m, 2 (b - |B|) / T; none when b is not known
  double quantization_limit = 0;                    ///< N/m, 2 f_c / Δ; infinite without quantization
  std::optional<double> stiffness_limit;            ///< N/m, the smaller one; none when not known
  std::optional<double> torsional_stiffness_limit;  ///< N·m/rad, by sampling alone; none when not known
  /// In one line, for people.
  std::string text() const;
};

/// Of `coupling` on `device` at `rate_hz`.
StabilityReport stability(const DeviceInfo& device, const CouplingSettings& coupling, double rate_hz);

/// The most that fitted_torsional_stiffness() should choose (N·m/rad) for a device of which `limit` is
/// StabilityReport::torsional_stiffness_limit and `torque` its peak (N·m): half of the limit, and not so stiff that the
/// peak is reached within 0.05 rad, where a step of the pen's angle would be felt. Where the limit is not known (none
/// or 0), the default of CouplingSettings.
double torsional_stiffness_bound(std::optional<double> limit, double torque) noexcept;

}  // namespace tegotae
