#pragma once

#include <memory>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/lp/friction_problem.hpp"
#include "tegotae/lp/low_rank_matrix.hpp"
#include "tegotae/resolve/kind.hpp"
#include "tegotae/resolve/status.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// A resolver's answer.
struct Resolution {
  Vec6 motion = Vec6::Zero();                     ///< in whitened coordinates; zero unless solved
  ResolveStatus status = ResolveStatus::stalled;  ///< how it ended
  int iterations = 0;                             ///< pivots, for TickReport::iterations
  /// With friction, if the resolver knows them: the forces behind the motion, in its memory until the next call. They
  /// spare the loop a program of its own.
  const std::vector<FrictionForce>* forces = nullptr;
};

/// Turns a wanted motion of the held part into one that the limits allow. Motions are in whitened coordinates, m: the
/// displacement of the center of mass, then the rotation vector in the part's axes times coupling_radius(), so that the
/// squared length is the springs' energy by half their stiffness ("lp": rotations about the axes of inertia times the
/// radii of gyration). The answer is a proposal: the loop commits it only when its whole way is free.
///
/// One of your own (ContactSettings::custom_resolver) must not allocate, wait or throw in resolve().
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// A motion z with rows z >= bounds (rows.rows() of them, m), as near to `wanted` as the method brings it. Bounds are
  /// at most 0, so that standing still is allowed, or a little above where gaps should open.
  virtual Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept = 0;
  /// Whether the answer is the allowed motion nearest to the wanted one: then there are contact forces, and planes for
  /// the servo. If not, it may be no motion at all although some would lead nearer.
  virtual bool projects() const = 0;

  /// Whether resolve_with_friction() knows friction. One that does not is never asked with it, and whatever the scene
  /// says, parts slide without.
  virtual bool knows_friction() const { return false; }
  /// The motion that Coulomb's law gives for `problem.wanted`; z >= problem.bounds as in resolve(), without gaps that
  /// should open.
  virtual Resolution resolve_with_friction(const FrictionProblem& problem) noexcept {
    return resolve(problem.normals, problem.bounds, problem.wanted);
  }
};

/// Makes the resolver of `kind`, ResolverKind::qp or ResolverKind::lp, for at most `capacity` rows. Throws Error for
/// the others, which are loops of their own and make no resolver.
std::unique_ptr<Resolver> make_resolver(ResolverKind kind, int capacity);

}  // namespace tegotae
