#include "tegotae/coupling/stability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/number_text.hpp"

namespace tegotae {

namespace {

/// The largest stiffness that leaves a sampled wall passive; none when the device's damping is not known.
std::optional<double> sampling_limit(double device_damping, double damping, double rate_hz) {
  if (!(device_damping > 0)) return std::nullopt;
  return std::max(0.0, 2 * (device_damping - std::abs(damping)) * rate_hz);
}

// Of the stiffness that sampling allows, what is chosen unasked.
constexpr double kStableShare = 0.5;
// rad; steps of a pen's angle (0.1 mrad) are 1/500 of it. Pens have no dry friction in their gimbals to speak of, so by
// such steps a stiffer coupling keeps a hand that rests between two of them going to and fro.
constexpr double kMinFullTurn = 0.05;

std::string limit_text(std::optional<double> limit, const char* unit) {
  if (!limit) return "limit not known";
  return "limit " + number_text(*limit, 3) + " " + unit;
}

}  // namespace

StabilityReport stability(const DeviceInfo& device, const CouplingSettings& coupling, double rate_hz) {
  StabilityReport r;
  r.rate_hz = rate_hz;
  r.coupling = coupling;
  r.sampling_limit = sampling_limit(device.damping, coupling.damping, rate_hz);
  r.quantization_limit = device.position_resolution > 0 ? 2 * device.friction / device.position_resolution
                                                        : std::numeric_limits<double>::infinity();
  if (r.sampling_limit) r.stiffness_limit = std::min(*r.sampling_limit, r.quantization_limit);
  r.torsional_stiffness_limit = sampling_limit(device.torsional_damping, coupling.torsional_damping, rate_hz);
  return r;
}

double torsional_stiffness_bound(std::optional<double> limit, double torque) noexcept {
  if (!(limit.value_or(0) > 0)) return CouplingSettings().torsional_stiffness;
  return std::min(kStableShare * *limit, torque / kMinFullTurn);
}

std::string StabilityReport::text() const {
  std::string line =
      "stiffness " + number_text(coupling.stiffness, 4) + " N/m (" + limit_text(stiffness_limit, "N/m") + ")";
  line += ", " + number_text(coupling.torsional_stiffness, 4) + " N·m/rad (" +
          limit_text(torsional_stiffness_limit, "N·m/rad") + ")";
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const bool above = coupling.stiffness > stiffness_limit.value_or(kNone) ||
                     coupling.torsional_stiffness > torsional_stiffness_limit.value_or(kNone);
  return above ? line + ": above the limit, only the hand and the passivity controller keep it quiet" : line;
}

}  // namespace tegotae
