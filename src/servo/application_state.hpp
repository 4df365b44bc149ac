#pragma once

#include "servo/pen_mapping.hpp"
#include "tegotae/coupling/contact_planes.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/device/shm.h"

namespace tegotae {

/// Whether what stands in the application's slot can be: finite, poses with unit quaternions, constants in their
/// ranges. Contact planes are judged by the local model, which does without bad ones.
bool valid(const tegotae_shm_application& in) noexcept;

CouplingSettings coupling_of(const tegotae_shm_application& in) noexcept;
MappingCommand mapping_of(const tegotae_shm_application& in) noexcept;
ProxyState proxy_of(const tegotae_shm_application& in) noexcept;
/// No planes when the count is more than there is room for.
ContactPlanes planes_of(const tegotae_shm_application& in) noexcept;

}  // namespace tegotae
