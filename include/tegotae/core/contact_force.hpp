#pragma once

#include <array>

#include "tegotae/core/export.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// The force of one contact on the held part A, at `point`: `force` along `n`, and `friction` across it.
struct ContactForce {
  PartId part;                   ///< the fixed part B
  Vec3 point = Vec3::Zero();     ///< of A, m, world
  Vec3 n = Vec3::Zero();         ///< n_BA_W: unit normal from B to A, world
  double gap = 0;                ///< m
  double force = 0;              ///< N, positive
  Feature feature_a = {};        ///< of A's mesh; not in recordings
  Feature feature_b = {};        ///< of B's mesh; not in recordings
  Vec3 friction = Vec3::Zero();  ///< N, perpendicular to `n`, world; at most mu × force long
  double mu = 0;                 ///< coefficient of friction of the two parts
  bool slides = false;           ///< the point has slid in this tick; otherwise it sticks, or there is no friction
};

/// The contacts that carry force: no more than six are needed to hold a rigid body, however many touch. So of a face
/// that lies flat some corners carry all; their sum is what counts. Each stays within its own cone of friction.
struct ContactForces {
  static constexpr int kMax = 6;         ///< degrees of freedom of a free body
  std::array<ContactForce, kMax> items;  ///< the first `count` of them hold
  int count = 0;                         ///< 0: nothing carries, or the forces are not available
  bool available = false;                ///< that they are known; not in recordings
  /// What the coupling's springs pull beyond the contacts' forces because the part is not yet where it is going: out of
  /// time, held to a length a tick, or opening a gap. Zero at rest. At the held part's center of mass, world.
  Wrench lag;

  /// Force, and moment about `center_W` (m, world), of all contacts; with the arms divided by `scale` (see
  /// Scene::scale).
  Wrench sum(const Vec3& center_W, double scale = 1) const noexcept {
    Wrench w;
    for (int i = 0; i < count; ++i) {
      const ContactForce& c = items[static_cast<std::size_t>(i)];
      const Vec3 f = c.force * c.n + c.friction;
      w.force += f;
      w.torque += (c.point - center_W).cross(f) / scale;
    }
    return w;
  }
};

}  // namespace tegotae
