#pragma once

#include <string>

#include "tegotae/core/export.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Bounds of a load in a process of its own.
struct IsolatedLoad {
  /// The program that loads, installed with the library. A name without a slash is looked for beside the running
  /// program, then in PATH.
  std::string helper = "tegotae-load-mesh";
  double seconds = 60;      ///< the helper is killed after this time
  double megabytes = 4096;  ///< address space of the helper, MB
};

/// load_mesh (see load.hpp) for files that nobody vouches for: the file is parsed in another process, bounded in time
/// and memory, that can write nothing but the mesh. What a damaged file does to the parser ends that process alone.
/// What comes back is checked like a file. Starts a program (posix_spawn), so it is safe beside other threads; waits
/// for it.
///
/// Throws Error as load_mesh does, and when the helper is missing, is killed by a signal, or exceeds a bound.
TriangleMesh load_mesh_isolated(const std::string& path, double unit_in_m = 1.0, const IsolatedLoad& bounds = {});

}  // namespace tegotae
