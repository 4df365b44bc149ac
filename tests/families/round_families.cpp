// Families of solids of revolution.
#include <vector>

#include "families/family_tools.hpp"
#include "models/revolved.hpp"
#include "models/shapes.hpp"

namespace tegotae::test {
namespace {

using shapes::ProfilePoint;
using shapes::revolved;

std::shared_ptr<const TriangleMesh> made(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

/// FCL tells where fans of so many needles touch, in a minute.
constexpr int kManyNeedles = 12500;

/// A turn about z that a seed in two has, or none.
Quat seeded_turn(const FamilyParameters& p, int bit) {
  return Quat(Eigen::AngleAxisd(choice(p, bit) ? 2 * M_PI * draw(p, 5) : 0, Vec3::UnitZ()));
}

/// Of a polygon of n corners, how far its sides are off its circle.
double polygon_sagitta(double radius, int n) {
  return radius * (1 - std::cos(M_PI / n));
}

}  // namespace

/// The socket takes in 60 degrees around its pole, where a meter of gap is 2 m of travel.
FamilyCase ball_in_socket(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  const int segments = std::max(12, static_cast<int>(std::sqrt(p.triangles))), rings = segments / 2 + 1;
  shapes::Socket socket;
  socket.diameter = p.size + 2 * p.clearance;
  socket.center = socket.diameter / 4;
  socket.wall = 0.2 * p.size;
  socket.segments = segments;
  socket.rings = std::max(4, segments / 4);
  add_fixed(c, made(shapes::socket(socket)));
  c.seat = {choice(p, 0) ? rotation(3 * Vec3(draw(p, 2), draw(p, 3), draw(p, 4))) : Quat(Quat::Identity()),
            Vec3(0, 0, socket.center)};
  c.gain = 2;
  const double radius = p.size / 2;
  c.sagitta = 2 * (polygon_sagitta(radius, segments) + polygon_sagitta(radius, 2 * rings));
  c.rest = FamilyCase::Range{p.clearance, p.clearance};
  add_held(c, made(shapes::sphere(p.size, segments, rings)));
  return c;
}

/// A ring in a groove that takes in 60 degrees on each side of its lowest circle.
FamilyCase torus_in_groove(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  const int around = std::max(8, static_cast<int>(std::sqrt(p.triangles / 6.0))), segments = 3 * around;
  const double ring = 0.38 * p.size, tube = 0.12 * p.size, groove = tube + p.clearance;
  const double center = groove / 2, half_width = groove * std::sin(M_PI / 3);
  const double floor = center - groove - 0.1 * p.size, outside = 0.7 * p.size;
  std::vector<ProfilePoint> block = {{0, floor}, {outside, floor}, {outside, 0}};
  std::vector<ProfilePoint> arc = shapes::arc(ring, center, groove, -M_PI / 6, -5 * M_PI / 6, std::max(4, around / 3));
  arc.front() = {ring + half_width, 0};
  arc.back() = {ring - half_width, 0};
  block.insert(block.end(), arc.begin(), arc.end());
  block.push_back({0, 0});
  add_fixed(c, made(revolved("groove", block, segments)));
  std::vector<ProfilePoint> circle = shapes::arc(ring, 0, tube, -M_PI / 2, 3 * M_PI / 2, around);
  circle.pop_back();
  c.seat = {seeded_turn(p, 0), Vec3(0, 0, center)};
  c.gain = 2;
  c.sagitta = 2 * (polygon_sagitta(tube, around) + polygon_sagitta(ring, segments));
  c.rest = FamilyCase::Range{p.clearance, p.clearance};
  add_held(c, made(revolved("ring", circle, segments)));
  return c;
}

/// A cone of 5 to 30 degrees a side in a conical hole wider by the clearance.
FamilyCase taper_in_cone(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  const double angle = (5 + 25 * draw(p, 2)) * M_PI / 180, slope = std::tan(angle);
  const int rows = std::max(2, static_cast<int>(std::sqrt(p.triangles / 8.0)));
  const int segments = std::max(8, p.triangles / (2 * rows));
  const double low = 0.2 * p.size, height = 0.6 * p.size, sunk = p.clearance / slope;
  const double pocket = sunk + 0.05 * p.size;  // below the cone's end, so that it never reaches the hole's floor
  const auto radius = [&](double z) { return low + slope * z; };
  std::vector<ProfilePoint> cone = {{0, 0}}, hole;
  for (int i = 0; i <= rows; ++i) {
    const double z = height * i / rows;
    cone.push_back({radius(z), z});
  }
  cone.push_back({0, height});
  const double mouth = 0.5 * p.size, outside = radius(height) + 0.2 * p.size, floor = -pocket - 0.1 * p.size;
  hole = {{0, floor}, {outside, floor}, {outside, mouth}};
  for (int i = 0; i <= rows; ++i) {
    const double z = mouth - (mouth + pocket) * i / rows;
    hole.push_back({radius(z) + p.clearance, z});
  }
  hole.push_back({0, -pocket});
  add_fixed(c, made(revolved("conical hole", hole, segments)));
  c.seat.q = seeded_turn(p, 0);
  c.gain = 1 / std::sin(angle);
  c.guided = true;
  c.sagitta = 2 * polygon_sagitta(radius(mouth), segments) / slope;
  c.rest = FamilyCase::Range{sunk, sunk};
  // It must be clear of the wall where it starts.
  c.start = std::max(c.start, 4 * c.gain * 10e-6);
  add_held(c, made(revolved("cone", cone, segments)));
  return c;
}

/// A shaft that stands in its blind hole, 5 % of its size over the floor: planes meet there. The hole's polygon is
/// outside its circle, the shaft's inside.
FamilyCase shaft_in_bore(const FamilyParameters& p) {
  constexpr double kMinClearance = 25e-6;
  FamilyParameters used = p;
  used.clearance = std::max(p.clearance, kMinClearance);
  FamilyCase c = case_for(used);
  const int rings = std::max(2, static_cast<int>(std::sqrt(p.triangles / 8.0)));
  shapes::Peg peg;
  peg.diameter = 0.4 * p.size;
  peg.length = p.size;
  peg.chamfer = 0.01 * p.size;
  peg.segments = std::max(8, p.triangles / (2 * rings) / 8 * 8);
  peg.rings = rings;
  shapes::Block block;
  block.hole_diameter = peg.diameter + 2 * used.clearance;
  block.depth = 0.7 * p.size;
  block.size = p.size * Vec3(0.8, 0.8, 0.9);
  block.chamfer = 0.02 * p.size;
  block.segments = peg.segments;
  block.rings = rings;
  add_fixed(c, made(shapes::block_with_hole(block)));
  c.seat = {seeded_turn(p, 0), Vec3(0, 0, peg.length / 2 - block.depth)};
  c.flat = true;
  c.guided = true;
  c.tilt = 0;
  c.rest = FamilyCase::Range{0, 0};
  add_held(c, made(shapes::peg(peg)));
  return c;
}

/// The end face of a turned part, a fan of needles, and on it a block, or a seed in two another turned part.
FamilyCase turned_end_face(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  const int segments = std::max(12, p.triangles / 4);
  const double radius = p.size;
  add_fixed(c, made(shapes::moved(shapes::cylinder(2 * radius, 0.5 * p.size, segments), {0, 0, -0.25 * p.size})),
            {seeded_turn(p, 1), Vec3::Zero()});
  const double side = 0.4 * p.size, height = 0.3 * p.size, away = 0.5 * p.size * draw(p, 2), at = 2 * M_PI * draw(p, 3);
  c.seat = {Quat(Eigen::AngleAxisd(2 * M_PI * draw(p, 4), Vec3::UnitZ())),
            Vec3(away * std::cos(at), away * std::sin(at), height / 2)};
  c.slide *= 10;
  c.flat = true;
  // Two planes. FCL looks at all pairs of their needles.
  if (segments > kManyNeedles) c.touch = 0;
  c.rest = FamilyCase::Range{0, 0};
  add_held(c, made(choice(p, 0) ? shapes::cylinder(p.size, height, segments) : shapes::box({side, side, height})));
  return c;
}

}  // namespace tegotae::test
