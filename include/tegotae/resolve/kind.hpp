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
  lp,       ///< the paper's linear program: least sum of contact forces
  impulse,  ///< collisions one at a time
  penalty   ///< springs in proportion to penetration; the only one in which parts interpenetrate
};

/// Returns the names of the kinds in scene files, recordings and on command lines: "qp", "lp", "impulse", "penalty".
const std::vector<std::string>& resolver_names();
/// Returns the name of `kind`.
const std::string& to_string(ResolverKind kind);
/// Returns the kind of that name. For an unknown name it throws Error, which lists the known ones.
ResolverKind resolver_kind(const std::string& name);

}  // namespace tegotae
