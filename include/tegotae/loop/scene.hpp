#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/ids.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/mesh/color.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"
#include "tegotae/resolve/resolver.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// One rigid part. Parts may share a mesh.
struct Part {
  std::string name;                          ///< unique in the scene
  std::shared_ptr<const TriangleMesh> mesh;  ///< welded (load_mesh does it), file frame, m
  Pose pose;                           ///< X_WF of the file frame in the world; for the held part, where it starts
  bool held = false;                   ///< exactly one part of a scene is held
  std::vector<std::string> path = {};  ///< groups of the assembly that contain it, the outermost first
  std::optional<Color> color = {};     ///< display color
  /// Mass (kg) for the weight that the hand feels while the part is held. Not set: from volume and
  /// ContactSettings::density.
  std::optional<double> mass = {};
};

/// Settings of the resolver "impulse".
struct ImpulseSettings {
  double restitution = 0.3;   ///< speed after an impact divided by the speed before, 0 to 1
  double micro_speed = 0.01;  ///< m/s; slower approaches, beyond what the coupling adds in a sub-step, do not rebound
  double substep = 2.5e-4;    ///< s, longest sub-step
};

/// Settings of the resolver "penalty".
struct PenaltySettings {
  double stiffness = 2000.0;  ///< N/m, of each penetrating vertex
  double damping = 2.0;       ///< N·s/m, of each penetrating vertex along its normal
};

/// Method that decides whether a motion is free.
enum class NarrowPhase : std::uint8_t {
  patch,  ///< certified sweeps
  fcl     ///< FCL at the end of short sub-steps, the method of the paper
};

/// Treatment of a fixed part that the held one overlaps at the start by more than ContactSettings::touch_tolerance.
enum class InitialOverlap : std::uint8_t {
  refuse,  ///< the loop throws Error
  ignore   ///< the pair is filtered (nothing keeps the two apart) until it has once separated
};

/// Settings of the contact loop. HapticLoop::contact() returns what the loop chose for values that are not set here.
struct ContactSettings {
  /// A pair with a gap (m) below this is a contact, and the loop keeps half of it. Set it to at most half the radial
  /// clearance of the closest fit. Not set: the loop adapts it (4 to 20 µm) to the clearance that it finds.
  std::optional<double> l_min = {};
  std::optional<double> l_0 = {};            ///< back-off length (m) after an intersection; not set: from l_min
  ResolverKind resolver = ResolverKind::qp;  ///< method that resolves contacts
  /// Makes a custom resolver for at most `capacity` constraints, which replaces `resolver`; empty: none.
  std::function<std::unique_ptr<Resolver>(int capacity)> custom_resolver = {};
  NarrowPhase narrowphase = NarrowPhase::patch;  ///< decides whether a motion is free
  /// Time (s) that a tick of HapticLoop::step may take; the next tick does what remains. Infinite: only the amount of
  /// work bounds a tick, so that the same pen gives the same motion bit for bit on any machine.
  double tick_budget = 0.8e-3;
  static constexpr int kMostHelpers = 64;  ///< bound of helper_threads
  /// Threads (0 to kMostHelpers) that share the work of proving motions where thousands of the held part's triangles
  /// lie on other parts. Otherwise they sleep, and where `tick_budget` is infinite there are none. They run at the
  /// priority of ordinary programs. Not set: one fewer than the processors that the process may use, at most 7.
  std::optional<int> helper_threads = {};
  double touch_tolerance = 10e-6;  ///< m: parts with a gap or an overlap of up to this at the start touch
  InitialOverlap initial_overlap = InitialOverlap::refuse;  ///< treatment of deeper overlaps at the start
  /// Density of the held part, kg/m³. It gives the mass for the weight and for "impulse"; for "lp" only the
  /// distribution of mass matters.
  double density = 1000.0;
  ImpulseSettings impulse;  ///< for ResolverKind::impulse only
  PenaltySettings penalty;  ///< for ResolverKind::penalty only
};

/// Coulomb friction of one pair of parts, whichever of them is held.
struct PairFriction {
  std::string a;  ///< name of a part; a pair with a name that is not in the scene has no effect
  std::string b;  ///< name of the other part
  double mu = 0;  ///< coefficient, sticking and sliding alike, 0 to 10
};

/// Coulomb friction between the held part and the others (resolver "qp"). While no contact has friction, the result is
/// the same as without it.
struct FrictionSettings {
  double mu = 0;                         ///< coefficient of pairs that are not named, 0 to 10
  std::vector<PairFriction> pairs = {};  ///< pairs with a coefficient of their own; the last entry of a pair counts
};

/// Weight of the held part in the hand (resolver "qp"). The part still has no inertia.
struct WeightSettings {
  bool on = false;                  ///< the hand feels it
  Vec3 gravity = {0, 0, -9.80665};  ///< m/s², world
  /// N, the largest weight that the hand carries, so that the device does not get too warm. A heavier part weighs this
  /// much. Not set: unbounded.
  std::optional<double> max_force = {};
};

/// Parts of a mock-up, and the settings of its loops.
struct Scene {
  /// Adds a fixed part at `pose` (X_WF), and returns its id. `name` must be unique; `mesh` is as Part::mesh.
  PartId add_fixed(std::string name, TriangleMesh mesh, const Pose& pose = {}) {
    return add(std::move(name), std::move(mesh), pose, false);
  }
  /// Adds the part that the pen holds, and returns its id. It starts at `pose` (X_WF). `name` must be unique; `mesh` is
  /// as Part::mesh.
  PartId add_held(std::string name, TriangleMesh mesh, const Pose& pose = {}) {
    return add(std::move(name), std::move(mesh), pose, true);
  }

  std::vector<Part> parts;    ///< exactly one of them held
  ContactSettings contact;    ///< of the contact loop
  CouplingSettings coupling;  ///< of the spring and damper between part and pen
  /// N·m/rad. When it is set, the loop fits coupling.torsional_stiffness to the held part, up to this value: see
  /// fitted_torsional_stiffness() and HapticLoop::coupling().
  std::optional<double> max_torsional_stiffness = {};
  /// Meters that the held part moves for a meter of the pen, 0.01 to 100; pass the same to ContactLink::set_scale().
  /// The law by which the part follows the pen depends on it, because the hand feels the springs in the pen's lengths.
  double scale = 1;
  FrictionSettings friction = {};  ///< between the held part and the others
  WeightSettings weight = {};      ///< of the held part

 private:
  PartId add(std::string name, TriangleMesh mesh, const Pose& pose, bool held) {
    parts.push_back({std::move(name), std::make_shared<const TriangleMesh>(std::move(mesh)), pose, held});
    return {static_cast<std::uint32_t>(parts.size() - 1)};
  }
};

}  // namespace tegotae
