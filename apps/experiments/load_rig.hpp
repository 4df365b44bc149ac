#pragma once

#include <functional>

#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::experiments {

/// A held part under loads at its center of mass: the pen is put where the coupling's springs pull with them.
class LoadRig {
 public:
  explicit LoadRig(Scene scene);

  /// One tick with the pen at `Y`.
  const TickReport& step(const Pose& Y);
  /// Holds the load until the part has come to its place: so often the pen is put anew for where the part is then.
  void settle(const Wrench& load);
  /// The pen's pose at which the springs pull the part, where it is now, with the load.
  Pose pen_for(const Wrench& load) const;
  /// What the springs pull with the pen at `Y`: the force on the pen, without the damper.
  Wrench felt(const Pose& Y) const;
  /// Lets the load go from `low` to `high` of its parameter in `steps` ticks; the parameter at which the part first
  /// moves, NaN when it does not.
  double onset(double low, double high, int steps, const std::function<Wrench(double)>& load);

  HapticLoop& loop() { return loop_; }
  const Pose& X() const { return loop_.report().proxy.X; }

 private:
  HapticLoop loop_;
};

}  // namespace tegotae::experiments
