#include "stress_scenes.hpp"

#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include "bodies.hpp"
#include "models/shapes.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae::test {
namespace {

using Mesh = std::shared_ptr<const TriangleMesh>;
using Maker = std::function<StressScene(unsigned seed)>;

const std::string kParts = TEGOTAE_PARTS_DIR "/";

void add(StressScene& s, const std::string& name, const Mesh& mesh, const Pose& X, bool held) {
  s.scene.parts.push_back({name, mesh, X, held});
  s.sources.push_back({});
}

void add_file(StressScene& s, const std::string& name, const std::string& file, const std::string& unit, const Pose& X,
              bool held) {
  // Loaded once a program: many scripts run over the same files.
  static std::map<std::pair<std::string, std::string>, Mesh> loaded;
  Mesh& mesh = loaded[{file, unit}];
  if (!mesh) mesh = shared(load_mesh(kParts + file, unit_length(unit)));
  s.scene.parts.push_back({name, mesh, X, held});
  s.sources.push_back({kParts + file, unit});
}

Pose at(double x, double y, double z) {
  return {Quat::Identity(), {x, y, z}};
}

Pose about_z(double angle, double z) {
  return {Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())), {0, 0, z}};
}

/// A peg half way in its hole of 20 mm, or just above it.
StressScene peg_in_hole(double ratio, unsigned seed) {
  StressScene s;
  shapes::Peg peg;
  peg.diameter = 0.02 * ratio;
  const shapes::Block block;
  add(s, "hole", shared(shapes::block_with_hole(block)), at(0, 0, 0), false);
  add(s, "peg", shared(shapes::peg(peg)), at(0, 0, seed % 4 == 0 ? 0.0255 : 0.005), true);
  s.envelope = {{0.004, 0.004, 0.02}, 0.2};
  if (seed % 4 == 0) s.envelope.offset.z() = -0.0205;
  return s;
}

StressScene knots(unsigned seed) {
  StressScene s;
  shapes::Knot knot;
  static const Mesh mesh = shared(shapes::torus_knot(knot));
  add(s, "fixed", mesh, at(0, 0, 0), false);
  const double angle = 2.0 * (seed % 7);
  add(s, "held", mesh, {Quat(Eigen::AngleAxisd(angle, Vec3::UnitX())), {0.12, 0.01 * (seed % 5), 0}}, true);
  s.envelope = {{0.06, 0.04, 0.04}, 1.5, {-0.1, 0, 0}};
  return s;
}

StressScene wedged_stars(unsigned seed) {
  StressScene s;
  std::mt19937 rng(seed);
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * M_PI * k / 3;
    add(s, "fixed" + std::to_string(k), shared(random_star_body(rng, 14, 0.03)),
        {rotation(3 * random_direction(rng)), {0.03 * std::cos(angle), 0.03 * std::sin(angle), 0}}, false);
  }
  add(s, "held", shared(random_star_body(rng, 14, 0.02)), at(0, 0, 0.07), true);
  s.envelope = {{0.02, 0.02, 0.04}, 1.0, {0, 0, -0.06}};
  return s;
}

StressScene round_8mm(unsigned seed) {
  StressScene s;
  add_file(s, "hole", "factory/factory_round_hole_8mm_subdiv_3x.obj", "m", at(0, 0, 0), false);
  add_file(s, "peg", "factory/factory_round_peg_8mm_loose.obj", "m", at(0, 0, seed % 3 == 0 ? 0.0095 : 0.0), true);
  s.envelope = {{0.002, 0.002, 0.012}, 0.1};
  return s;
}

StressScene rectangular_8mm(unsigned seed) {
  StressScene s;
  add_file(s, "tray", "industreal/industreal_tray_insert_rectangular_peg_8mm.obj", "m", at(0, 0, 0), false);
  add_file(s, "peg", "industreal/industreal_rectangular_peg_8mm.obj", "m", at(0, 0, seed % 3 == 0 ? 0.03 : 0.002),
           true);
  s.envelope = {{0.003, 0.003, 0.01}, 0.2};
  if (seed % 3 == 0) s.envelope.offset.z() = -0.02;
  return s;
}

