// The peg-in-hole program from end to end, in virtual time: it goes in, touches on both sides, and repeats.
#include <atomic>
#include <thread>

#include "apps/program_summary.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "recording.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;
using nlohmann::json;

namespace {

// Two-sided contact, told from the geometry alone: the tip is so far below the rim that both chamfers are passed, and
// moved by 25 um either way along the horizontal direction of its tilt the peg hits the hole, which it does not at the
// pose itself. Upright it would have 0.1 mm (0.99) or 0.6 mm (0.94) to each side; so it touches walls that face each
// other, and with normals that are level but for the tilt, n_i . n_j < -0.5.
bool between_two_walls(const FclOracle& oracle, const Pose& X) {
  constexpr double kNudge = 2.5e-5;  // m; more than twice the widest gap that contacts keep
  const Vec3 axis = X.q * Vec3::UnitZ();
  const Vec3 side = Vec3(axis.x(), axis.y(), 0).normalized();
  const auto hits = [&](double step) { return !oracle.intersecting({X.q, X.p + step * side}).empty(); };
  return !hits(0) && hits(kNudge) && hits(-kNudge);
}

// How many of every tenth recorded pose are so, of those with a tilt and the tip 2 to 35 mm deep: not on the bottom.
int count_between_two_walls(const std::string& scene, const std::string& recording) {
  constexpr double kTip = -0.025, kChamfers = 0.002, kNearBottom = 0.035;  // m
  const FclOracle oracle(load_scene(scene).scene);
  int count = 0;
  const std::vector<RecordedRow> rows = read_recording(recording);
  for (std::size_t i = 0; i < rows.size(); i += 10) {
    const RecordedRow& row = rows[i];
    const double depth = -(row.x * Vec3(0, 0, kTip)).z();
    const double tilt = (row.x.q * Vec3::UnitZ()).head<2>().norm();
    if (row.contacts < 2 || depth < kChamfers || depth > kNearBottom || tilt < 1e-3) continue;
    if (between_two_walls(oracle, row.x)) ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("the peg goes in, and the same run gives the same recording byte for byte, on any load", "[programs]") {
  const TempFolder folder;
  for (const std::string ratio : {"0.94", "0.99"}) {
    INFO(ratio);
    const Output program = run_program("peg_in_hole", "--fast --json --ratio " + ratio + " --scene-out " +
                                                          (folder / "out") + " --record " + (folder / "program.csv"));
    CHECK(program.code == 0);
    const json j = summary_of(program);
    CHECK(j.at("completed") == true);
    CHECK(j.at("depth_m").get<double>() == Approx(0.06).margin(1e-4));  // 20 mm above the hole, 40 mm in it
    CHECK(j.at("contacts_max").get<int>() >= 2);
    CHECK(j.at("penetrating") == 0);
    const std::string recording = read_text(folder / "program.csv");
    CHECK(std::count(recording.begin(), recording.end(), '\n') > 8000);

    CHECK(count_between_two_walls(TEGOTAE_MODELS_DIR "/peg_in_hole_" + ratio + ".toml", folder / "program.csv") > 20);

    // The files in models/ are what the program runs.
    for (const std::string& file : {"peg_in_hole_" + ratio + ".toml", "insert_" + ratio + ".csv",
                                    "peg_" + ratio + ".obj", std::string("hole_20.obj")})
      CHECK(read_text(folder / ("out/" + file)) == read_text(TEGOTAE_MODELS_DIR "/" + file));
    std::atomic<bool> stop{false};
    std::vector<std::thread> load;
    for (unsigned i = 0; i < std::thread::hardware_concurrency(); ++i)
      load.emplace_back([&] {
        while (!stop.load(std::memory_order_relaxed)) {
        }
      });
    const Output loaded = run_program("tegotae", std::string("run --fast --json " TEGOTAE_MODELS_DIR "/peg_in_hole_") +
                                                     ratio + ".toml --seconds 3.6 --record " + (folder / "loaded.csv"));
    stop = true;
    for (std::thread& t : load) t.join();
    CHECK(loaded.code == 0);
    // Cut short where the peg has hit the rim, slid, gone in and jammed: a beginning of the other recording.
    const std::string beginning = read_text(folder / "loaded.csv");
    CHECK(std::count(beginning.begin(), beginning.end(), '\n') > 3600);
    CHECK(recording.compare(0, beginning.size(), beginning) == 0);
  }
}

TEST_CASE("a scene in which nothing rubs gives the recording of one without friction, byte for byte", "[programs]") {
  const TempFolder folder;
  for (const char* file : {"hole_20.obj", "peg_0.99.obj", "insert_0.99.csv"})
    std::filesystem::copy_file(std::string(TEGOTAE_MODELS_DIR "/") + file, folder / file);
  const std::string scene = read_text(TEGOTAE_MODELS_DIR "/peg_in_hole_0.99.toml");
  const auto recording = [&](const std::string& name, const std::string& friction) {
    folder.write(name + ".toml", scene + "\n" + friction);
    // As far as the peg has hit the rim, slid, gone in and jammed.
    const Output run = run_program("tegotae", "run --fast --json " + (folder / (name + ".toml")) +
                                                  " --seconds 3.6 --record " + (folder / (name + ".csv")));
    CHECK(run.code == 0);
    CHECK(summary_of(run).at("contacts_max").get<int>() >= 2);
    return read_text(folder / (name + ".csv"));
  };
  const std::string pair = "\n[[friction.pair]]\nparts = [\"peg\", \"hole\"]\nmu = ";
  const std::string without = recording("without", "");
  CHECK(std::count(without.begin(), without.end(), '\n') > 3500);
  CHECK(recording("zero", "[friction]\nmu = 0\n") == without);
  CHECK(recording("zero_pair", "[friction]\nmu = 0.5\n" + pair + "0\n") == without);
  CHECK(recording("rubs", "[friction]\nmu = 0\n" + pair + "0.2\n") != without);
}
