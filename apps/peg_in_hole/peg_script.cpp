#include "peg_in_hole/peg_script.hpp"

#include <cmath>
#include <vector>

namespace tegotae::apps {

namespace {

constexpr double kSample = 0.02;   // s; the script is linear between rows, which is smooth to a hand
constexpr double kDecimals = 1e9;  // a file with nine decimals gives the same bits

// Where the peg's tip and axis are wanted.
struct Waypoint {
  double t;         // s
  double x, y, z;   // of the tip, m
  double tilt_deg;  // of the axis about y: positive leans the upper end to +x
};

// Goes from 0 to 1 with zero velocity at both ends.
double smooth(double s) {
  return s * s * (3 - 2 * s);
}

double rounded(double value) {
  return std::round(value * kDecimals) / kDecimals;
}

StylusScript::Key key(const PegTask& task, const Waypoint& w) {
  const double angle = w.tilt_deg * std::acos(-1.0) / 180;
  Pose X;
  X.q = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  X.p = Vec3(w.x, w.y, w.z) - X.q * task.tip;
  for (double& x : X.p) x = rounded(x);
  for (double& x : X.q.coeffs()) x = rounded(x);
  return {rounded(w.t), X};
}

}  // namespace

std::vector<StylusScript::Key> insertion_script(const PegTask& task) {
  const double mm = 1e-3, down = -task.depth;
  const std::vector<Waypoint> way = {
      {0.0, 0, 0, task.start, 0},             //
      {1.0, 2.2 * mm, 0, 4 * mm, 3},          // comes down two millimeters off and tilted
      {1.6, 2.2 * mm, 0.3 * mm, -2 * mm, 3},  // hits the rim and presses
      {2.4, -0.2 * mm, 0, -2 * mm, 3},        // slides over the hole
      {3.2, 0, 0, -6 * mm, 3},                // goes in tilted until it jams
      {3.8, 0, 0, -6 * mm, 0},                // straightens up
      {4.8, 0, 0, 0.6 * down, 0},             //
      {5.3, 0.5 * mm, 0, 0.7 * down, 4},      // rocks: touches both sides
      {5.9, -0.5 * mm, 0, 0.85 * down, -4},   //
      {6.4, 0, 0, down, 0},                   //
      {6.8, 0, 0, down - 1 * mm, 0},          // presses on the bottom
      {7.5, 0, 0, down - 1 * mm, 0},
  };
  std::vector<StylusScript::Key> keys;
  keys.push_back(key(task, way.front()));
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Waypoint &a = way[i - 1], &b = way[i];
    const int n = static_cast<int>(std::lround((b.t - a.t) / kSample));
    for (int k = 1; k <= n; ++k) {
      const double s = smooth(static_cast<double>(k) / n);
      const Waypoint w = {a.t + (b.t - a.t) * k / n, a.x + s * (b.x - a.x), a.y + s * (b.y - a.y),
                          a.z + s * (b.z - a.z), a.tilt_deg + s * (b.tilt_deg - a.tilt_deg)};
      keys.push_back(key(task, w));
    }
  }
  return keys;
}

}  // namespace tegotae::apps
