#pragma once

#include <vector>

#include "tegotae/coupling/coupling.hpp"

namespace tegotae {

/// What a PathGuide needs to know of the pen and the part that it guides.
struct PathGuideSettings {
  CouplingSettings coupling;   ///< as in use, nothing left open
  double scale = 1;            ///< meters of the world for a meter of the pen
  Vec3 center = Vec3::Zero();  ///< of mass of the held part, m, file frame
  double force = 0;            ///< N, the most that it pulls with
};

/// A guiding virtual fixture: a gentle pull on the hand along a path of the held part. It pulls along the path where
/// that is nearest to the pen, and beside the path also back to it, kSoft off as much as along; together with a
/// constant force. In the last kSoft it is a spring to the end. From half of kReach off the path on it fades, and
/// beyond kReach there is none. Where the hand comes back the pull comes back over kReturn.
///
/// Ways and turns are one length, as for the coupling: way of the center of mass and turn times √(k_t / k), both as the
/// hand goes them (without the scale). So force and torque together, the torque divided by that radius, are never more
/// than `force`. It follows the nearest point from tick to tick: a screw's path comes by the same pose again and again.
///
/// It is active: it gives the hand up to `force` times the length of the path each time that the hand goes along it,
/// and is not a gradient of an energy. Allocates only when it is made.
class PathGuide {
 public:
  static constexpr double kForce = 1.0;   ///< N, what it pulls with where device and weight allow it
  static constexpr double kSoft = 8e-3;   ///< m of the hand
  static constexpr double kReach = 0.02;  ///< m of the hand
  static constexpr double kReturn = 0.3;  ///< s

  /// `path`: poses X_WF of the held part's file frame, at least one. Throws Error when there is none.
  PathGuide(const std::vector<Pose>& path, const PathGuideSettings& settings);

  /// The wrench on the pen at `Y`, at the held part's center of mass (world, N, N·m), `dt` seconds after the last one.
  Wrench pull(const Pose& Y, double dt) noexcept;

  double distance() const noexcept { return distance_; }           ///< m of the hand: of the last Y from the path
  double along() const noexcept { return nearest_.along; }         ///< m of the hand: of the path, up to that place
  double length() const noexcept { return segments_.back().end; }  ///< m of the hand: of the path
  double force() const noexcept { return settings_.force; }        ///< N, the most
  double torque() const noexcept { return settings_.force * radius_; }  ///< N·m, the most

 private:
  /// Of the path, between two of its poses.
  struct Segment {
    Pose from;
    Displacement step;
    double begin, end;  ///< m of the hand, along the path
  };
  struct Place {
    std::size_t segment = 0;
    double along = 0;
    double distance = 0;
  };
  Vec6 whiten(const Displacement& d) const noexcept;
  Place place_on(std::size_t segment, const Pose& Y) const noexcept;
  /// The nearest place among `count` segments from `first` on, if it is nearer than `best`.
  void search(std::size_t first, std::size_t count, const Pose& Y, Place& best) const noexcept;
  void follow(const Pose& Y) noexcept;
  Pose at(double along) const noexcept;

  PathGuideSettings settings_;
  double radius_;  ///< m, of the torque
  std::vector<Segment> segments_;
  Place nearest_;
  double distance_;
  std::size_t sweep_ = 0;  ///< where a hand that was lost is looked for next
  double strength_ = 1;    ///< 0 to 1
};

}  // namespace tegotae
