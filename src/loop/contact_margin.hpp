#pragma once

#include <algorithm>

#include "loop/initial_contacts.hpp"
#include "tegotae/contact/contact.hpp"

namespace tegotae {

/// Contacts are kept at this share of l_min, so that rounding and curvature do not make a resting contact come and go.
inline constexpr double kMarginShare = 0.5;
/// Share of the margin by which a gap below it recovers in a sub-step.
inline constexpr double kRecovery = 0.4;
/// Gaps above this share of the margin are left alone: opening them a little would push a resting part around.
inline constexpr double kRecoverBelow = 0.8;
/// The same where a part is wedged at the smallest margin: there, gaps a little below it hold the part like walls,
/// although the surfaces have clearance.
inline constexpr double kRecoverWedged = 0.98;
/// To recover gaps a part moves no farther away from the pen than this many margins.
inline constexpr double kMaxRecovery = 10;
/// Normals are known to some 1e-11 rad (rounding of coordinates over a gap of a micrometer), so between walls without
/// room no motion may keep all gaps to the last bit. Where there is none, gaps may be lost by this share of the wanted
/// motion.
inline constexpr double kNormalNoise = 1e-9;
/// A constraint for one motion alone comes from the plane that the certificate would find for it, and leaves this many
/// times what the certificate asks for.
inline constexpr double kCutMargin = 1.2;

/// Whether a contact's gap is below the share `below` of the kept one, and so should recover.
inline bool is_lost(const Contact& c, double margin, double below) noexcept {
  return c.gap < below * margin && c.age != kOneShotAge;
}

/// What a contact asks of a motion: row · z >= this (m). It may close down to the gap `margin`; where it is lost it
/// opens by `recovery`, where that is not zero.
inline double bound_of(const Contact& c, double margin, double below, double recovery) noexcept {
  const double kept = c.age == kOneShotAge ? kCutMargin * kGapFloor : margin;
  return std::min(kept, c.gap + (is_lost(c, margin, below) ? recovery : 0)) - c.gap;
}

}  // namespace tegotae
