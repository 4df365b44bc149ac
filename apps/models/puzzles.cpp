#include "models/puzzles.hpp"

#include <cmath>

#include "core/numbers.hpp"
#include "models/bricks.hpp"
#include "models/helical.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {
namespace {

constexpr double kMm = 1e-3;
constexpr double kWholeTurn = 2 * kPi;

Brick brick(const Vec3& low, const Vec3& high, bool solid = true) {
  return {kMm * low, kMm * high, solid};
}
Brick cut(const Vec3& low, const Vec3& high) {
  return brick(low, high, false);
}
Pose at(double x, double y, double z) {
  return {Quat::Identity(), kMm * Vec3(x, y, z)};
}

/// A cube in a pit three times as wide: any planner finds out.
Puzzle loose() {
  Puzzle p;
  p.name = "loose";
  p.held = solid_of("cube", {brick({-5, -5, -5}, {5, 5, 5})});
  p.fixed = solid_of("pit", {brick({-20, -20, -30}, {20, 20, 0}), cut({-15, -15, -20}, {15, 15, 0})});
  p.start = at(3, 2, -12);
  p.known = {p.start, at(3, 2, 7)};
  p.least_way = 12 * kMm;
  return p;
}

/// A square peg in a blind hole, 0.1 mm of play on each side.
Puzzle straight() {
  Puzzle p;
  p.name = "straight";
  p.held = solid_of("peg", {brick({-10, -10, -15}, {10, 10, 15})});
  p.fixed = solid_of("block", {brick({-20, -20, -30}, {20, 20, 0}), cut({-10.1, -10.1, -20}, {10.1, 10.1, 0})});
  p.start = at(0, 0, -4.9);
  p.known = {p.start, at(0, 0, 18)};
  p.least_way = 20 * kMm;
  return p;
}

/// A cube at the end of a channel that goes on upwards: 25 mm along x, then out along z.
Puzzle l_shaped() {
  Puzzle p;
  p.name = "l-shaped";
  p.held = solid_of("cube", {brick({-5, -5, -5}, {5, 5, 5})});
  p.fixed = solid_of("channel", {brick({-30, -15, -40}, {30, 15, 0}), cut({-20.1, -5.1, -30.1}, {15.1, 5.1, -19.9}),
                                 cut({4.9, -5.1, -30.1}, {15.1, 5.1, 0})});
  p.start = at(-15, 0, -25);
  p.known = {p.start, at(10, 0, -25), at(10, 0, 7)};
  p.least_way = (25 + 25 - 1) * kMm;
  return p;
}

/// A headless screw in a nut of two turns, 0.15 mm of play.
Puzzle screw_in_nut() {
  Puzzle p;
  p.name = "screw";
  WavyThread thread;
  p.held = screw(thread);
  WavyThread inner = thread;
  inner.radius += 0.15 * kMm;
  p.fixed = nut(inner, 14 * kMm);
  // By sixths of a turn: a motion of more than half a turn is another one.
  const int sixths = 6 * 3;
  for (int i = 0; i <= sixths; ++i) {
    const double turns = i / 6.0;
    Pose X;
    X.q = Quat(Eigen::AngleAxisd(kWholeTurn * turns, Vec3::UnitZ()));
    X.p = {0, 0, thread.pitch * turns};
    p.known.push_back(X);
  }
  p.start = p.known.front();
  // The last half of a turn of the thread lets the screw tilt out of it.
  p.least_turn = 1.5 * kWholeTurn;
  p.least_way = 1.5 * thread.pitch;
  return p;
}

/// A cross that has to go along x, z, y and z, in a cage of which just that way was cut out.
Puzzle burr() {
  Puzzle p;
  p.name = "burr";
  const std::vector<Brick> cross = {brick({-15, -5, -5}, {15, 5, 5}), brick({-5, -15, -5}, {5, 15, 5})};
  p.held = solid_of("cross", cross);
  const std::vector<Vec3> moves = {{10, 0, 0}, {0, 0, 12}, {0, 10, 0}, {0, 0, 40}};
  std::vector<Brick> cage = {brick({-25, -25, -15}, {35, 35, 30})};
  const Vec3 play = Vec3::Constant(0.15 * kMm);
  Vec3 from = Vec3::Zero();
  p.known = {at(0, 0, 0)};
  for (const Vec3& move : moves) {
    const Vec3 to = from + kMm * move;
    for (const Brick& b : cross)
      cage.push_back({(b.low + from).cwiseMin(b.low + to) - play, (b.high + from).cwiseMax(b.high + to) + play, false});
    from = to;
    p.known.push_back({Quat::Identity(), to});
  }
  p.fixed = solid_of("cage", cage);
  p.start = p.known.front();
  p.least_way = (10 + 12 + 10 + 20 - 2) * kMm;
  return p;
}

/// A bar bent by 80 degrees in a pipe bent alike, 0.5 mm of play.
Puzzle bent() {
  Puzzle p;
  p.name = "bent-bar";
  BentBar bar;
  p.held = bent_bar(bar);
  BentBar bore = bar;
  bore.radius += 0.5 * kMm;
  p.fixed = bent_pipe(bore, 3 * kMm);
  for (int i = 0; i <= 4; ++i) {
    Pose X;
    X.q = Quat(Eigen::AngleAxisd(-i * 0.4, Vec3::UnitY()));  // from x towards z
    p.known.push_back(X);
  }
  p.known.push_back({p.known.back().q, p.known.back().p + kMm * Vec3(-30, 0, 60)});
  p.start = p.known.front();
  // The bore lets it turn otherwise by what its play allows over what is left in it.
  p.least_turn = 0.9;
  p.least_way = 30 * kMm;
  return p;
}

/// A key whose bit stands across behind a plate: a quarter turn to the slot, then out. `slot`: whether there is one.
Puzzle key(bool slot) {
  Puzzle p;
  p.name = slot ? "key" : "locked-in";
  p.held = solid_of("key", {brick({-3, -3, -10}, {3, 3, 25}), brick({-1.5, 3, -10}, {1.5, 9.5, -4})});
  std::vector<Brick> lock = {brick({-18, -18, -16}, {18, 18, 5}), cut({-14, -14, -12}, {14, 14, 0}),
                             cut({-4.7, -4.7, 0}, {4.7, 4.7, 5})};
  if (slot) lock.push_back(cut({-1.9, 4.7, 0}, {1.9, 11, 5}));
  p.fixed = solid_of("lock", lock);
  p.start.q = Quat(Eigen::AngleAxisd(kWholeTurn / 4, Vec3::UnitZ()));
  if (!slot) return p;
  p.known = {p.start, at(0, 0, 0), at(0, 0, 17)};
  p.least_turn = 0.9;  // play of the bit in the slot, and of the shaft in the hole, may spare the rest
  p.least_way = 12 * kMm;
  return p;
}

}  // namespace

Scene Puzzle::scene() const {
  Scene scene;
  scene.add_fixed(fixed.name, fixed);
  scene.add_held(held.name, held, start);
  return scene;
}

std::vector<Puzzle> puzzles() {
  return {loose(), straight(), l_shaped(), screw_in_nut(), burr(), bent(), key(true), key(false)};
}

Puzzle puzzle(const std::string& name) {
  for (Puzzle& p : puzzles())
    if (p.name == name) return std::move(p);
  throw Error("there is no puzzle \"" + name + "\"");
}

}  // namespace tegotae::shapes
