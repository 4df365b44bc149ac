#pragma once

#include <algorithm>

#include "tegotae/transport/contact_link.hpp"

namespace tegotae {

/// Of the held part's weight, what the hand carries: it comes and goes over kWeightTime with the force, so that neither
/// engaging nor clutching makes it jump.
class WeightRamp {
 public:
  /// After `dt` seconds with the pen as the servo told it last; 0 to 1.
  double update(const PenSample& pen, double dt) noexcept {
    const bool carries = pen.status == DeviceStatus::enabled && pen.clutch == Clutch::none;
    share_ = std::clamp(share_ + (carries ? 1 : -1) * dt / kWeightTime, 0.0, 1.0);
    return share_;
  }

 private:
  static constexpr double kWeightTime = 0.3;  // s
  double share_ = 0;
};

}  // namespace tegotae
