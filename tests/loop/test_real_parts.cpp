// Parts that nobody here made, put together by scripts of a clumsy hand: through the loop itself, and through the
// program with a scene and a script in files. Every committed pose is free by FCL, and by Coal where it is installed.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "absent.hpp"
#include "apps/run_program.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "recording.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;
namespace fs = std::filesystem;

namespace {

/// A fit of the parts folder: files in meters, put together where both file frames agree.
struct Fit {
  std::string held, fixed;
  double start;  ///< height (m) of the held part over its place at which the two are apart
  double rim;    ///< height at which the tip is level with the rim, m
  double end;    ///< height that the hand goes to at last, m; below zero it presses on the floor
  bool floor;    ///< whether the fixed part has one; otherwise the held part goes through
};

const Fit kRoundPeg = {"factory/factory_round_peg_8mm_loose.obj",
                       "factory/factory_round_hole_8mm_subdiv_3x.obj",
                       0.010,
                       0.009,
                       -0.002,
                       false};
const Fit kRectangularPeg = {"industreal/industreal_rectangular_peg_8mm.obj",
                             "industreal/industreal_tray_insert_rectangular_peg_8mm.obj",
                             0.030,
                             0.025,
                             -0.001,
                             true};

constexpr double kDegree = 0.017453292519943295;

/// Where the hand wants the held part: upright but for `tilt` about the axis (ax, ay), its origin at (x, y, z).
struct Waypoint {
  double t, x, y, z, tilt_deg, ax, ay;
};

/// Comes down off-center and tilted, presses on the rim, finds the opening, straightens up, goes in while it sways.
std::vector<Waypoint> clumsy_hand(const Fit& fit, double off, double tilt_deg, double ax, double ay) {
  const double z = fit.rim, mid = 0.5 * (fit.rim + fit.end);
  return {{0.0, off, -0.4 * off, fit.start, tilt_deg, ax, ay},
          {0.3, off, -0.4 * off, z - 1.5e-3, tilt_deg, ax, ay},
          {0.7, 0, 0, z - 1.5e-3, tilt_deg, ax, ay},
          {1.0, 0.1e-3, 0, z - 3e-3, 0.3 * tilt_deg, ax, ay},
          {1.2, 0, 0, z - 3e-3, 0, ax, ay},
          {1.5, 0.5e-3, 0.3e-3, mid, -tilt_deg, ay, ax},
          {1.8, 0, 0, mid, 0, ay, ax},
          {2.1, 0, 0, fit.end, 0, ay, ax},
          {2.3, 0, 0, fit.end, 0, ay, ax}};
}

std::string script_text(const std::vector<Waypoint>& way) {
  std::ostringstream csv;
  csv.precision(12);
  csv << "t,px,py,pz,qw,qx,qy,qz\n";
  for (const Waypoint& w : way) {
    const Quat q = rotation(w.tilt_deg * kDegree * Vec3(w.ax, w.ay, 0).normalized());
    csv << w.t << ',' << w.x << ',' << w.y << ',' << w.z << ',' << q.w() << ',' << q.x() << ',' << q.y() << ',' << q.z()
        << '\n';
  }
  return csv.str();
}

std::string part(const std::string& file) {
  return (fs::path(TEGOTAE_PARTS_DIR) / file).lexically_normal().string();
}

bool skipped(const Fit& fit) {
  for (const std::string& file : {fit.held, fit.fixed}) {
    if (fs::exists(part(file))) continue;
    test::note_absent("no part file " + file);
    return true;
  }
  return false;
}

/// Writes scene.toml and path.csv for the fit; returns the scene's path.
std::string write_scene(const TempFolder& folder, const Fit& fit, const std::vector<Waypoint>& way,
                        const std::string& resolver) {
  const Quat q = rotation(way[0].tilt_deg * kDegree * Vec3(way[0].ax, way[0].ay, 0).normalized());
  std::ostringstream toml;
  toml.precision(12);
  toml << "[[part]]\nname = \"fixed\"\nmesh = \"" << part(fit.fixed) << "\"\n"
       << "[[part]]\nname = \"held\"\nheld = true\nmesh = \"" << part(fit.held) << "\"\n"
       << "position = [" << way[0].x << ", " << way[0].y << ", " << way[0].z << "]\n"
       << "orientation = [" << q.w() << ", " << q.x() << ", " << q.y() << ", " << q.z() << "]\n"
       << "[contact]\nresolver = \"" << resolver << "\"\n"
       << "[device]\nscript = \"path.csv\"\n";
  folder.write("path.csv", script_text(way));
  folder.write("scene.toml", toml.str());
  return folder / "scene.toml";
}

/// The held part is in its place: on the floor by no more than the gap that contacts keep, or through.
void check_in_place(const Fit& fit, const Pose& X, double height_tolerance) {
  CHECK(X.p.z() == Approx(fit.floor ? 0.0 : fit.end).margin(height_tolerance));
  if (fit.floor) CHECK(X.p.z() > 0);
  CHECK(std::abs(rotation_vector(X.q).x()) < 1 * kDegree);
  CHECK(std::abs(rotation_vector(X.q).y()) < 1 * kDegree);
}

void run_loop(const Fit& fit, double off, double tilt_deg, double ax, double ay, const std::string& resolver) {
  const TempFolder folder;
  const SceneFile file = load_scene(write_scene(folder, fit, clumsy_hand(fit, off, tilt_deg, ax, ay), resolver));
  HapticLoop loop(file.scene);
  const FclOracle oracle(file.scene);
  int touching = 0, touching_inside = 0, intersecting = 0;
  double held_back = 0;  // farthest that the parts kept X from Y
  for (int i = 0; 1e-3 * i <= file.script.end(); ++i) {
    const Pose Y = file.script.pose(1e-3 * i);
    const TickReport& tick = loop.step(Y, 1e-3);
    for (const Pose& X : tick.substeps)
      if (!oracle.intersecting(X).empty()) ++intersecting;
    if (tick.contacts > 0) ++touching;
    if (tick.contacts > 0 && tick.proxy.X.p.z() < fit.rim - 2e-3) ++touching_inside;
    held_back = std::max(held_back, (Y * loop.center() - tick.proxy.X * loop.center()).norm());
  }
  CHECK(intersecting == 0);
  // Nothing of this was in the open.
  CHECK(touching > 300);
  CHECK(touching_inside > 100);
  CHECK(held_back > 0.5e-3);
  check_in_place(fit, loop.report().proxy.X, 2 * *loop.contact().l_min);
}

/// Coal's verdict over the recording and the path between its rows, where Python has Coal and the parts' checker.
void check_with_coal(const std::string& scene, const std::string& recording) {
  const fs::path checker = fs::path(TEGOTAE_PARTS_DIR) / "../tools/verify_recording.py";
  if (!fs::exists(checker) || std::system("python3 -c 'import coal, trimesh' >/dev/null 2>&1") != 0) {
    test::note_absent("no Coal for Python, or no checker of recordings beside the parts");
    return;
  }
  const std::string command =
      "python3 " + checker.string() + " " + scene + " " + recording + " --path-step 5e-5 >" + recording + ".coal 2>&1";
  const int status = std::system(command.c_str());
  INFO(read_text(recording + ".coal"));
  CHECK(WEXITSTATUS(status) == 0);
}

void run_program_on(const Fit& fit, double off, double tilt_deg, double ax, double ay, bool ask_coal) {
  const TempFolder folder;
  const std::string scene = write_scene(folder, fit, clumsy_hand(fit, off, tilt_deg, ax, ay), "lp");
  const std::string recording = folder / "recording.csv";
  const Output o = run_program("tegotae", "run --fast --json --record " + recording + " " + scene);
  INFO("stdout: " << o.out);
  INFO("stderr: " << o.err);
  CHECK(o.code == 0);
  CHECK(o.out.find("\"completed\":true") != std::string::npos);
  const SceneFile file = load_scene(scene);
  const FclOracle oracle(file.scene);
  const std::vector<RecordedRow> rows = read_recording(recording);
  REQUIRE(rows.size() > 2300);
  CHECK(std::count_if(rows.begin(), rows.end(),
                      [&](const RecordedRow& r) { return !oracle.intersecting(r.x).empty(); }) == 0);
  // The hand is a spring: what friction leaves of its way is far below 0.3 mm.
  check_in_place(fit, rows.back().x, 3e-4);
  if (ask_coal) check_with_coal(scene, recording);
}

}  // namespace

