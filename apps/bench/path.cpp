#include "bench/path.hpp"

#include <algorithm>
#include <cmath>

namespace tegotae::bench {
namespace {

constexpr double kMm = 1e-3;
constexpr double kDeg = 3.14159265358979323846 / 180;
// Script keys must not share a time (s).
constexpr double kShortestLeg = 1e-6;

Quat about_z(double angle) {
  return Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
}

Quat about_y(double angle) {
  return Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
}

}  // namespace

std::vector<StylusScript::Key> timed(const std::vector<Pose>& way, const PenSpeed& speed) {
  std::vector<StylusScript::Key> keys;
  double t = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (i > 0) {
      const double length = (way[i].p - way[i - 1].p).norm(), angle = way[i].q.angularDistance(way[i - 1].q);
      t += std::max({length / speed.linear, angle / speed.angular, kShortestLeg});
    }
    keys.push_back({t, way[i]});
  }
  return keys;
}

std::vector<StylusScript::Key> timed(const std::function<Pose(double t)>& pen, double seconds, const PenSpeed& speed) {
  constexpr double kStep = 0.002;  // s of the hand
  std::vector<StylusScript::Key> keys;
  const int n = static_cast<int>(std::ceil(seconds / kStep));
  for (int i = 0; i <= n; ++i) keys.push_back({seconds * i / n / speed.pace, pen(seconds * i / n)});
  return keys;
}

void add_peg_round(const Vec3& tip, double depth, double azimuth, std::vector<Pose>& way) {
  struct Stop {
    double x, y, z;      // of the tip, mm
    double tilt, twist;  // deg
  };
  const double floor = -depth / kMm;
  const Stop stops[] = {
      {0, 0, 5, 0, 0},
      {2.2, 0, 1, 3, 0},               // approach, off and tilted
      {2.2, 0.3, -2, 3, 0},            // presses on the rim
      {-0.2, 0, -2, 3, 0},             // slides over the hole
      {0, 0, -6, 3, 0},                // goes in tilted until it jams
      {0, 0, -6, 0, 0},                // straightens up
      {0, 0, 0.3 * floor, 0, 0},       //
      {0.5, 0, 0.35 * floor, 4, 0},    // jams on both sides
      {0.5, 0.2, 0.4 * floor, -4, 0},  //
      {-0.3, 0, 0.6 * floor, 0, 0},    //
      {0, 0, 0.65 * floor, 3, 0},      //
      {0, 0, 0.7 * floor, -3, 0},      //
      {0.5, 0.5, 0.8 * floor, 0, 0},   // pressed to the side
      {0.5, 0.5, 0.9 * floor, 0, 15},  // and turned
      {0, 0, floor - 1, 0, 15},        // presses on the bottom
      {0, 0, floor - 1, 2, 15},        // rocks there
      {0, 0, floor - 1, -2, 15},       //
      {0.3, 0, floor - 0.5, 0, 0},     //
      {0, 0, 0.5 * floor, 2, 0},       // jams on the way out
      {0, 0, 5, 0, 0},
  };
  for (const Stop& s : stops) {
    const Quat q = about_z(azimuth) * about_y(s.tilt * kDeg) * about_z(s.twist * kDeg);
    way.push_back({q, about_z(azimuth) * Vec3(s.x * kMm, s.y * kMm, s.z * kMm) - q * tip});
  }
}

void add_knot_round(double height, double azimuth, std::vector<Pose>& way) {
  struct Stop {
    double x, y, z;      // mm; z against `height`
    double tilt, twist;  // deg
  };
  const Stop stops[] = {
      {0, 0, 0, 0, 0},      {0, 0, -12, 0, 0},    {0, 0, -14, 0, 30},  {10, 0, -16, 5, 30},  {-10, 5, -16, -5, 10},
      {0, 0, -18, 0, -10},  {20, -10, -20, 8, 0}, {0, 0, -22, 15, 20}, {-15, 10, -20, 0, 0}, {0, 0, -14, -10, 0},
      {0, 25, -30, 0, -20}, {0, 0, -8, 0, 0},     {0, 0, 0, 0, 0},
  };
  for (const Stop& s : stops) {
    const Quat q = about_z(azimuth) * about_y(s.tilt * kDeg) * about_z(s.twist * kDeg);
    way.push_back({q, about_z(azimuth) * Vec3(s.x * kMm, s.y * kMm, 0) + Vec3(0, 0, height + s.z * kMm)});
  }
}

void add_grid_round(const Vec3& start, double pitch, double azimuth, std::vector<Pose>& way) {
  struct Stop {
    double out, along;   // pitches, towards `azimuth` and along z
    double tilt, twist;  // deg
  };
  const Stop stops[] = {
      {0, 0, 0, 0},     {0.4, 0, 0, 0},     {0.45, 0.5, 0, 0}, {0.4, 0.5, 10, 0},  {0, 0.4, 40, 0},   {0, 0.2, 60, 20},
      {0.2, 0, 60, 20}, {-0.2, 0, 30, -20}, {0, -0.3, -30, 0}, {-0.4, 0, -10, 40}, {-0.4, 0.3, 0, 0}, {0, 0, 0, 0},
  };
  for (const Stop& s : stops) {
    const Quat q = about_z(azimuth) * about_y(s.tilt * kDeg) * about_z(s.twist * kDeg);
    way.push_back({q, start + about_z(azimuth) * Vec3(s.out * pitch, 0, s.along * pitch)});
  }
}

void add_seat_round(const Vec3& seat, double above, double below, double slide, double azimuth,
                    std::vector<Pose>& way) {
  struct Stop {
    double z;      // over the seat
    double aside;  // of `slide`
    double twist;  // deg
  };
  const Stop stops[] = {{above, 0, 0}, {-below, 0, 0}, {-below, 1, 0}, {-below, 0, 0}, {-below, 0, 2}, {-below, 0, 0}};
  constexpr int kPresses = 6;
  for (int i = 0; i < kPresses; ++i) {
    const Vec3 aside = about_z(azimuth + 2 * 180 * kDeg * i / kPresses) * Vec3(slide, 0, 0);
    for (const Stop& s : stops) way.push_back({about_z(s.twist * kDeg), seat + Vec3(0, 0, s.z) + s.aside * aside});
  }
  way.push_back({Quat::Identity(), seat + Vec3(0, 0, above)});
}

}  // namespace tegotae::bench
