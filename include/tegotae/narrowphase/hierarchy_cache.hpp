#pragma once

#include <string>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Sets the folder in which the library keeps the hierarchies of large meshes, so that a later start need not build
/// them. An empty name (the default) disables the cache. Call it before starting threads that build loops. The library
/// uses a file of the cache only when it is whole and was made for the same mesh, bit for bit, by the same method of
/// building; otherwise it builds the hierarchy again. A folder that cannot be written is no error.
void set_hierarchy_cache(const std::string& folder);

/// Returns $XDG_CACHE_HOME/tegotae, else ~/.cache/tegotae; empty when neither is known.
std::string default_cache_folder();

}  // namespace tegotae