/// The large gear on its shaft, its teeth in the medium one's, 0.05 mm over its seat.
StressScene gears(unsigned) {
  StressScene s;
  add_file(s, "base", "industreal/industreal_gear_base.obj", "m", at(0, 0, 0), false);
  add_file(s, "medium", "industreal/industreal_gear_medium.obj", "m", at(0, 0, 0), false);
  add_file(s, "large", "industreal/industreal_gear_large.obj", "m", at(0, 0, 0.00005), true);
  s.envelope = {{0.002, 0.002, 0.015}, 0.1};
  return s;
}

/// Three clear poses along the thread, all but the last in it (pairs.json of the parts).
StressScene nut_on_bolt(unsigned seed) {
  StressScene s;
  add_file(s, "bolt", "factory/factory_bolt_m16_loose.obj", "m", at(0, 0, 0), false);
  const Pose starts[] = {about_z(0, 0.004), about_z(M_PI / 2, 0.0045), about_z(M_PI, 0.005), about_z(0, 0.06)};
  add_file(s, "nut", "factory/factory_nut_m16_loose_subdiv_3x.obj", "m", starts[seed % 4], true);
  s.envelope = {{0.001, 0.001, 0.003}, 0.5};
  if (seed % 4 == 3) s.envelope.reach.z() = 0.05;
  return s;
}

/// "cm" is the scale of 0.01 at which the parts' own scene uses their arbitrary units.
StressScene screw_in_nut(unsigned seed) {
  StressScene s;
  add_file(s, "nut", "rigid-ipc/nut-big.obj", "cm", at(0, 0, 0), false);
  add_file(s, "screw", "rigid-ipc/screw-big.obj", "cm", at(0, 0.0001 * (seed % 2), 0), true);
  s.envelope = {{0.01, 0.03, 0.01}, 0.5};
  return s;
}

StressScene crank_and_rod(unsigned) {
  StressScene s;
  add_file(s, "crank", "rigid-ipc/092-piston/crank.stl", "mm", at(0, 0, 0), false);
  add_file(s, "rod", "rigid-ipc/092-piston/connecting-rod.stl", "mm", at(0, 0, 0), true);
  s.envelope = {{0.1, 0.1, 0.1}, 0.8};
  return s;
}

/// The head in its cylinder and on its rod.
StressScene piston(unsigned) {
  StressScene s;
  add_file(s, "cylinder", "rigid-ipc/092-piston/cylinder.stl", "mm", at(0, 0, 0), false);
  add_file(s, "rod", "rigid-ipc/092-piston/connecting-rod.stl", "mm", at(0, 0, 0), false);
  add_file(s, "head", "rigid-ipc/092-piston/head.stl", "mm", at(0, 0, 0), true);
  s.envelope = {{0.05, 0.3, 0.05}, 0.2};
  return s;
}

const std::vector<std::pair<std::string, Maker>>& generated() {
  static const std::vector<std::pair<std::string, Maker>> makers{
      {"peg_0.94", [](unsigned seed) { return peg_in_hole(0.94, seed); }},
      {"peg_0.99", [](unsigned seed) { return peg_in_hole(0.99, seed); }},
      {"peg_0.999", [](unsigned seed) { return peg_in_hole(0.999, seed); }},
      {"knots", knots},
      {"wedged_stars", wedged_stars}};
  return makers;
}

const std::vector<std::pair<std::string, Maker>>& from_files() {
  static const std::vector<std::pair<std::string, Maker>> makers{{"round_8mm", round_8mm},
                                                                 {"rectangular_8mm", rectangular_8mm},
                                                                 {"gears", gears},
                                                                 {"nut_on_bolt", nut_on_bolt},
                                                                 {"screw_in_nut", screw_in_nut},
                                                                 {"crank_and_rod", crank_and_rod},
                                                                 {"piston", piston}};
  return makers;
}

}  // namespace

std::vector<std::string> stress_scene_names() {
  std::vector<std::string> names;
  for (const auto& maker : generated()) names.push_back(maker.first);
  if (std::filesystem::is_directory(kParts)) {
    for (const auto& maker : from_files()) names.push_back(maker.first);
  } else {
    std::cout << "SKIPPED: the scenes of real parts: no folder " << kParts << '\n';
  }
  return names;
}

StressScene stress_scene(const std::string& name, unsigned seed) {
  for (const auto* makers : {&generated(), &from_files()})
    for (const auto& maker : *makers)
      if (maker.first == name) {
        StressScene s = maker.second(static_cast<unsigned>(std::mt19937(seed)()));
        s.name = name;
        return s;
      }
  throw Error("unknown scene " + name);
}

}  // namespace tegotae::test
