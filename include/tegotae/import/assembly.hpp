#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/mesh/color.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// A leaf of an assembly: one placed instance of a shape.
struct AssemblyPart {
  std::string name;               ///< UTF-8; unique in the assembly
  std::vector<std::string> path;  ///< the groups that it is in, the outermost first
  std::size_t shape = 0;          ///< index into Assembly::shapes
  Pose pose;                      ///< X_WF of the shape's frame
  std::optional<Color> color;     ///< as the file has it; none: it has none
};

/// What a file of parts holds.
struct Assembly {
  std::vector<std::shared_ptr<const TriangleMesh>> shapes;  ///< distinct; named for people, welded, m, own frame
  std::vector<AssemblyPart> parts;                          ///< leaves of the tree, in the order of the file
  std::string unit;                ///< of the file, or the one its lengths were read in: "m", "mm", ...
  std::vector<std::string> notes;  ///< what is not as the file says, a line each
};

/// How a file becomes an assembly.
struct AssemblyOptions {
  /// Unit of the lengths of a file that does not say it (STL, OBJ, PLY, OFF), or that says m and is wrong (glTF).
  /// None: m, and a file that is more than 20 m across is refused, for it is most often in mm.
  std::optional<std::string> unit;
  double chord = 5e-6;          ///< m: how far a facet of a STEP file's mating face may be from the face
  double coarse_chord = 50e-6;  ///< m: the same for other curved faces; less in a small part that is alone in its file
  bool split = false;           ///< every connected piece of a surface is a part
  /// Called now and then: what is done, and how many of how many are done (of 0: not known).
  std::function<void(const char* what, std::size_t done, std::size_t total)> progress;
};

/// Reads glTF/GLB, 3MF and STEP (AP203, AP214, AP242) with their tree, or STL, OBJ, PLY and OFF as one part.
///
/// Every leaf of the tree is a part; instances share a shape, placed by a rotation and a translation (a scale or a
/// mirroring is in the shape). A shape that lies farther from its origin than it is large gets an origin at the middle
/// of its box, so that files of floats keep its digits. A STEP file's round holes are tessellated from outside and its
/// round shafts from inside, so that no facet reaches into a clearance between them.
///
/// Throws Error with the file and the reason when it cannot be used: also for STEP when the library was built without
/// OpenCASCADE (see reads_step), and for a unit that is given for STEP or 3MF, which say theirs.
Assembly read_assembly(const std::string& path, const AssemblyOptions& options = {});

/// Whether the library was built with OpenCASCADE.
bool reads_step();

}  // namespace tegotae
