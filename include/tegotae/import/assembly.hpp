#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tegotae/core/export.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/core/up_axis.hpp"
#include "tegotae/mesh/color.hpp"
#include "tegotae/mesh/triangle_mesh.hpp"

namespace tegotae TEGOTAE_EXPORT {

/// Leaf of an assembly: one placed instance of a shape.
struct AssemblyPart {
  std::string name;               ///< UTF-8; unique in the assembly
  std::vector<std::string> path;  ///< groups that contain it, the outermost first
  std::size_t shape = 0;          ///< index into Assembly::shapes
  Pose pose;                      ///< X_WF of the shape's frame
  std::optional<Color> color;     ///< color in the file; none: the file gives none
};

/// Contents of a file of parts.
struct Assembly {
  /// Distinct surfaces, each welded, in its own frame, in m. Their names are for people.
  std::vector<std::shared_ptr<const TriangleMesh>> shapes;
  std::vector<AssemblyPart> parts;  ///< leaves of the tree, in the order of the file
  std::string unit;                 ///< unit of the file, or the one in which its lengths were read: "m", "mm", ...
  UpAxis up = UpAxis::z;            ///< y for glTF, whose format says so; z where no format does
  std::vector<std::string> notes;   ///< deviations of the assembly from its file, one line each
};

/// Options of read_assembly().
struct AssemblyOptions {
  /// Unit ("m", "cm", "mm", "um" or "in") of a file that does not state its own (STL, OBJ, PLY, OFF), or that states m
  /// wrongly (glTF). None: m; then a file more than 20 m across is refused, because it is most often in mm.
  std::optional<std::string> unit;
  double chord = 5e-6;          ///< m: largest distance of a facet from its face, for mating faces of a STEP file
  double coarse_chord = 50e-6;  ///< m: the same for other curved faces; a part alone in its file has less, by its size
  bool split = false;           ///< true: makes a part of every connected component of a surface
  /// Called now and then with the present step, and how much of it is done, of how much (0: not known). Empty: no
  /// calls.
  std::function<void(const char* what, std::size_t done, std::size_t total)> progress;
};

/// Reads glTF/GLB, 3MF and STEP (AP203, AP214, AP242) with their tree, or STL, OBJ, PLY and OFF as one part.
///
/// Every leaf of the tree is a part. Instances share a shape; a rotation and a translation place each of them. A scale
/// or a mirroring is in the shape. A shape that lies farther from its origin than it is large gets an origin at the
/// center of its box, so that single-precision files keep its digits. The reader tessellates the round holes of a STEP
/// file from outside and its round shafts from inside, so that no facet reaches into a clearance between them.
///
/// Throws Error (kind file) with the file and the reason when the file cannot be used. This includes a STEP file when
/// the library was built without OpenCASCADE (see reads_step), and a unit given for STEP or 3MF, which state their own.
/// A chord that is not a positive length throws Error (kind other).
Assembly read_assembly(const std::string& path, const AssemblyOptions& options = {});

/// Returns whether the library was built with OpenCASCADE, which reads STEP.
bool reads_step();

}  // namespace tegotae
