#include "families/family.hpp"

#include <random>
#include <utility>

#include "families/family_tools.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::test {
namespace {

// Clearance as a share of the size, at most.
constexpr double kMaxClearance = 0.02;
constexpr double kStart = 0.05, kPress = 0.005, kMinPress = 0.2e-3, kSlide = 0.02, kTurn = 0.03, kTilt = 0.005;

using Maker = FamilyCase (*)(const FamilyParameters&);

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all = {
      {"ball", ball_in_socket},        {"wave", wave_on_die},      {"cover", cover_on_blocks},
      {"saddle", saddle_on_saddle},    {"torus", torus_in_groove}, {"taper", taper_in_cone},
      {"flat", flat_on_flat},          {"bore", shaft_in_bore},    {"dovetail", dovetail},
      {"text", text_on_text},          {"noise", noise_on_noise},  {"turned", turned_end_face},
      {"lattice", lattice_on_lattice}, {"shell", shell_on_mold}};
  return all;
}

}  // namespace

std::vector<std::string> family_names() {
  std::vector<std::string> names;
  for (const auto& maker : makers()) names.push_back(maker.first);
  return names;
}

FamilyCase make_family(const FamilyParameters& parameters) {
  FamilyParameters p = parameters;
  if (!(p.size > 0 && p.clearance >= 0 && p.triangles > 0 && p.near > 0 && p.seed > 0))
    throw Error("a case needs a size, a seed from 1 on, triangles and parts");
  p.clearance = std::min(p.clearance, kMaxClearance * p.size);
  for (const auto& [name, maker] : makers())
    if (name == p.family) return maker(p);
  throw Error("unknown family \"" + p.family + "\"");
}

double draw(const FamilyParameters& p, unsigned salt) {
  std::seed_seq seeds{p.seed, salt};
  std::mt19937 rng(seeds);
  return std::uniform_real_distribution<double>(0, 1)(rng);
}

FamilyCase case_for(const FamilyParameters& p) {
  FamilyCase c;
  c.parameters = p;
  c.approach = -Vec3::UnitZ();
  c.start = kStart * p.size;
  c.press = std::max(kPress * p.size, kMinPress) * (1 + 2 * draw(p, 6));
  const double side = 2 * M_PI * draw(p, 1);
  c.slide = kSlide * p.size * Vec3(std::cos(side), std::sin(side), 0);
  c.turn = kTurn;
  c.tilt = kTilt;
  return c;
}

void add_fixed(FamilyCase& c, std::shared_ptr<const TriangleMesh> mesh, const Pose& pose) {
  c.scene.parts.push_back({"fixed" + std::to_string(c.scene.parts.size()), std::move(mesh), pose, false});
}

void add_held(FamilyCase& c, std::shared_ptr<const TriangleMesh> mesh) {
  c.scene.parts.push_back({"held", std::move(mesh), {c.seat.q, c.seat.p - c.start * c.approach}, true});
  c.press += c.deepest();
  c.parameters.near = static_cast<int>(c.scene.parts.size()) - 1;
}

int add_tiles(FamilyCase& c, double size, int cells, const shapes::Height& z, bool solid, double floor) {
  const int tiles = std::max(1, static_cast<int>(std::sqrt(c.parameters.near)));
  const int each = std::max(1, (cells + tiles - 1) / tiles);
  const double side = size / tiles;
  for (int i = 0; i < tiles; ++i) {
    for (int k = 0; k < tiles; ++k) {
      const double x0 = side * (i - 0.5 * (tiles - 1)), y0 = side * (k - 0.5 * (tiles - 1));
      const shapes::Height here = [&](double x, double y) { return z(x + x0, y + y0); };
      const shapes::Height bottom = [&](double, double) { return floor; };
      const shapes::Grid grid = {side, side, each, each};
      add_fixed(c, welded(solid ? shapes::slab(grid, bottom, here) : shapes::sheet(grid, here)),
                {Quat::Identity(), {x0, y0, 0}});
    }
  }
  return each * tiles;
}

}  // namespace tegotae::test
