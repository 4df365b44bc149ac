// tegotae-device and the programs that attach to it, as a user runs them.
#include <sys/mman.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "spawn.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/pose.hpp"
#include "tegotae/transport/channel.hpp"

using namespace tegotae;
using namespace tegotae::test;
using nlohmann::json;

namespace {

const std::string kName = "tegotae-program-" + std::to_string(getpid());
/// Killed devices leave their names.
struct Tidy {
  ~Tidy() {
    for (const char* side : {"", "-left", "-right"}) shm_unlink(("/" + kName + side).c_str());
  }
} const tidy;

const std::string kDevice = TEGOTAE_BIN_DIR "/tegotae-device";

/// A running device, after its greeting.
std::unique_ptr<Program> start(std::vector<std::string> arguments, std::string* greeting = nullptr) {
  arguments.insert(arguments.begin(), kDevice);
  auto device = std::make_unique<Program>(arguments);
  std::string text;
  for (int i = 0; i < 5; ++i) text += device->line() + "\n";  // the first state last
  if (greeting != nullptr) *greeting = text;
  return device;
}

std::unique_ptr<Program> start_simulated(const TempFolder& folder, const std::string& name = kName) {
  return start({"--type", "simulated", "--script", folder / "path.csv", "--name", name});
}

json status(const std::string& name = kName) {
  const Output o = run_program("tegotae-device", "--status --json --name " + name);
  REQUIRE(o.code == 0);
  return json::parse(o.out);
}

void sleep_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

}  // namespace

TEST_CASE("bad usage of tegotae-device is one line and code 2", "[device_program]") {
  struct Case {
    const char* arguments;
    const char* says;
  };
  const Case cases[] = {{"", "--type or --status"},
                        {"--type pencil", "pencil"},
                        {"--type simulated", "--script"},
                        {"--type simulated --script /nonexistent.csv", "/nonexistent.csv"},
                        {"--type gamepad --script x.csv", "--script is for"},
                        {"--type simulated --script x.csv --pen Left", "--pen is for"},
                        {"--json", "--status"},
                        {"--status --type gamepad", "excludes"},
                        {"--type gamepad --dead-man-button 32", "dead-man-button"},
                        {"--type openhaptics", "libHD.so"},
                        {"--status --name tegotae-nobody", "tegotae-nobody"}};
  for (const Case& c : cases) {
    INFO(c.arguments);
    const Output o = run_program("tegotae-device", c.arguments);
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK(o.err.find("tegotae-device: ") == 0);
    CHECK(o.err.find(c.says) != std::string::npos);
  }
  const TempFolder folder;
  write_small_scene(folder);
  const Output rate = run_program("tegotae-device", "--type simulated --rate 9000 --script " + (folder / "path.csv"));
  CHECK(rate.code == 2);
  CHECK(rate.err.find("rate") != std::string::npos);
}

TEST_CASE("an input device that is not there is said in one line", "[device_program]") {
  const Output mouse = run_program("tegotae-device", "--type spacemouse");
  CHECK(mouse.code == 2);
  CHECK((mouse.err.find("spacenavd") != std::string::npos || mouse.err.find("libspnav-dev") != std::string::npos));
  const Output pad = run_program("tegotae-device", "--type gamepad");
  CHECK(pad.code == 2);
  CHECK((pad.err.find("none found") != std::string::npos || pad.err.find("libsdl2-dev") != std::string::npos));
}

TEST_CASE("a device tells of itself, is told of by another process, and ends on a signal", "[device_program]") {
  const TempFolder folder;
  write_small_scene(folder);
  const int signal = GENERATE(SIGTERM, SIGINT);
  std::string greeting;
  const std::unique_ptr<Program> device =
      start({"--type", "simulated", "--script", folder / "path.csv", "--name", kName, "--rate", "500"}, &greeting);
  CHECK(greeting.find("/" + kName + ": simulated, process " + std::to_string(device->pid())) == 0);
  CHECK(greeting.find("real time: ") != std::string::npos);
  CHECK(greeting.find("--device shm:" + kName) != std::string::npos);
  // 2 (b - B) / T with the simulated pen's and the default coupling's torsional damping, 0.04 and 0.004 N m s/rad.
  CHECK(greeting.find("stability: stiffness 800 N/m") != std::string::npos);
  CHECK(greeting.find("(limit 36 N·m/rad)") != std::string::npos);
  CHECK(greeting.find("force off: no application asks for force") != std::string::npos);

  json j = status();
  for (int i = 0; i < 3000 && j.at("ticks") < 100; ++i) {
    sleep_ms(20);
    j = status();
  }
  CHECK(j.at("name") == "/" + kName);
  CHECK(j.at("device") == "simulated");
  CHECK(j.at("pid") == device->pid());
  CHECK(j.at("reason_code") == TEGOTAE_SHM_REASON_SOFTWARE);
  CHECK(j.at("application") == false);
  CHECK(j.at("set_rate_hz") == 500);
  // Every period is a tick or a counted miss, whatever else the machine does.
  const double periods = j.at("ticks").get<double>() + j.at("missed").get<double>();
  CHECK(periods <= 500 * j.at("uptime_s").get<double>() + 2);
  CHECK(j.at("rate_hz").get<double>() > 0);
  CHECK(j.at("rate_hz").get<double>() <= 501);
  CHECK(j.at("ticks") >= 100);
  CHECK(j.at("late_us").at("p50") <= j.at("late_us").at("max"));
  CHECK(j.at("compute_us").at("max") > 0);
  CHECK(j.at("missed").is_number());
  CHECK(j.at("realtime").at("fifo").is_boolean());
  const Output text = run_program("tegotae-device", "--status --name " + kName);
  CHECK(text.out.find("/" + kName + ": force off: no application asks for force") == 0);
  CHECK(text.out.find("500 Hz") != std::string::npos);

  const Output second =
      run_program("tegotae-device", "--type simulated --script " + (folder / "path.csv") + " --name " + kName);
  CHECK(second.code == 2);
  CHECK(second.err.find("process " + std::to_string(device->pid())) != std::string::npos);

  CHECK(device->end(signal) == 0);
  CHECK(device->rest().find("ticks") != std::string::npos);
  CHECK_THROWS_AS(ChannelReader::open(kName), Error);
  CHECK(run_program("tegotae-device", "--status --name " + kName).code == 2);
}

