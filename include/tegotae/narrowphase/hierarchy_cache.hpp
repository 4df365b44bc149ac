#pragma once

#include <string>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Folder in which hierarchies of large meshes are kept, so that a later start need not build them; empty (the
/// default): nowhere. Call before threads that build loops start. A file in it is used only when it is whole and was
/// made for the same mesh, bit for bit, by the same way of building; otherwise the hierarchy is built anew. A folder
/// that cannot be written is no error.
void set_hierarchy_cache(const std::string& folder);

/// $XDG_CACHE_HOME/tegotae, else ~/.cache/tegotae; empty when neither is known.
std::string default_cache_folder();

}  // namespace tegotae
