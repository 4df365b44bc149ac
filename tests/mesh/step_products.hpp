// STEP files of products as CAD programs write them, made with OpenCASCADE.
#pragma once

#include <string>

namespace tegotae::test {

/// Writes an assembly "AS1" in AP203, in mm: "PLATE", four "BOLT" and four "NUT" in two groups "PAIR", each instance
/// nested in the next. Every product holds a solid and an empty compound, both with the names that OpenCASCADE gives.
void write_step_hollow_products(const std::string& path);

/// Writes one product "FLANGE", a box of 60 x 60 x 20 mm with a spherical cavity, with an empty compound beside it if
/// `hollow`.
void write_step_flange(const std::string& path, bool hollow);

/// Writes a beam of length `size` (mm) in 20 equal pieces, each with a countersink at its lower end, and by turns with
/// a bore through it and a boss on it: radius 3/400 `size` of the bores and 6/400 of the bosses.
void write_step_beam(const std::string& path, double size);

/// Writes an assembly with `copies` of each thing that is told of a part, "KIND 1", "KIND 2" and so on: "slot" (planes
/// run tangentially into its round ends), "cross" (two bores that differ by 50 um), "open" (a solid without its top),
/// "line" (a curve beside the solid), "empty" (a compound of nothing), "point", and "ball" in "socket".
void write_step_flaws(const std::string& path, int copies);

/// Writes an assembly of parts that want no note: "two" (a product of two solids), "shelled" (a solid and a closed
/// shell), and in the groups "left" and "right", each in a group "inner", a "pin".
void write_step_nested(const std::string& path);

}  // namespace tegotae::test
