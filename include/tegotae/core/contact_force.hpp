#pragma once

#include <array>

#include "tegotae/core/export.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Force of one contact on the held part A. It acts at `point`: `force` along `n`, `friction` across it.
struct ContactForce {
  PartId part;                   ///< the fixed part B
  Vec3 point = Vec3::Zero();     ///< on A, m, world
  Vec3 n = Vec3::Zero();         ///< n_BA_W: unit normal from B to A, world
  double gap = 0;                ///< m
  double force = 0;              ///< N, positive
  Feature feature_a = {};        ///< of A's mesh; not in recordings
  Feature feature_b = {};        ///< of B's mesh; not in recordings
  Vec3 friction = Vec3::Zero();  ///< N, perpendicular to `n`, world; at most mu × force long
  double mu = 0;        ///< coefficient of friction of the two parts; 0 for a one-shot constraint (kOneShotAge)
  bool slides = false;  ///< the point slid in this tick; false: it sticks, or there is no friction
};

/// Contacts that carry force. Six are enough to hold a rigid body, so at most six carry force, however many touch.
/// Where a face lies flat, a few of its corners carry everything, and only the sum is meaningful. Each force stays
/// within its own friction cone.
struct ContactForces {
  static constexpr int kMax = 6;         ///< degrees of freedom of a free body
  std::array<ContactForce, kMax> items;  ///< the first `count` of them are valid
  int count = 0;                         ///< 0: no contact carries force, or the forces are not available
  bool available = false;                ///< whether the forces are known; not in recordings
  /// Part of the springs' wrench that the contact forces do not balance, because the held part has not arrived yet: the
  /// tick ran out of time, the bound on a tick's motion applied, or a gap is opening. Zero at rest. At the held part's
  /// center of mass, world.
  Wrench lag;

  /// Returns the total force of all contacts (N) and its moment (N·m) about `center_W` (m, world). The moment arms are
  /// divided by `scale` (see Scene::scale), because the hand feels torques in the pen's lengths.
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
