#pragma once

#include <cstdint>
#include <optional>

#include "tegotae/core/export.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Place where the held part A touches a fixed part B: the gap of their surfaces there is at most
/// TickReport::contact_gap, or the place carries force. Part and features identify the contact from tick to tick.
struct ContactPoint {
  PartId part;                   ///< B
  Feature feature_a;             ///< nearest feature of A's mesh
  Feature feature_b;             ///< nearest feature of B's mesh
  Vec3 point_a = Vec3::Zero();   ///< on A, m, world
  Vec3 point_b = Vec3::Zero();   ///< on B, m, world
  Vec3 normal = Vec3::Zero();    ///< n_BA_W: unit normal from B to A, world
  double gap = 0;                ///< m; negative where the resolver "penalty" lets A into B
  std::optional<double> force;   ///< N, on A along `normal`, 0 or positive; none: not available (TickReport::forces)
  Vec3 friction = Vec3::Zero();  ///< N, on A across `normal`, world
  bool slides = false;           ///< there is friction, and A's point slid in the tick
  std::int64_t ticks = 0;        ///< number of earlier ticks for which the contact has lasted; 0: it has just begun
};

/// A contact that began or ended in the last tick. When the scene changes, contacts end without an event, because their
/// part belongs to a scene that is gone.
struct ContactEvent {
  /// What happened.
  enum class Kind : std::uint8_t { began, ended };

  Kind kind = Kind::began;  ///< what happened
  ContactPoint contact;     ///< its present state; of one that ended, its state in the tick before
};

}  // namespace tegotae
