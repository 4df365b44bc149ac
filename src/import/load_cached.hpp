#pragma once

#include <functional>
#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// What `read` makes of the mesh file `path` in units of `unit_in_m`; or what it made of the same content before, out
/// of the cache, without reading it as a mesh. The cache is off until set_hierarchy_cache(). Files that name others are
/// always read, and so is what was refused.
TriangleMesh load_cached(const std::string& path, double unit_in_m, const std::function<TriangleMesh()>& read);

}  // namespace tegotae
