#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Bounds of a load in a separate process.
struct IsolatedLoad {
  /// Loading program, which is installed with the library. The library searches a name without a slash in the folder of
  /// the running program, then in PATH.
  std::string helper = "tegotae-load-mesh";
  double seconds = 60;      ///< time after which the helper is killed, s
  double megabytes = 4096;  ///< address space of the helper, MB
};

/// Does what load_mesh (see load.hpp) does, for files of unknown origin. Another process parses the file. Its time and
/// memory are bounded, and it can write nothing but the mesh. A damaged file that crashes the parser ends only that
/// process. The library checks the returned mesh as it checks a file. The call starts a program (posix_spawn), which is
/// safe when other threads run, and waits for it. The mesh of a file whose content was read before comes from the cache
/// (set_hierarchy_cache()), without a process.
///
/// Throws Error (kind file) as load_mesh does, and when the helper is missing, is killed by a signal, or exceeds a
/// bound.
TriangleMesh load_mesh_isolated(const std::string& path, double unit_in_m = 1.0, const IsolatedLoad& bounds = {});

}  // namespace tegotae
