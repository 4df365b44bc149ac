// The programs from end to end: summary, recording, determinism.
#include <pty.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "recording.hpp"
#include "tegotae/sim/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;
using nlohmann::json;

namespace {

void check_percentiles(const json& p) {
  REQUIRE(p.size() == 4);
  CHECK(p.at("p50").get<double>() <= p.at("p99").get<double>());
  CHECK(p.at("p99").get<double>() <= p.at("p999").get<double>());
  CHECK(p.at("p999").get<double>() <= p.at("max").get<double>());
}

// The one line of JSON on stdout, all fields there.
json summary_of(const Output& o) {
  INFO("stdout: " << o.out);
  INFO("stderr: " << o.err);
  REQUIRE(std::count(o.out.begin(), o.out.end(), '\n') == 1);
  const json j = json::parse(o.out);
  for (const char* key :
       {"ticks", "seconds", "depth_m", "contacts_max", "penetrating", "force_max_n", "torque_max_nm"}) {
    INFO(key);
    CHECK(j.at(key).is_number());
  }
  CHECK(j.at("completed").is_boolean());
  check_percentiles(j.at("tick_us"));
  check_percentiles(j.at("servo").at("late_us"));
  CHECK(j.at("servo").at("rate_hz").is_number());
  CHECK(j.at("servo").at("missed").is_number_integer());
  return j;
}

// What the program prints on a terminal of its own.
std::string on_a_terminal(const std::string& program, const std::vector<std::string>& arguments) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  REQUIRE(child >= 0);
  if (child == 0) {
    const std::string path = std::string(TEGOTAE_BIN_DIR "/") + program;
    std::vector<char*> argv = {const_cast<char*>(path.c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    ::execv(path.c_str(), argv.data());
    ::_exit(127);
  }
  std::string text;
  char buffer[4096];
  // Reading fails with EIO when the program has gone.
  for (ssize_t n; (n = ::read(terminal, buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  ::close(terminal);
  int status = 0;
  ::waitpid(child, &status, 0);
  return text;
}

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

TEST_CASE("a run in free space follows the pen", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string record = folder / "rec.csv";
  const Output o = run_program("tegotae", "run --fast --json --record " + record + " " + (folder / "scene.toml"));
  CHECK(o.code == 0);
  const json j = summary_of(o);
  CHECK(j.at("completed") == true);
  CHECK(j.at("depth_m").get<double>() == Approx(0.01).margin(2e-4));  // the length of the script's way
  CHECK(j.at("ticks") == 1100);                                       // 0.6 s of script and 0.5 s of rest
  CHECK(j.at("penetrating") == 0);
  CHECK(j.at("force_max_n") == 0.0);
  const std::string text = read_text(record);
  CHECK(text.rfind("tick,substep,t,y_px,y_py,y_pz,y_qw,y_qx,y_qy,y_qz,x_px,x_py,x_pz,x_qw,x_qx,x_qy,x_qz,"
                   "fx,fy,fz,tx,ty,tz,contacts,gap,tick_us",
                   0) == 0);
  CHECK(std::count(text.begin(), text.end(), '\n') >= 1101);
}

TEST_CASE("a run cut short by --seconds is done but not completed", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const Output o = run_program("tegotae", "run --fast --json --seconds 0.25 " + (folder / "scene.toml"));
  CHECK(o.code == 0);
  const json j = summary_of(o);
  CHECK(j.at("completed") == false);
  CHECK(j.at("ticks") == 250);
  CHECK(j.at("seconds").get<double>() == Approx(0.25));
}

TEST_CASE("a run that does not arrive is a failure", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  // The hand wants to go through the floor.
  folder.write("floor.obj", "v -200 -200 0\nv 200 -200 0\nv 200 200 0\nv -200 200 0\nf 1 2 3\nf 1 3 4\n");
  folder.write("path.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.02,1,0,0,0\n0.5,0,0,-0.02,1,0,0,0\n");
  std::string scene = read_text(folder / "scene.toml");
  folder.write("scene.toml", scene.replace(scene.find("tet.obj"), 7, "floor.obj"));
  const Output o = run_program("tegotae", "run --fast --json " + (folder / "scene.toml"));
  CHECK(o.code == 1);
  const json j = summary_of(o);
  CHECK(j.at("completed") == false);
  CHECK(j.at("penetrating") == 0);
  CHECK(j.at("contacts_max").get<int>() > 0);
  CHECK(j.at("force_max_n").get<double>() > 0.5);
}

TEST_CASE("in real time the servo runs at 1 kHz", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const json j = summary_of(run_program("tegotae", "run --json " + (folder / "scene.toml")));
  // Counts, not latencies: the machine may be busy.
  CHECK(j.at("seconds").get<double>() == Approx(1.1).epsilon(0.2));
  CHECK(j.at("servo").at("rate_hz").get<double>() == Approx(1000).epsilon(0.2));
  CHECK(j.at("ticks").get<int>() > 100);
}

TEST_CASE("the progress line is for terminals", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string scene = folder / "scene.toml";
  CHECK(run_program("tegotae", "run " + scene).out.find('\r') == std::string::npos);
  CHECK(on_a_terminal("tegotae", {"run", scene}).find("\r\033[K") != std::string::npos);
  CHECK(on_a_terminal("tegotae", {"run", "--json", scene}).find("\033[K") == std::string::npos);
}

TEST_CASE("Ctrl-C ends a run and keeps the recording", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string record = folder / "rec.csv";
  // timeout(1) sends SIGINT after 0.4 s of a run of 1.1 s and tells the program's own exit code.
  const std::string command = std::string("timeout --preserve-status -s INT 0.4 ") +
                              TEGOTAE_BIN_DIR "/tegotae run --json --record " + record + " " + (folder / "scene.toml") +
                              " >" + (folder / "out");
  const int status = std::system(command.c_str());
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 1);
  const json j = json::parse(read_text(folder / "out"));
  CHECK(j.at("completed") == false);
  CHECK(j.at("seconds").get<double>() < 1.0);
  const std::string text = read_text(record);
  REQUIRE(!text.empty());
  CHECK(text.back() == '\n');
  CHECK(std::count(text.begin(), text.end(), '\n') > j.at("ticks").get<int>());
}

TEST_CASE("the peg goes in, and the same run gives the same recording byte for byte, on any load", "[programs]") {
  const TempFolder folder;
  for (const std::string ratio : {"0.94", "0.99"}) {
    INFO(ratio);
    const Output program = run_program("peg_in_hole", "--fast --json --ratio " + ratio + " --scene-out " +
                                                          (folder / "out") + " --record " + (folder / "program.csv"));
    CHECK(program.code == 0);
    const json j = summary_of(program);
    CHECK(j.at("completed") == true);
    CHECK(j.at("depth_m").get<double>() == Approx(0.04).margin(1e-4));  // the hole's depth
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

TEST_CASE("check reports on meshes and scenes", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const Output mesh = run_program("tegotae", "check " + (folder / "tet.obj"));
  CHECK(mesh.code == 0);
  CHECK(mesh.out.find("4 triangles, 4 vertices, 1 component, closed") != std::string::npos);
  const Output scene = run_program("tegotae", "check " + (folder / "scene.toml"));
  CHECK(scene.code == 0);
  CHECK(scene.out.find("peg (held)") != std::string::npos);
  CHECK(scene.out.find("start: free") != std::string::npos);
}
