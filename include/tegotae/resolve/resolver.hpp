#pragma once

#include <memory>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/lp/friction_problem.hpp"
#include "tegotae/lp/low_rank_matrix.hpp"
#include "tegotae/resolve/kind.hpp"
#include "tegotae/resolve/status.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Result of a resolver.
struct Resolution {
  Vec6 motion = Vec6::Zero();                     ///< in whitened coordinates (see Resolver), m; zero unless solved
  ResolveStatus status = ResolveStatus::stalled;  ///< how it ended
  int iterations = 0;                             ///< pivots, for TickReport::iterations
  /// Contact forces behind the motion, where there is friction and the resolver knows them; otherwise null. They stay
  /// in the resolver's memory until its next call. With them the loop need not solve a program of its own.
  const std::vector<FrictionForce>* forces = nullptr;
};

/// Turns a wanted motion of the held part into one that the constraints allow. The loop commits this proposal only when
/// its whole path is free.
///
/// Motions are in whitened coordinates, m: the displacement of the center of mass, then the rotation vector in the
/// part's axes times coupling_radius(). So the squared length of a motion is the springs' energy divided by half their
/// stiffness. For "lp" the rotations are about the axes of inertia, times the radii of gyration.
///
/// A custom resolver (ContactSettings::custom_resolver) must not allocate, wait or throw in resolve().
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// Returns a motion z with rows z >= bounds (rows.rows() of them, m), as near to `wanted` as the method brings it.
  /// Bounds are at most 0, so that rest is allowed, or slightly above 0 where gaps should open.
  virtual Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept = 0;
  /// Returns whether the result is the allowed motion nearest to the wanted one. If so, the loop has contact forces,
  /// and planes for the servo. If not, the result may be no motion at all although some motion would lead nearer.
  virtual bool projects() const = 0;

  /// Returns whether resolve_with_friction() knows friction. If not, the loop never calls that function, and parts
  /// slide without friction, whatever the scene says.
  virtual bool knows_friction() const { return false; }
  /// Returns the motion that Coulomb's law gives for `problem.wanted`. It keeps z >= problem.bounds as resolve() does,
  /// but no bound asks a gap to open.
  virtual Resolution resolve_with_friction(const FrictionProblem& problem) noexcept {
    return resolve(problem.normals, problem.bounds, problem.wanted);
  }
};

/// Makes the resolver of `kind`, ResolverKind::qp or ResolverKind::lp, for at most `capacity` rows. Throws Error for
/// the other kinds: they are loops of their own and have no resolver.
std::unique_ptr<Resolver> make_resolver(ResolverKind kind, int capacity);

}  // namespace tegotae
