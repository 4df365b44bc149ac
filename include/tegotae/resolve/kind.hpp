#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Method that resolves contacts. qp and lp solve a program over all contacts at once. impulse and penalty are
/// baselines for comparison; each is a loop of its own and solves no program.
enum class ResolverKind : std::uint8_t {
  qp,       ///< least energy of the coupling's springs
  lp,       ///< linear program of the paper (equations 5 to 7): least sum of contact forces
  impulse,  ///< collisions one at a time, by impulses (Mirtich and Canny, 1995)
  penalty   ///< springs in proportion to penetration (McNeely et al., 1999); the only one in which parts interpenetrate
};

/// Returns the names of the kinds in scene files, recordings and on command lines: "qp", "lp", "impulse", "penalty".
const std::vector<std::string>& resolver_names();
/// Returns the name of `kind`.
const std::string& to_string(ResolverKind kind);
/// Returns the kind of that name. Throws Error, which lists the known names, for an unknown name.
ResolverKind resolver_kind(const std::string& name);

}  // namespace tegotae