TEST_CASE("a scene runs with the device of another process; two at once", "[device_program]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string scene = folder / "scene.toml";
  const std::unique_ptr<Program> left = start_simulated(folder, kName + "-left");
  const std::unique_ptr<Program> right = start_simulated(folder, kName + "-right");
  const auto attach = [&](const std::string& side) {
    return std::make_unique<Program>(std::vector<std::string>{
        TEGOTAE_BIN_DIR "/tegotae", "run", scene, "--json", "--seconds", "3", "--device", "shm:" + kName + "-" + side});
  };
  const std::unique_ptr<Program> a = attach("left"), b = attach("right");
  sleep_ms(1000);
  const Output third = run_program("tegotae", "run --json --device shm:" + kName + "-left " + scene);
  CHECK(third.code == 2);
  CHECK(third.err.find("another application is attached") != std::string::npos);
  for (Program* p : {a.get(), b.get()}) {
    const json j = json::parse(p->rest());
    CHECK(p->wait() == 0);
    // The hand waits for the application and then takes the part along its script.
    CHECK(j.at("completed") == true);
    CHECK(j.at("depth_m").get<double>() == Approx(0.01).margin(3e-4));
    CHECK(j.at("device_losses") == 0);
    CHECK(j.at("servo").at("rate_hz").get<double>() <= 1001);
  }
  CHECK(status(kName + "-left").at("pid") == left->pid());
  CHECK(status(kName + "-right").at("pid") == right->pid());
}

TEST_CASE("a run outlives its device: the part stays, the next device is taken", "[device_program]") {
  const TempFolder folder;
  write_small_scene(folder);
  std::unique_ptr<Program> device = start_simulated(folder);
  Program run({TEGOTAE_BIN_DIR "/tegotae", "run", folder / "scene.toml", "--json", "--seconds", "4", "--device",
               "shm:" + kName, "--record", folder / "rec.csv"});
  for (int i = 0; i < 500 && !status().at("application").get<bool>(); ++i) sleep_ms(10);
  sleep_ms(200);
  device->end(SIGKILL);
  sleep_ms(700);
  device = start_simulated(folder);
  const json j = json::parse(run.rest());
  CHECK(run.wait() == 0);
  CHECK(j.at("device_losses") >= 1);
  CHECK(j.at("penetrating") == 0);

  // The recording has a gap, over which the part has not moved.
  std::ifstream in(folder / "rec.csv");
  std::string line;
  std::getline(in, line);
  double last_t = 0, gap = 0, moved = 0;
  Vec3 last_x = Vec3::Zero();
  for (int row = 0; std::getline(in, line); ++row) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    double tick, substep, t, y[7];
    Vec3 x;
    cells >> tick >> substep >> t;
    for (double& v : y) cells >> v;
    cells >> x.x() >> x.y() >> x.z();
    if (row > 0 && t - last_t > gap) {
      gap = t - last_t;
      moved = (x - last_x).norm();
    }
    last_t = t;
    last_x = x;
  }
  CHECK(gap > 0.5);
  CHECK(moved < 2e-3);  // the first tick after it follows the new hand, which starts where the part is
}

TEST_CASE("a run cannot take a device that is not there, nor in virtual time", "[device_program]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string scene = folder / "scene.toml";
  const Output absent = run_program("tegotae", "run --device shm:tegotae-nobody " + scene);
  CHECK(absent.code == 2);
  CHECK(absent.err.find("tegotae-nobody") != std::string::npos);
  CHECK(absent.err.find("start its device first") != std::string::npos);
  CHECK(run_program("tegotae", "run --device usb:3 " + scene).err.find("shm:NAME") != std::string::npos);
  CHECK(run_program("tegotae", "run --fast --device shm:x " + scene).code == 2);
}

TEST_CASE("an OpenHaptics device runs in its process, and its loss is told", "[device_program]") {
  setenv("LD_LIBRARY_PATH", TEGOTAE_FAKE_HD_FOLDER, 1);
  setenv("FAKE_HD_SCHEDULER", "1500", 1);  // the stand-in fails after so many milliseconds
  std::string greeting;
  const std::unique_ptr<Program> device = start({"--type", "openhaptics", "--pen", "Left", "--name", kName}, &greeting);
  CHECK(greeting.find("Stand-in Premium") != std::string::npos);
  CHECK(status().at("device") == "Stand-in Premium");
  CHECK(device->line() == "  force off: the device does not answer");
  CHECK(status().at("reason_code") == TEGOTAE_SHM_REASON_DISCONNECTED);
  CHECK(device->end(SIGTERM) == 0);
  const Output wrong = run_program("tegotae-device", "--type openhaptics --pen Right --name " + kName);
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("Right") != std::string::npos);
  unsetenv("LD_LIBRARY_PATH");
  unsetenv("FAKE_HD_SCHEDULER");
}
