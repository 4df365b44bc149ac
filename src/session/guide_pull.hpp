#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "coupling/path_guide.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae {

/// A guide along `path` (poses X_WF of the held part's file frame), no stronger than the device stands for beside the
/// weight in `loop`. `scene` (without its parts) has the device's bounds and the scale. Throws Error for a path without
/// poses, and for a resolver that draws the part to another place than the load does.
PathGuide guide_along(const std::vector<Pose>& path, const Scene& scene, const HapticLoop& loop);

/// The pull of guides that come and go while the hand is on the pen: what one gave last fades while the next one grows.
class GuidePull {
 public:
  /// Guides along another path from the next update() on; nothing: no longer.
  void set(std::optional<PathGuide> guide) {
    left_ = last_;
    share_ = 0;
    guide_ = std::move(guide);
    on_ = guide_.has_value();
  }
  /// Another part is held: nothing pulls any longer. Frees nothing.
  void end() noexcept {
    on_ = false;
    left_ = last_ = {};
  }
  /// The wrench on the pen at `Y`, as PathGuide::pull.
  Wrench update(const Pose& Y, double dt) noexcept {
    share_ = std::min(1.0, share_ + dt / PathGuide::kReturn);
    last_ = {(1 - share_) * left_.force, (1 - share_) * left_.torque};
    if (!on_) return last_;
    const Wrench pull = guide_->pull(Y, dt);
    last_.force += share_ * pull.force;
    last_.torque += share_ * pull.torque;
    return last_;
  }

 private:
  std::optional<PathGuide> guide_;
  bool on_ = false;
  double share_ = 1;      ///< of the guide's pull, 0 to 1
  Wrench left_, last_{};  ///< what there was when the guide came; of the last update()
};

}  // namespace tegotae
