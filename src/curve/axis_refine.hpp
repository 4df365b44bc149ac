#pragma once

#include <vector>

#include "curve/screw_fit.hpp"

namespace tegotae {

/// Lays the profile of the facets `of` onto itself: the screw motion next to `motion` about which points of different
/// azimuths have the same profile. The corners of facets lie on the surface that the mesh stands for, where their
/// normals are those of chords; so this is finer than what fit_screw can see. Without a rise it stays without.
ScrewMotion refined(const std::vector<Facet>& facets, const std::vector<std::size_t>& of, const ScrewMotion& motion);

}  // namespace tegotae
