#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How contacts are resolved. qp and lp solve a problem over all contacts at once; impulse and penalty are baselines to
/// compare with, loops of their own that solve none.
enum class ResolverKind : std::uint8_t {
  qp,       ///< least energy of the coupling's springs
  lp,       ///< the paper's linear program: least sum of contact forces
  impulse,  ///< collisions one at a time
  penalty   ///< springs in proportion to penetration; the only one that lets parts interpenetrate
};

/// Their names in scene files, recordings and on command lines: "qp", "lp", "impulse", "penalty".
const std::vector<std::string>& resolver_names();
/// The name of `kind`.
const std::string& to_string(ResolverKind kind);
/// The kind of that name. Throws Error for another name, with those that are known.
ResolverKind resolver_kind(const std::string& name);

}  // namespace tegotae
