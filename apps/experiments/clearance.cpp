#include "experiments/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::experiments {

namespace {

constexpr int kMaxTicks = 4000;  // on the way to the stop
constexpr double kLead = 2e-4;   // m, of the pen on that way
constexpr int kHoldTicks = 100;  // of the pen held still, so many times
constexpr int kMaxHolds = 12;
constexpr double kForceShare = 0.005;  // of the force, by which what comes back may differ
constexpr double kRest = 1e-6;         // m
constexpr double kTick = 1e-3;         // s

struct Stop {
  double way = 0;  ///< m along the direction
  double deepest = 0;
  bool held = false;
};

class Press {
 public:
  Press(const Scene& scene, const Vec3& direction)
      : loop_(scene), stiffness_(scene.coupling.stiffness), direction_(direction), start_(loop_.report().proxy.X) {}

  Stop to(double force) {
    for (int tick = 0; tick < kMaxTicks; ++tick) {
      const double before = way();
      step(before + kLead);
      if (loop_.report().proxy.touching && way() - before < 0.5 * kLead) break;
    }
    // The pen is then held still, and its place set right until the force that comes back is the one asked for.
    Stop stop;
    for (double pen = way() + force / stiffness_; kMaxHolds > holds_ && !stop.held; ++holds_) {
      for (int tick = 0; tick < kHoldTicks; ++tick) step(pen);
      const double rest = way(), missing = force - stiffness_ * (pen - rest);
      for (int tick = 0; tick < kHoldTicks; ++tick) step(pen);
      stop.way = way();
      stop.deepest = loop_.report().depth;
      stop.held =
          loop_.report().proxy.touching && std::abs(stop.way - rest) < kRest && std::abs(missing) < kForceShare * force;
      pen += missing / stiffness_;
    }
    return stop;
  }

 private:
  double way() const { return direction_.dot(loop_.report().proxy.X.p - start_.p); }
  void step(double pen) { loop_.step({start_.q, start_.p + pen * direction_}, kTick); }

  HapticLoop loop_;
  double stiffness_;
  Vec3 direction_;
  Pose start_;
  int holds_ = 0;
};

}  // namespace

Clearance measure_clearance(Scene scene, const Pose& X, const Vec3& direction, double force) {
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  for (Part& p : scene.parts)
    if (p.held) p.pose = X;
  const Stop to = Press(scene, direction).to(force), fro = Press(scene, -direction).to(force);
  return {to.way + fro.way, std::max(to.deepest, fro.deepest), to.held && fro.held};
}

}  // namespace tegotae::experiments
