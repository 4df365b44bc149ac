#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/trial.hpp"

namespace tegotae::experiments {

/// A peg of 50 mm and its hole of 20 mm in diameter and 40 mm in depth.
class PegTask {
 public:
  /// `ratio`: diameter of the peg by that of the hole. `segments` around both; 0: fine enough for the ratio.
  PegTask(double ratio, const std::string& resolver, int segments = 0);

  /// Of the resolver "penalty", N/m.
  void set_penalty_stiffness(double stiffness) { scene_.contact.penalty.stiffness = stiffness; }
  void set_friction(double mu) { scene_.friction.mu = mu; }
  /// The same parts, the held one starting at `start`.
  Scene scene_at(const Pose& start) const;
  /// What an operator is to do: begin 40 mm aside and over the hole, push to the bottom.
  InsertionTask task() const;
  /// The same, from start `i` of `n`: the last one is tilted (5°) and off center (1 mm, the chamfer) as far as it may
  /// be, directions go around.
  InsertionTask tilted_task(std::size_t person, int i, int n) const;
  Vec3 tip() const;      ///< of the peg, m, its file frame
  double depth() const;  ///< of the hole, m

  /// How deep the peg in the pose X and the block are in each other, m: the deepest vertex of one in the other. Closed
  /// form in the peg's planes and the hole's polygon, and so a word of its own beside the contact loop's.
  double penetration(const Pose& X) const;

 private:
  double peg_vertices_in_block(const Pose& X) const;
  double block_vertices_in_peg(const Pose& X) const;

  Scene scene_;
  std::vector<Vec3> facet_normals_;  // of the hole's polygon, outward
  struct Plane {
    Vec3 n;
    double d;
  };
  std::vector<Plane> peg_planes_;
  std::vector<Vec3> peg_vertices_, rim_vertices_;
};

/// One operator's attempt.
struct Attempt {
  bool reached = false;        ///< the center of mass came down to the surface
  bool completed = false;      ///< the tip came to the bottom (0.5 mm)
  double time = 0;             ///< from the tip's to the center of mass's reaching the surface, s; NaN when it did not
  double time_to_bottom = 0;   ///< from the tip's reaching the surface to the bottom, s; NaN when it did not
  double vibration = 0;        ///< RMS above 30 Hz of the center of mass since the tip's reaching the surface, m
  double force_vibration = 0;  ///< the same of the force, N
  double penetration = 0;      ///< deepest, m
  std::int64_t intersecting = 0;  ///< of the poses asked of FCL
  std::int64_t held_back = 0;     ///< ticks in which it was held back for long without a contact
  std::vector<Sample> samples{};
};

/// Lets an operator try for at most `seconds` after the tip has reached the surface; ends at the bottom, or with
/// `to_surface` when the center of mass has come down to it.
Attempt attempt(const PegTask& peg, const OperatorProfile& profile, const InsertionTask& task, std::uint64_t seed,
                double seconds, bool to_surface);

}  // namespace tegotae::experiments
