// Looks at recordings for the soak run: judge RECORDING. Prints one line of JSON: rows, rows in contact, the largest
// force and torque, rows above the limits of the simulated device, and how many poses were asked of FCL and intersect.
#include <cmath>
#include <cstdio>

#include "fcl_oracle.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;

namespace {

// N and N·m, docs/scene-file.md; a recording's numbers are exact.
constexpr double kForceLimit = 8.5, kTorqueLimit = 0.188, kRounding = 1e-9;
// FCL takes up to a millisecond a pose: of a longer recording an even sample is asked.
constexpr std::size_t kMaxPoses = 4000;

void judge(const std::string& path) {
  const Recording recording = read_recording(path);
  const std::vector<RecordFrame>& rows = recording.frames;
  const test::FclOracle fcl(load_scene(recording.info.scene).scene);
  const std::size_t every = rows.size() / kMaxPoses + 1;
  std::size_t touching = 0, over = 0, asked = 0, intersecting = 0;
  double force = 0, torque = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double f = rows[i].wrench.force.norm(), t = rows[i].wrench.torque.norm();
    force = std::fmax(force, f);
    torque = std::fmax(torque, t);
    touching += rows[i].contacts > 0;
    // So that a NaN counts too.
    over += !(f <= kForceLimit * (1 + kRounding) && t <= kTorqueLimit * (1 + kRounding));
    if (i % every != 0 && i + 1 < rows.size()) continue;
    ++asked;
    intersecting += !fcl.intersecting(rows[i].x).empty();
  }
  std::printf(
      "{\"rows\": %zu, \"touching\": %zu, \"force\": %.9g, \"torque\": %.9g, \"over\": %zu, \"asked\": %zu, "
      "\"intersecting\": %zu}\n",
      rows.size(), touching, force, torque, over, asked, intersecting);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw Error("usage: soak_judge RECORDING");
  judge(argv[1]);
} catch (const std::exception& e) {
  std::fprintf(stderr, "soak_judge: %s\n", e.what());
  return 2;
}
