#pragma once

#include <functional>
#include <vector>

#include "tegotae/device/script.hpp"

namespace tegotae::bench {

/// How fast the pen goes: its file frame's origin (m/s) and its turning (rad/s).
struct PenSpeed {
  double linear;
  double angular;
  double pace;  ///< of a pen that follows the clock
};
inline constexpr PenSpeed kHandSpeed = {0.1, 0.5, 1};
inline constexpr PenSpeed kFastSpeed = {0.4, 4.0, 2};

/// A pen's way through poses, all of it at one speed: each leg takes as long as its slower part, moving or turning.
std::vector<StylusScript::Key> timed(const std::vector<Pose>& way, const PenSpeed& speed);

/// A pen that follows the clock: `pen` at hand speed for `seconds`.
std::vector<StylusScript::Key> timed(const std::function<Pose(double t)>& pen, double seconds, const PenSpeed& speed);

/// A round of a peg (tip at `tip` in its file frame, axis z) at a blind hole of `depth` (m) whose top is at z = 0 and
/// whose axis is z: approach, rim, tilted entry, two-sided jams on the way down, a turn, bottom, rocking at the bottom,
/// and out again. `azimuth` (rad) turns all of it about z.
void add_peg_round(const Vec3& tip, double depth, double azimuth, std::vector<Pose>& way);

/// A round of a knot above an equal knot at the world's origin: down onto it, turning, dragging, tilting.
/// Starts and ends `height` (m) over it.
void add_knot_round(double height, double azimuth, std::vector<Pose>& way);

/// A round of a rod (axis z) that starts at `start` between the columns of a grid of parts with the given `pitch` (m):
/// against a column, along it, tilted until it jams between two parts, turned there, and back.
void add_grid_round(const Vec3& start, double pitch, double azimuth, std::vector<Pose>& way);

/// A round of a part that comes straight down on its seat, its file frame to `seat` (m, not turned) from `above` over
/// it to `below` under it, is dragged by `slide` (m), turned a little, and lifted; six times, each time dragged to
/// another side.
void add_seat_round(const Vec3& seat, double above, double below, double slide, double azimuth, std::vector<Pose>& way);

}  // namespace tegotae::bench
