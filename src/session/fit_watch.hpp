#pragma once

#include <cstddef>
#include <vector>

#include "tegotae/session/session.hpp"

namespace tegotae {

/// Notices that a part whose fit has no room stands where it started while its pen goes away (HeldFast).
class FitWatch {
 public:
  /// `scene`: in which `loop` begins.
  FitWatch(const HapticLoop& loop, const Scene& scene);
  /// Another part is held from now on, at `X`: it is no longer looked at, for its parts are of another scene.
  void begin(const Pose& X) noexcept;
  /// After a tick of `dt` (s) in which a pair was relieved, the pen at `Y`. Never allocates
  /// where `found.parts` has room for all.
  void update(const HapticLoop& loop, const Pose& Y, double dt, HeldFast& found) noexcept;
  bool held() const noexcept { return held_; }

 private:
  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }

  Vec3 center_;
  double radius_;
  Pose start_;
  double standing_ = 0;  // s
  bool held_ = false, first_ = true;
};

}  // namespace tegotae
