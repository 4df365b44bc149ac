#pragma once

#include <cstdint>
#include <string>

#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae {

/// What a loading process sends back: this head, then `text_bytes` of text (the mesh's name or the error), then
/// `note_bytes` of notes (each ends with a line feed), then the vertices (3 doubles each) and the triangles (3 indices
/// of 32 bits each), in the machine's byte order.
struct MeshPipeHead {
  static constexpr std::uint64_t kMagic = 0x3248534D47455431;  // tells a helper of another version
  std::uint64_t magic = kMagic;
  std::uint64_t failed = 0;  ///< 1: the text is an error, and nothing follows
  std::uint64_t text_bytes = 0;
  std::uint64_t note_bytes = 0;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
};

/// The descriptor that a helper writes to.
inline constexpr int kMeshPipe = 3;

/// Number of the helper's arguments: `NAME UNIT_IN_M MEGABYTES SECONDS PATH`.
inline constexpr int kMeshHelperArguments = 5;

/// main() of the helper, called with kMeshHelperArguments. Bounds itself, loads PATH and writes it to kMeshPipe.
int run_mesh_helper(char** argv);

}  // namespace tegotae
