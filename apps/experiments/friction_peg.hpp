#pragma once

#include <vector>

namespace tegotae::experiments {

/// One point of Whitney's jamming diagram, of a peg in two-point contact.
struct JamPoint {
  double side = 0, moment = 0;  ///< F_x / F_z and M / (r F_z), about the tip
  bool slides = false;          ///< as Whitney has it
  bool slid = false;            ///< in the contact loop, on the meshes
};

/// Whitney (1982), "Quasi-static assembly of compliantly supported rigid parts": a peg in two-point contact slides when
/// |F_x / F_z| < 1 / mu and |M / (r F_z) + mu (1 + lambda) F_x / F_z| < lambda, with lambda = depth / (2 r mu).
bool whitney_slides(double lambda, double mu, double side, double moment);

/// `grid` × `grid` points at the depth that lambda stands for: the round peg's mesh in the hole's, pushed down with
/// these loads.
std::vector<JamPoint> jam_map(double lambda, double mu, int grid);

/// How a pen leads a peg of `kPegRadius` into its hole: off by `offset` (m) and tilted by `tilt` (rad) about the axis
/// across, both of the springs' rest pose.
struct PegLead {
  double offset = 0, tilt = 0, play = 1e-4, mu = 0;
};

/// A depth and the force against the insertion (N) there.
struct DepthForce {
  double depth = 0, measured = 0, expected = 0;
};

/// The force against insertion of a peg on the coupling's springs whose tip is `depth` under the rim, sliding in, in
/// the plane: equilibrium of the springs, one or two contacts (rim and tip) and their friction, for small angles.
double insertion_force(const PegLead& lead, double depth);

/// The same in the contact loop, on the meshes, over depth.
std::vector<DepthForce> insert_peg(const PegLead& lead, int points);

}  // namespace tegotae::experiments
