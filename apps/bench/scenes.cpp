#include "bench/scenes.hpp"

#include <cmath>
#include <memory>
#include <random>

#include "bench/path.hpp"
#include "bench/seat_scenes.hpp"
#include "bench/thread_scenes.hpp"
#include "core/numbers.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::bench {
namespace {

/// Divisions around and along a cylindrical wall.
struct Divisions {
  int around;
  int along;
};

struct PegCase {
  const char* name;
  double ratio;
  Divisions peg, hole;
  double overlap;
  Targets targets;
};

// The divisions make the triangle counts of the names with wall triangles about as wide as high.
const PegCase kPegCases[] = {
    {"2k/2k@0.99", 0.99, {40, 23}, {40, 22}, 1e-4, {50, 500, 20}},
    {"20k/20k@0.99", 0.99, {112, 87}, {112, 86}, 1e-4, {80, 1000, 25}},
    {"200k/200k@0.99", 0.99, {352, 282}, {352, 281}, 1e-4, {120, 1000, 30}},
    {"20k/1M@0.99", 0.99, {112, 87}, {792, 628}, 1e-4, {150, 1000, 25}},
    {"20k/20k@0.999", 0.999, {112, 87}, {112, 86}, 2e-5, {150, 1000, 60}},
};
const char* const kKnots = "knots100k";
const char* const kParts = "parts1000";

/// Poses of a peg tilted in its hole so that its tip's edge on one side and the hole's rim on the other overlap by
/// about 0 to `most` (m): over a touching length l, the tilt takes l/2 · tilt of the radial clearance on each side.
std::vector<Pose> peg_jams(const shapes::Peg& peg, const shapes::Block& block, double most, int n) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> unit(0, 1);
  // The peg's polygon is inscribed, the hole's circumscribed; both give half of the heights of their facets.
  const double inner = peg.diameter / 2 * (1 + std::cos(kPi / peg.segments)) / 2;
  const double outer = block.hole_diameter / 2 * (1 + 1 / std::cos(kPi / block.segments)) / 2;
  std::vector<Pose> poses;
  for (int i = 0; i < n; ++i) {
    const double bottom = -(0.15 + 0.8 * unit(rng)) * block.depth;  // of the tip; both chamfers do not touch
    const double low = bottom + peg.chamfer, high = -block.chamfer, length = high - low;
    const double tilt = 2 * (outer - inner + most * unit(rng)) / length;
    const Vec3 axis(std::cos(kRoundTurn * i), std::sin(kRoundTurn * i), 0);
    const Quat q(Eigen::AngleAxisd(tilt, axis));
    const Vec3 middle(0, 0, -peg.length / 2 + peg.chamfer + length / 2);
    poses.push_back({q, Vec3(0, 0, (low + high) / 2) - q * middle});
  }
  return poses;
}

BenchScene make_peg_scene(const PegCase& c, int jams) {
  BenchScene bench;
  shapes::Block block;
  block.segments = c.hole.around;
  block.rings = c.hole.along;
  shapes::Peg peg;
  peg.diameter = c.ratio * block.hole_diameter;
  peg.segments = c.peg.around;
  peg.rings = c.peg.along;
  const Vec3 tip(0, 0, -peg.length / 2);
  const double depth = block.depth;
  bench.add_round = [tip, depth](int round, std::vector<Pose>& way) {
    add_peg_round(tip, depth, kRoundTurn * round, way);
  };
  std::vector<Pose> way;
  bench.add_round(0, way);
  add_part(bench, "hole", shared(shapes::block_with_hole(block)), {}, false);
  add_part(bench, "peg", shared(shapes::peg(peg)), way.front(), true);
  bench.tip = tip;
  bench.depth = depth;
  bench.overlap = c.overlap;
  bench.targets = c.targets;
  bench.jam_poses = peg_jams(peg, block, c.overlap, jams);
  return bench;
}

BenchScene make_knots() {
  BenchScene bench;
  shapes::Knot knot;
  knot.along = 893;
  knot.around = 56;
  const auto mesh = shared(shapes::torus_knot(knot));
  const double height = 2 * (knot.tube_radius + knot.thickness / 2) + 0.004;
  bench.add_round = [height](int round, std::vector<Pose>& way) { add_knot_round(height, kRoundTurn * round, way); };
  add_part(bench, "lower knot", mesh, {}, false);
  add_part(bench, "upper knot", mesh, {Quat::Identity(), Vec3(0, 0, height)}, true);
  bench.targets = {50, 500, 2};
  return bench;
}

BenchScene make_parts() {
  BenchScene bench;
  const double pitch = 0.04, size = 0.026;
  const std::shared_ptr<const TriangleMesh> meshes[] = {
      shared(shapes::sphere(size, 32, 17)), shared(shapes::cylinder(0.8 * size, 0.7 * size, 32, 14)),
      shared(shapes::box(Vec3::Constant(0.6 * size), {9, 9, 9})),
      shared(shapes::torus_knot({2, 3, 0.25 * size, 0.1 * size, 0.1 * size, 64, 8}))};
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = pitch * Vec3(i % 10 - 5, i / 10 % 10 - 5, i / 100 - 5);
    const Quat q(Eigen::AngleAxisd(kRoundTurn * i, Vec3(1, 2, 3).normalized()));
    add_part(bench, "part " + std::to_string(i), meshes[i % 4], {q, p}, false);
  }
  const Vec3 start(pitch / 2, pitch / 2, 0);  // in a channel between four columns
  bench.add_round = [start, pitch](int round, std::vector<Pose>& way) {
    add_grid_round(start, pitch, kPi / 4 + kRoundTurn * round, way);
  };
  add_part(bench, "rod", shared(shapes::cylinder(0.008, 0.07, 16, 30)), {Quat::Identity(), start}, true);
  bench.targets = {60, 500, 0};
  return bench;
}

}  // namespace

void add_part(BenchScene& bench, const std::string& name, std::shared_ptr<const TriangleMesh> mesh, const Pose& pose,
              bool held) {
  (held ? bench.held_triangles : bench.fixed_triangles) += mesh->triangles.size();
  bench.scene.parts.push_back({name, std::move(mesh), pose, held});
}

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const PegCase& c : kPegCases) all.emplace_back(c.name);
    all.emplace_back(kKnots);
    all.emplace_back(kParts);
    for (const std::string& name : thread_scene_names()) all.push_back(name);
    for (const std::string& name : seat_scene_names()) all.push_back(name);
    return all;
  }();
  return names;
}

BenchScene make_scene(const std::string& name, int jams) {
  BenchScene bench;
  bool known = name == kKnots || name == kParts;
  if (known) bench = name == kKnots ? make_knots() : make_parts();
  for (const std::string& seated : seat_scene_names()) {
    if (name != seated) continue;
    bench = make_seat_scene(name);
    known = true;
  }
  for (const std::string& threaded : thread_scene_names()) {
    if (name != threaded) continue;
    bench = make_thread_scene(name);
    known = true;
  }
  for (const PegCase& c : kPegCases) {
    if (name != c.name) continue;
    bench = make_peg_scene(c, jams);
    known = true;
  }
  if (!known) {
    std::string all;
    for (const std::string& n : scene_names()) all += (all.empty() ? "" : ", ") + n;
    throw Error("unknown scene \"" + name + "\"; known are " + all);
  }
  bench.name = name;
  return bench;
}

}  // namespace tegotae::bench
