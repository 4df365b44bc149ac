#pragma once

#include <vector>

namespace tegotae::experiments {

/// A block that is pressed on a floor and led along it in one direction.
struct Sliding {
  double mu = 0, heading = 0;  ///< heading in rad
  double ratio = 0;            ///< F_t / (mu N), mean while it slides
  double worst = 0;            ///< the largest |F_t / (mu N) - 1|
  double aside = 0;            ///< the largest force across, by mu N
  double gap_change = 0;       ///< over 30 mm at 0.1 m/s, m
  double turn = 0;             ///< rad
};
Sliding slide(double mu, double heading);

/// A plate in a slot with play, pressed on one side and led along.
struct Slot {
  double play = 0, mu = 0;
  double share = 0;  ///< of the pen's way that the plate made
  double ratio = 0;  ///< F_t / (mu N) at the end
};
Slot slide_in_slot(double play, double mu);

/// A block under force and twist within the cone, for so many ticks.
struct Creep {
  double mu = 0, way = 0, turn = 0;  ///< m, rad
};
Creep rest(double mu, int ticks);

/// A block at rest well within its cone, and one that is led over the floor, under a pen whose position is off by up to
/// kPenNoise along each axis, by another amount in every tick: an encoder's step and a hand's tremor.
struct Jitter {
  double mu = 0;
  double way = 0;    ///< that the block at rest made, m
  double share = 0;  ///< the largest change of its wrench, by the stiffness times what the pen was off
  double worst = 0;  ///< while it is led: the largest |F_t / (mu N) - 1|
  int back = 0;      ///< ticks in which it went back
};
inline constexpr double kPenNoise = 15e-6;  // m
Jitter jitter(double mu, int ticks);

/// The pen to and fro over a floor.
struct Hysteresis {
  double mu = 0;
  std::vector<double> pen, force;                ///< mm, N, over the last round
  double lost = 0, expected = 0;                 ///< J a round
  double breakaway = 0, breakaway_expected = 0;  ///< m of the pen
  double step = 0;                               ///< of the pen, the longest, m
};
Hysteresis to_and_fro(double mu);

/// What the hand gets (J) on a closed way of the pen that presses, tilts, spins, slides and lifts.
double closed_way(double mu);

}  // namespace tegotae::experiments
