#pragma once

#include <memory>
#include <vector>

#include "loop/collision_world.hpp"
#include "loop/proxy_loop.hpp"

namespace tegotae {

/// The impulse method as a baseline of the programs, after Mirtich and Canny ("Impulse-based simulation of rigid
/// bodies", 1995) and Chang and Colgate ("Real-time impulse-based simulation of rigid body systems for haptic display",
/// 1997). The held part is a body with mass and inertia, drawn to the pen by the coupling. Contacts are handled one at
/// a time, the one that comes first first, by a frictionless impulse with restitution (Newton's rule); contact that
/// lasts is a row of micro-collisions, which leave no speed but what brings the gap back to the collision envelope.
/// Every motion in between goes through the same certificate as the other resolvers' motions, so that nothing
/// penetrates.
class ImpulseLoop final : public ProxyLoop {
 public:
  ImpulseLoop(const Scene& scene, const ContactSettings& settings, const MassProperties& mass);

  void step(const Pose& Y, double dt, std::int64_t deadline_ns, TickReport& report) override;
  bool take_over(const TickReport& last, const Pose& Y, const std::vector<bool>* fresh,
                 std::int64_t deadline_ns) override;
  const Pose& pose() const override { return X_; }
  const std::vector<Contact>& constraints() const override { return at_.contacts->constraints(); }
  const InitialContactReport& start() const override { return at_.start.report(); }

 private:
  struct Collision {
    int constraint = -1;  ///< number of the constraint, -1: none
    double time = 0;      ///< from now, s
    double approach = 0;  ///< how fast the contact closes, over what it should, m/s
  };
  enum class Advance : std::uint8_t { made, found, stuck };

  /// Coupling forces over `h` (s), implicit Euler: stable for any stiffness.
  void accelerate(const Pose& Y, const Twist& pen, double h);
  /// Moves on by `h` through the collisions on the way.
  void substep(double h, TickReport& report);
  /// The next collision within `time` (s).
  Collision next_collision(double time) const;
  void collide(const Collision& collision);
  /// Moves by V · time, or by as much of it as is free (then `time` is what was made). `found`, with `search` only: no
  /// motion, but constraints that were not known.
  Advance advance(bool search, double& time, TickReport& report);
  /// Speed at which the contact should open at least: zero, or what recovers its gap.
  double opening_speed(const Contact& c) const;
  double floor(const Contact& c) const;
  double speed(const Contact& c) const { return c.n.dot(V_.v + V_.w.cross(c.r)); }
  double size(const Displacement& d) const { return d.dp.norm() + at_.radius * d.dr.norm(); }
  bool late() const;
  void gather(const Pose& Y, double wanted, TickReport& report) const;

  ContactSettings settings_;
  CouplingSettings coupling_;
  MassProperties mass_;
  CollisionWorld at_;
  double envelope_;  ///< gap at which contacts collide, m
  double substep_cap_;
  Pose X_, last_Y_;
  Twist V_;              ///< of the center of mass
  Twist gained_;         ///< by the coupling in this sub-step
  double recovery_ = 0;  ///< speed by lost gap, 1/s
  Mat3 inverse_inertia_W_ = Mat3::Zero();
  std::vector<std::uint32_t> near_;
  std::vector<FacePair> blocking_;
  bool tracked_ = false;
  bool collided_ = false;  ///< in this tick
  bool stuck_ = false;     ///< likewise: it could not go on
  std::int64_t deadline_ns_ = 0;
};

}  // namespace tegotae
