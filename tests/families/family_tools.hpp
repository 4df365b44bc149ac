// What the families share.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "families/family.hpp"
#include "models/height_field.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::test {

/// Whether bit `bit` of the seed is set; seeds count from 1, so that seed 1 has none.
inline bool choice(const FamilyParameters& p, int bit) {
  return ((p.seed - 1) >> bit & 1U) != 0;
}

/// A number in [0, 1) of the seed, another one for each `salt`.
double draw(const FamilyParameters& p, unsigned salt);

/// Cells along the side of a square grid of so many triangles.
inline int grid_cells(int triangles) {
  return std::max(4, static_cast<int>(std::lround(std::sqrt(triangles / 2.0))));
}

/// How far a chord of length `chord` (m) is off a curve of the given curvature (1/m).
inline double sagitta(double curvature, double chord) {
  return curvature * chord * chord / 8;
}

inline std::shared_ptr<const TriangleMesh> welded(const TriangleMesh& mesh) {
  return std::make_shared<const TriangleMesh>(weld(mesh));
}

/// A case with the pen that most families have: it starts 5 % of the size over the seat, comes down along -z, presses
/// by 0.5 % of the size, at least 0.2 mm, slides 2 % aside and turns a little.
FamilyCase case_for(const FamilyParameters& parameters);

void add_fixed(FamilyCase& c, std::shared_ptr<const TriangleMesh> mesh, const Pose& pose = {});
/// Puts the held part `start` before the seat, and lets the pen press by as much beyond the deepest place where the
/// part may rest: to be called last.
void add_held(FamilyCase& c, std::shared_ptr<const TriangleMesh> mesh);

/// Adds the surface `z` over a square of side `size` as `near` fixed parts (a square number of tiles, the next smaller
/// one): open sheets, or solids down to `floor`. Returns the cells along the whole side.
int add_tiles(FamilyCase& c, double size, int cells, const shapes::Height& z, bool solid, double floor);

// One function a family; parameters are as they will be used.
FamilyCase ball_in_socket(const FamilyParameters& p);
FamilyCase torus_in_groove(const FamilyParameters& p);
FamilyCase taper_in_cone(const FamilyParameters& p);
FamilyCase shaft_in_bore(const FamilyParameters& p);
FamilyCase turned_end_face(const FamilyParameters& p);
FamilyCase wave_on_die(const FamilyParameters& p);
FamilyCase saddle_on_saddle(const FamilyParameters& p);
FamilyCase flat_on_flat(const FamilyParameters& p);
FamilyCase text_on_text(const FamilyParameters& p);
FamilyCase noise_on_noise(const FamilyParameters& p);
FamilyCase shell_on_mold(const FamilyParameters& p);
FamilyCase dovetail(const FamilyParameters& p);
FamilyCase lattice_on_lattice(const FamilyParameters& p);
FamilyCase cover_on_blocks(const FamilyParameters& p);

}  // namespace tegotae::test
