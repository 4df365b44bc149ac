#pragma once

#include <string>
#include <vector>

#include "review/path_scan.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae::review {

struct Review;

/// What resists the part at a depth: the contacts' forces along the way, N, positive against the motion. NaN where the
/// part was not seen moving so.
struct DepthForce {
  double depth = 0;           ///< m along the way, from its end that is farther out; the middle of a segment
  double insertion = 0;       ///< mean of the ticks in which it went on
  double insertion_peak = 0;  ///< the largest of them
  double friction = 0;        ///< of `insertion` (where the part comes out of `pull_out`), what is friction
  double seating = 0;         ///< mean of the ticks in which it stood at the deepest: the final force
  double pull_out = 0;        ///< mean of the ticks in which it came out, or back
  double pull_out_peak = 0;   ///< the largest of them
  double low = 0, high = 0;   ///< the same with the least and the most friction (ForceBand)
};

/// The largest force of a kind, and where.
struct ForcePeak {
  double force = 0;  ///< N; 0: none
  double depth = 0;  ///< m
  double t = 0;      ///< s
  Vec3 place_W = Vec3::Zero();
  std::string part;  ///< against which most of it was
};

/// Coefficients of friction between which the true one may be.
struct ForceBand {
  double low = 0, high = 0;
};

/// How much force the assembly takes, over depth.
struct AssemblyForce {
  bool known = false;   ///< the recording has contact forces (MCAP, of `qp`), and the part went some way
  bool rubs = false;    ///< there is friction in it
  bool pulled = false;  ///< the way leads out: it begins at its deepest, and `pull_out` is what the way takes
  double way = 0;       ///< m, the deepest that it was
  std::vector<DepthForce> over_depth;
  ForcePeak insertion, seating, pull_out;  ///< seating, the final force: standing within a hundredth of
                                           ///< the deepest
  double insertion_mean = 0;               ///< N, over the way
  double pull_out_mean = 0;                ///< the same, as it came out, or back
  double friction_share = 0;               ///< of the work of the insertion, or of pulling out
  ForceBand band;                          ///< both 0: none was asked for
  double low_mean = 0, high_mean = 0;      ///< N, the mean of what the way takes, at both ends of the band
  double low_depth = 0, high_depth = 0;    ///< m, how deep the part came there, or what was left of its depth
};

/// What the way takes, in words.
inline const char* way_force_name(const AssemblyForce& force) {
  return force.pulled ? "pull-out" : "insertion";
}

/// Of the recording, and for `band` of the same pen once more with other coefficients of friction for all pairs.
/// `pulled`: as AssemblyForce::pulled.
AssemblyForce assembly_force(const Review& review, const ForceBand& band, bool pulled, const Progress& progress);

/// What of it is said in a few lines, for people; empty when nothing is known.
std::vector<std::string> assembly_force_text(const AssemblyForce& force);

/// The forces over depth as CSV: depth_mm and N; empty where the part was not seen so.
std::string assembly_force_csv(const AssemblyForce& force);

}  // namespace tegotae::review
