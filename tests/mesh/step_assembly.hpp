// An assembly written as STEP with OpenCASCADE: what it holds is known in closed form.
#pragma once

#include <string>

namespace tegotae::test {

/// Sizes in mm: fits of 20 mm H7/g6 (hole +0..+21 µm, shaft -7..-20 µm) and of 6 mm H7/g6 (hole +0..+12 µm, dowel
/// -4..-12 µm), at the tightest.
struct StepSizes {
  double plate_x = 110, plate_y = 60, plate_z = 15;
  double bore = 26;              ///< of the plate, for the bushings
  double bushing_outer = 25.98;  ///< with a clearance, so that everything starts free
  double bushing_inner = 20.0;   ///< H7 at its least
  double bushing_length = 15;
  double shaft = 19.993;  ///< g6 at its most
  double shaft_length = 60;
  double window = 31;  ///< of the cover, around bushing and shaft
  double dowel_hole = 6.0, dowel = 5.996, dowel_length = 14;
  double chamfer_length = 2, chamfer_depth = 0.5;  ///< of the dowels' upper ends, along and across
  double cover_z = 5;
  double bore_at = 20;  ///< x of the two bores, on both sides of the middle
  double dowel_at = 42;
};

/// Writes: group "Träger" (turned and moved) with "Grundplatte" (blue) and two instances of "Buchse" (red); at the top
/// level a "Welle" in the first bushing (no color), and a group "Deckel" with "Blech" (green) and two dowels "Stift".
/// `unit` is OpenCASCADE's name: "MM", "M", "INCH"; `schema` "AP203", "AP214IS", "AP242DIS".
void write_step_assembly(const std::string& path, const StepSizes& sizes, const std::string& unit,
                         const std::string& schema);

/// Writes a plate of `rows` times `rows` round holes, pitch 10 mm, diameter 5 mm, 2 mm thick, in mm.
void write_step_perforated(const std::string& path, int rows);

/// Writes a cube of edge `size` with a spherical cavity of 0.4 `size` in its middle and a round hole along z of radius
/// 0.05 `size` through it, in mm.
void write_step_housing(const std::string& path, double size);

/// Writes a solid box without its top face, in mm: what no CAD program should write.
void write_step_open_solid(const std::string& path);

}  // namespace tegotae::test
