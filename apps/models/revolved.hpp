#pragma once

#include <string>
#include <vector>

#include "tegotae/mesh/triangle_mesh.hpp"

/// Solids of revolution about z, lengths in m. Impossible sizes throw tegotae::Error.
namespace tegotae::shapes {

struct ProfilePoint {
  double r, z;
};

/// The solid inside `profile`, which runs counter-clockwise in the (r, z) half plane: from a point on the axis to
/// another one (its first and last bands are fans), or, where neither end is on the axis, round and back to its first
/// point. Corners lie on the circles of the profile's points.
TriangleMesh revolved(const std::string& name, const std::vector<ProfilePoint>& profile, int segments);

/// `n` + 1 points on the arc of radius `radius` about (r, z) from the angle `from` to `to` (rad, from the r axis).
std::vector<ProfilePoint> arc(double r, double z, double radius, double from, double to, int n);

/// A round block below z = 0 with a spherical cavity in its top face: the sphere's center is at z = `center`, above the
/// face or in it, so that the cavity's rim is its widest place.
struct Socket {
  double diameter = 0.04;  ///< of the sphere
  double center = 0.01;    ///< m
  double wall = 0.01;      ///< of material beside and below the cavity
  int segments = 64;       ///< around
  int rings = 16;          ///< of the cavity, from its pole to its rim
};
/// The cavity's corners lie on the sphere, so its facets stand into it by their sagittas.
TriangleMesh socket(const Socket& s);

}  // namespace tegotae::shapes
