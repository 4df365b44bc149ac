#pragma once

#include <memory>
#include <vector>

#include "broadphase/bounding_spheres.hpp"
#include "contact/contact_set.hpp"
#include "narrowphase/motion_check.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/sim/scene.hpp"

namespace tegotae {

/// No piece of a motion brings any triangles nearer than this gap (m). Collision libraries with a tolerance of 1 µm
/// (Coal's GJK) count nearer ones as touching, and a recording should be free for them too. A smaller gap at the start
/// may only grow.
inline constexpr double kGapFloor = 1.1e-6;

/// Feature pairs, and limits from them, that a tick can hold; more are counted as overflow.
inline constexpr int kMostLimits = 4096;

/// The held part and the fixed ones, in the order of their numbers.
struct SceneParts {
  const Part* held = nullptr;
  std::vector<const Part*> fixed;
  explicit SceneParts(const Scene& scene);
};

/// What every loop that never penetrates holds of its scene.
struct Surroundings {
  double radius;     ///< of the held part about its center of mass, m
  double clearance;  ///< gap that a motion must leave, m
  double reach;      ///< pairs of features farther apart are not followed, m
  BoundingSpheres spheres;
  std::unique_ptr<MotionCheck> check;
  std::unique_ptr<ContactSet> contacts;

  /// Throws Error when the start is not free.
  Surroundings(const Scene& scene, const ContactSettings& settings, const MassProperties& mass);
};

}  // namespace tegotae