TEST_CASE("the 8 mm round peg goes into its hole", "[real_parts]") {
  if (skipped(kRoundPeg)) return;
  SECTION("off to one side, tilted to it, lp") {
    run_loop(kRoundPeg, 0.8e-3, 3, 0, 1, "lp");
  }
  SECTION("off, tilted away, lp") {
    run_loop(kRoundPeg, 0.6e-3, -2.5, 1, 0.4, "lp");
  }
  SECTION("off to one side, tilted to it, qp") {
    run_loop(kRoundPeg, 0.8e-3, 3, 0, 1, "qp");
  }
  SECTION("the program") {
    run_program_on(kRoundPeg, 0.8e-3, 2, 0, 1, false);
  }
}

TEST_CASE("the rectangular peg goes into its tray", "[real_parts]") {
  if (skipped(kRectangularPeg)) return;
  SECTION("off to one side, tilted to it, lp") {
    run_loop(kRectangularPeg, 1e-3, 3, 0, 1, "lp");
  }
  SECTION("off, tilted away, lp") {
    run_loop(kRectangularPeg, 0.8e-3, -2, 1, 0.5, "lp");
  }
  SECTION("off to one side, tilted to it, qp") {
    run_loop(kRectangularPeg, 1e-3, 3, 0, 1, "qp");
  }
  SECTION("the program") {
    run_program_on(kRectangularPeg, 1e-3, 2.5, 1, 0.3, false);
  }
}

// Takes a minute and more, so it is not in the default selection.
TEST_CASE("Coal too finds the recordings free, and the path between their rows", "[.][coal]") {
  if (skipped(kRoundPeg) || skipped(kRectangularPeg)) return;
  SECTION("round peg") {
    run_program_on(kRoundPeg, 0.8e-3, 2, 0, 1, true);
  }
  SECTION("rectangular peg") {
    run_program_on(kRectangularPeg, 1e-3, 2.5, 1, 0.3, true);
  }
}
