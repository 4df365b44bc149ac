#pragma once

#include "curve/screw_fit.hpp"

namespace tegotae {

/// The angle (rad) between the facet and the motion at the middle of its chord.
double angle_at_middle(const Facet& f, const ScrewMotion& m);
/// How far the facet is from being tangent to the motion, as an angle (rad), at the worst of its corners, beyond what
/// its width explains: a facet of width d across the motion is a chord.
double angle_off(const Facet& f, const ScrewMotion& m);
/// Whether that is at most `tolerance` (rad), which is found out sooner.
bool is_within(const Facet& f, const ScrewMotion& m, double tolerance);

}  // namespace tegotae
