#pragma once

#include <array>
#include <cstdint>

#include "tegotae/core/contact_force.hpp"

namespace tegotae::view {

/// A nearest-feature pair of the held part A and a fixed part.
struct FramePair {
  double point[3];   ///< on A, world, m; the other point is `gap` away against `normal`
  double normal[3];  ///< from the fixed part to A, world
  double gap;        ///< m
  std::uint32_t part;
  std::uint32_t touching;
  std::uint32_t features;  ///< FeatureKind of the held part, and three times that of the fixed one
};

/// Pairs that a frame can hold. Contacts go first, and a free body rests on few of them.
inline constexpr std::size_t kMaxPairs = 128;

/// The force of a contact on the held part.
struct FrameForce {
  double point[3];     ///< m, world
  double normal[3];    ///< N, world: along the contact's normal
  double friction[3];  ///< N, world: across it
  double mu;           ///< coefficient of friction
  std::uint64_t slides;
};

/// What the page shows of one tick of the contact loop. Plain words, so that a ring can carry it.
struct Frame {
  /// `waiting`: what turned the force off is over, and it comes on again when it is small.
  enum Flag : std::uint32_t { touching = 1, cut = 2, overflow = 4, force_on = 8, waiting = 16 };
  static constexpr int kLagShift = 8;  ///< the bits from here on are the LagReason

  std::uint64_t tick = 0;
  double t = 0;              ///< s
  double x[7] = {};          ///< pose of the held part's file frame: p (m), q (w first)
  double y[7] = {};          ///< where the pen wants it
  double wrench[6] = {};     ///< on the pen, N, N·m, at the held part's center of mass
  double gap = 0;            ///< m, +inf: nothing is near
  double tick_us = 0;        ///< 0 in virtual time
  double servo_late_us = 0;  ///< NaN in virtual time
  std::uint32_t contacts = 0;
  std::uint32_t limits = 0;  ///< pairs there are, contacts included; `pair_count` of them are below
  std::uint32_t flags = 0;
  std::uint32_t reason = 0;      ///< ForceOff: why the force went off, never `engage`
  std::uint64_t generation = 0;  ///< of the parts that it is of
  std::uint64_t force_count = 0;
  std::array<FrameForce, ContactForces::kMax> forces;  ///< the first `force_count` hold
  std::uint64_t pair_count = 0;
  std::array<FramePair, kMaxPairs> pairs;  ///< what lies behind `pair_count` is not transported
};

void store(const Pose& pose, double (&out)[7]);
void store(const Wrench& wrench, double (&out)[6]);
void store(const ContactForces& forces, Frame& frame);

}  // namespace tegotae::view
