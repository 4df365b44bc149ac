#pragma once

#include <cstdint>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// How the resolver's program of a tick ended.
enum class ResolveStatus : std::uint8_t {
  not_needed,  ///< no constraint restricted the motion
  solved,      ///< within the solver's tolerances
  infeasible,  ///< no motion keeps all gaps; the part stays
  stalled      ///< the solver gave up for numerical reasons; the part stays
};

}  // namespace tegotae
