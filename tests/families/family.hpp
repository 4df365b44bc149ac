// Families of parts that mate over an area, each made from a few numbers.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"

namespace tegotae::test {

/// What a case is made from: the same numbers give the same case.
struct FamilyParameters {
  std::string family;
  unsigned seed = 1;
  int triangles = 2000;  ///< of each side, about
  double clearance = 0;  ///< m, at most 2 % of the size
  double size = 0.1;     ///< largest extent of the held part, m
  int near = 1;          ///< fixed parts; families of one fixed part have one whatever this says
};

/// A held part, what is fixed, the line on which the pen brings the two together, and what is known of the seat.
struct FamilyCase {
  FamilyParameters parameters;
  Scene scene;          ///< the held part `start` before `seat`
  Pose seat;            ///< of the held part's file frame: where it is nominally seated
  Vec3 approach;        ///< unit vector, world: the pen comes along it, turned as `seat`
  double start = 0;     ///< m before the seat
  double press = 0;     ///< m beyond it
  Vec3 slide;           ///< how far the pen goes aside when it presses, m, world
  double turn = 0;      ///< rad: how far it then turns about `approach`
  double tilt = 0;      ///< rad: and about an axis across it
  double sagitta = 0;   ///< m along `approach`: by how much facets may stand off their curved surfaces, both sides' sum
  double gain = 1;      ///< m along `approach` for a meter of gap, where that is most
  bool guided = false;  ///< closely, on the whole line, by solids
  /// m beyond `seat` along `approach`: where it first touches, if that is exact and FCL would take too long to tell.
  std::optional<double> touch;
  bool flat = false;  ///< the seat is a plane across `approach` (or along `slide`): it holds while the part slides
  /// Closed form of where the part rests, m beyond `seat` along `approach`, for smooth surfaces without a gap.
  struct Range {
    double low, high;
  };
  std::optional<Range> rest;
  /// The deepest place where the part may rest, m beyond `seat`: facets stand off their surfaces.
  double deepest() const { return (rest ? std::max(rest->high, 0.0) : 0.0) + 4 * sagitta; }
};

/// All names.
std::vector<std::string> family_names();

/// Throws Error for an unknown family.
FamilyCase make_family(const FamilyParameters& parameters);

}  // namespace tegotae::test
