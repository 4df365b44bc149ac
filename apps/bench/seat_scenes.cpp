#include "bench/seat_scenes.hpp"

#include <limits>

#include "bench/path.hpp"
#include "models/height_field.hpp"
#include "models/revolved.hpp"
#include "models/shapes.hpp"

namespace tegotae::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
// Where surfaces of more triangles mate, FCL takes seconds for a pose.
constexpr std::size_t kManyTriangles = 20000;
constexpr int kFewPoses = 20;

struct SheetCase {
  const char* name;
  int cells;    // along a side
  double wave;  // m
  Targets targets;
  SeatTargets seat;
};

const SheetCase kSheetCases[] = {{"sheets7k", 59, 0.1, {400, 900}, {400, 100, 10, 50}},
                                 {"sheets45k", 149, 0.04, {kNone, kNone}, {400, 100, 10, 50}},
                                 {"sheets180k", 299, 0.02, {kNone, kNone}, {400, 300, 3, 50}}};
const char* const kSocket = "socket20k";
const char* const kCover = "cover200";

void set_pen(BenchScene& bench, const SeatPen& pen) {
  bench.seat = pen;
  bench.add_round = [pen](int round, std::vector<Pose>& way) {
    add_seat_round(pen.seat, pen.above, pen.below, pen.slide.norm(), kRoundTurn * round, way);
  };
  if (bench.held_triangles > kManyTriangles) bench.most_fcl_poses = kFewPoses;
}

/// A wavy sheet of 300 mm on a die of the same triangles: the seat is z = 0, to the last bit.
BenchScene make_sheets(const SheetCase& c) {
  BenchScene bench;
  const double side = 0.3, amplitude = 0.003, above = 0.02;
  const auto mesh = shared(shapes::sheet({side, side, c.cells, c.cells}, shapes::waves(amplitude, c.wave)));
  add_part(bench, "die", mesh, {}, false);
  add_part(bench, "sheet", mesh, {Quat::Identity(), Vec3(0, 0, above)}, true);
  bench.targets = c.targets;
  set_pen(bench, {Vec3::Zero(), above, 0.001, Vec3(0.012, 0, 0), c.seat});
  return bench;
}

/// A ball of 40 mm in a socket with 50 um of play that takes in 60 degrees around its pole. Both poles are corners, so
/// they touch when the ball has gone down by the play.
BenchScene make_socket() {
  BenchScene bench;
  const double diameter = 0.04, play = 50e-6, above = 0.01;
  shapes::Socket socket;
  socket.diameter = diameter + 2 * play;
  socket.center = socket.diameter / 4;
  socket.segments = 200;
  socket.rings = 48;
  const Vec3 seat(0, 0, socket.center - play);
  add_part(bench, "socket", shared(shapes::socket(socket)), {}, false);
  add_part(bench, "ball", shared(shapes::sphere(diameter, 100, 101)), {Quat::Identity(), seat + Vec3(0, 0, above)},
           true);
  bench.targets = {400, 900};
  set_pen(bench, {seat, above, 0.001, Vec3(0.001, 0, 0), {400, 100, 0, 50}});
  return bench;
}

/// A plate of 200 by 100 mm on 200 blocks, each a part of its own, whose tops are at z = 0.
BenchScene make_cover() {
  BenchScene bench;
  const double pitch = 0.01, above = 0.02, thickness = 0.005;
  const int columns = 20, rows = 10;
  const auto block = shared(shapes::box({0.006, 0.006, 0.01}));
  for (int i = 0; i < columns * rows; ++i) {
    const Vec3 p(pitch * (i % columns - 0.5 * (columns - 1)), pitch * (i / columns - 0.5 * (rows - 1)), -0.005);
    add_part(bench, "block " + std::to_string(i), block, {Quat::Identity(), p}, false);
  }
  const Vec3 seat(0, 0, thickness / 2);
  add_part(bench, "cover", shared(shapes::box({pitch * columns, pitch * rows, thickness})),
           {Quat::Identity(), seat + Vec3(0, 0, above)}, true);
  bench.targets = {400, 900};
  set_pen(bench, {seat, above, 0.001, Vec3(0.012, 0, 0), {400, 100, 10, 50}});
  return bench;
}

}  // namespace

const std::vector<std::string>& seat_scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const SheetCase& c : kSheetCases) all.emplace_back(c.name);
    all.emplace_back(kSocket);
    all.emplace_back(kCover);
    return all;
  }();
  return names;
}

BenchScene make_seat_scene(const std::string& name) {
  for (const SheetCase& c : kSheetCases)
    if (name == c.name) return make_sheets(c);
  return name == kSocket ? make_socket() : make_cover();
}

}  // namespace tegotae::bench
