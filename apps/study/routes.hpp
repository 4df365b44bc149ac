#pragma once

#include <string>
#include <vector>

#include "tegotae/loop/scene.hpp"
#include "tegotae/operator/operator.hpp"

namespace tegotae::study {

/// A path of the held part from its start to the goal: the tasks of an operator, one after the other.
struct Route {
  std::string name;  ///< "straight", "along -z", "along the part's x"
  std::vector<InsertionTask> legs;
  bool pulls = false;  ///< out of where the part is, instead of pushing it in
  Pose goal;           ///< X_WF at the end
};

/// The routes worth trying: the straight one, and in (out) along an axis of the world or of the part where nothing is
/// in the way at the sampled poses. The part goes in when its goal is nearer to the other parts than its start, else it
/// comes out. `center`: center of mass of the held part, file frame, m.
std::vector<Route> find_routes(const Scene& scene, const Pose& goal, const Vec3& center);

/// The routes straight out of all other parts, as far as `tegotae plan --out` goes: along the axes of the world or of
/// the part along which it meets least, the shortest first. Where all are blocked, the one with the least blocked
/// length. Throws Error when the part is out already.
std::vector<Route> find_routes_out(const Scene& scene, const Vec3& center);

}  // namespace tegotae::study
