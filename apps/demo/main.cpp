// The demo: a hand carries a peg into its hole in real time, off center and tilted at first. It needs no library of
// file formats and no web server, so that it is built in minutes; `peg_in_hole` is the same with recordings and the
// page.
#include <algorithm>
#include <cstdio>
#include <string>

#include "core/number_text.hpp"
#include "models/shapes.hpp"
#include "peg_in_hole/peg_script.hpp"
#include "shared/process.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/session/rig.hpp"

using namespace tegotae;

namespace {

constexpr double kHoleDiameter = 0.02, kStartHeight = 0.01;  // m
constexpr double kSettleTime = 0.5;                          // s

struct Demo {
  Scene scene;
  StylusScript script;
};

Demo peg_in_hole(double ratio) {
  shapes::Block block;
  block.hole_diameter = kHoleDiameter;
  shapes::Peg peg;
  peg.diameter = ratio * kHoleDiameter;
  const Vec3 tip(0, 0, -peg.length / 2);
  Demo demo{{}, StylusScript(apps::insertion_script({tip, kStartHeight, block.depth}))};
  demo.scene.add_fixed("hole", shapes::block_with_hole(block));
  demo.scene.add_held("peg", shapes::peg(peg), demo.script.pose(demo.script.begin()));
  return demo;
}

/// What was seen of a run.
struct Seen {
  std::size_t contacts = 0;  ///< most at once
  double force = 0;          ///< N, largest
};

void show(const Rig& rig, double start, Seen& seen) {
  seen.contacts = std::max(seen.contacts, rig.contacts().size());
  seen.force = std::max(seen.force, rig.pen().wrench.force.norm());
  if (rig.steps() % 500 != 0) return;
  std::printf("  %4.1f s  peg %5s mm down, %2zu contacts, %5.2f N %s\n", rig.time(),
              fixed_text(1e3 * (start - rig.part().p.z() - kStartHeight), 1).c_str(), rig.contacts().size(),
              rig.pen().wrench.force.norm(),
              std::string(static_cast<std::size_t>(10 * rig.pen().wrench.force.norm()), '#').c_str());
  std::fflush(stdout);
}

/// One fit; true when the peg stands at the bottom of its hole.
bool run(double ratio) {
  const Demo demo = peg_in_hole(ratio);
  SimulatedDevice pen({}, demo.script);
  Rig rig(demo.scene, pen);
  const double start = rig.part().p.z();
  std::printf("A peg of %s mm into a hole of %s mm, in real time\n",
              number_text(1e3 * ratio * kHoleDiameter, 4).c_str(), number_text(1e3 * kHoleDiameter, 4).c_str());
  Seen seen;
  rig.start();
  rig.run(demo.script.end() + kSettleTime, [&](const Rig& r) { show(r, start, seen); });
  rig.stop();
  const double left = rig.part().p.z() - demo.script.pose(demo.script.end()).p.z();
  const bool in = left < 0.002;  // the hand presses on the bottom by a millimeter
  std::printf("  %s: at most %zu contacts and %.2f N, servo %.0f Hz\n\n", in ? "in its place" : "not in its place",
              seen.contacts, seen.force, rig.servo_statistics().rate_hz);
  return in;
}

int answer(const std::string& option) {
  if (option == "--version") {
    std::puts("tegotae " TEGOTAE_VERSION_STRING);
    return 0;
  }
  std::fputs("demo: carries a peg into its hole twice, in real time; it takes --help and --version only\n",
             option == "--help" ? stdout : stderr);
  return option == "--help" ? 0 : 2;
}

int run_all() {
  bool in = true;
  for (const double ratio : {0.94, 0.99}) in = run(ratio) && in;
  return in ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  apps::prepare_process();
  return apps::finish_output("demo", argc > 1 ? answer(argv[1]) : run_all());
} catch (const Error& e) {
  std::fprintf(stderr, "demo: %s\n", e.what());
  return 2;
}
