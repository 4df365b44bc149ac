#pragma once

#include <memory>
#include <vector>

#include "broadphase/bounding_spheres.hpp"
#include "contact/contact_set.hpp"
#include "narrowphase/fcl_narrow_phase.hpp"
#include "resolve/metric.hpp"
#include "resolve/resolver.hpp"
#include "tegotae/sim/haptic_loop.hpp"

namespace tegotae {

/// One tick of the contact loop (design: broad phase, intersection, back-off, tracking, contacts, resolver, free
/// check), over a scene whose parts were checked to be free at the start.
class ContactLoop {
 public:
  ContactLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass);

  /// See HapticLoop::step.
  void step(const Pose& Y, double dt, TickReport& report);
  const Pose& pose() const { return X_; }

 private:
  /// A displacement together with the pose it leads to.
  struct Trial {
    Displacement d;
    Pose X;
  };

  /// Moves X towards Y by one free piece no longer than `cap`; returns its length (m), 0 at rest or when blocked.
  double move_piece(const Pose& Y, double cap, TickReport& report);
  /// The trial of at most `cap` that the limits allow; false when there is none.
  bool resolve(const Vec6& wanted, double cap, TickReport& report, Trial& trial);
  /// One programme over the limits: an allowed `motion` for `wanted`.
  bool solve(const Vec6& wanted, TickReport& report, Vec6& motion);
  bool find_hits(const Pose& X);
  Pose back_off(const Displacement& d);
  bool shorten(Trial& trial);
  /// Whether the trial brings X nearer to Y; adapts the trust region.
  bool worth_it(const Vec6& error, const Trial& trial, const Pose& Y);
  void gather(TickReport& report) const;
  /// Bound on how far `d` carries any point of the held part (m).
  double size(const Displacement& d) const { return d.dp.norm() + radius_ * d.dr.norm(); }

  ContactSettings settings_;
  Vec3 center_;
  double radius_;     ///< of the held part about its center of mass
  double piece_cap_;  ///< longest piece near other parts, m
  double reach_;      ///< pairs farther apart are not followed, m
  std::vector<Pose> fixed_poses_;
  BoundingSpheres spheres_;
  std::unique_ptr<FclNarrowPhase> narrow_;
  std::unique_ptr<ContactSet> contacts_;
  Metric metric_;
  std::unique_ptr<Resolver> resolver_;
  LowRankMatrix rows_;
  std::vector<double> bounds_;
  std::vector<std::uint32_t> near_;
  std::vector<TrianglePair> hits_;
  std::shared_ptr<const Surface> held_;
  Pose X_;
  Pose last_Y_;
  double trust_;
};

}  // namespace tegotae
