#pragma once

#include <string>

#include "tegotae/core/export.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Sets the folder in which the library keeps large meshes as it has read them, and their hierarchies. A later start
/// need not read and build them again. An empty name (the default) disables the cache. Call it before starting threads
/// that load meshes or build loops. The library uses a cached file only when the file is whole and was made from the
/// same content, bit for bit, by the same method. Otherwise it reads the mesh file, or builds the hierarchy, again. The
/// cache takes at most 4 GB. A folder that cannot be written is not an error.
void set_hierarchy_cache(const std::string& folder);

/// Returns $XDG_CACHE_HOME/tegotae, or else ~/.cache/tegotae. Empty when neither is known.
std::string default_cache_folder();

}  // namespace tegotae
