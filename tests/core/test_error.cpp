// Errors say to programs what they say to people.
#include <fstream>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/device/script.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/record/recording.hpp"
#include "tegotae/resolve/kind.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "tegotae/servo/servo.hpp"
#include "tegotae/transport/attachment.hpp"

using namespace tegotae;

namespace {

template <class F>
Error thrown(F f) {
  try {
    f();
  } catch (const Error& e) {
    return e;
  }
  FAIL("nothing was thrown");
  return Error("");
}

}  // namespace

TEST_CASE("errors say what kind they are, and where", "[error]") {
  CHECK(Error("plain").kind() == ErrorKind::other);
  CHECK(Error("plain").place().file.empty());

  const Error mesh = thrown([] { load_mesh("/no/such/part.stl"); });
  CHECK(mesh.kind() == ErrorKind::file);
  CHECK(mesh.place().file == "/no/such/part.stl");

  const Error absent = thrown([] { load_scene("/no/such/scene.toml"); });
  CHECK(absent.kind() == ErrorKind::file);
  CHECK(absent.place().file == "/no/such/scene.toml");

  const std::string path = std::string(TEGOTAE_BIN_DIR) + "/test_error.toml";
  std::ofstream(path) << "unit = \"mm\"\n\n[contact]\nl_min = -1\n";
  const Error key = thrown([&] { load_scene(path); });
  CHECK(key.kind() == ErrorKind::file);
  CHECK(key.place().file == path);
  CHECK(key.place().line == 4);
  CHECK(key.place().key == "contact.l_min");

  Scene scene;
  scene.add_fixed("wall", test::box(Vec3(1, 1, 1)));
  scene.add_held("peg", test::box(Vec3(0.5, 0.5, 0.8)), {Quat::Identity(), Vec3(0.6, 0, 0)});
  const Error overlap = thrown([&] { HapticLoop loop(scene); });
  CHECK(overlap.kind() == ErrorKind::overlap);
  CHECK(overlap.place().part == "wall");

  scene.parts[1].pose.p.x() = 2;
  scene.contact.density = -1;
  const Error setting = thrown([&] { HapticLoop loop(scene); });
  CHECK(setting.kind() == ErrorKind::setting);
  CHECK(setting.place().key == "contact.density");

  scene.contact.density = 1;
  scene.contact.tick_budget = 0;
  CHECK(thrown([&] { HapticLoop loop(scene); }).place().key == "contact.tick_budget");
  scene.contact.tick_budget = 1e-3;
  scene.parts[1].held = false;
  const Error nobody = thrown([&] { HapticLoop loop(scene); });
  CHECK(nobody.kind() == ErrorKind::setting);
  CHECK(nobody.place().key == "part.held");

  CHECK(thrown([] { Attachment pen("usb:1", {}, Vec3::Zero()); }).kind() == ErrorKind::device);
  CHECK(thrown([] { Attachment pen("shm:/tegotae-nobody-has-this-name", {}, Vec3::Zero()); }).kind() ==
        ErrorKind::device);
}

TEST_CASE("scripts, recordings and settings say so too", "[error]") {
  const std::string path = std::string(TEGOTAE_BIN_DIR) + "/test_error.csv";
  std::ofstream(path) << "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,wall,1,0,0,0\n";
  const Error script = thrown([&] { read_script(path); });
  CHECK(script.kind() == ErrorKind::file);
  CHECK(script.place().file == path);
  CHECK(script.place().line == 3);

  const Error recording = thrown([] { read_recording("/no/such/recording.csv"); });
  CHECK(recording.kind() == ErrorKind::file);
  CHECK(recording.place().file == "/no/such/recording.csv");

  CHECK(thrown([] { resolver_kind("magic"); }).kind() == ErrorKind::setting);
  CHECK(thrown([] { StylusScript(std::vector<StylusScript::Key>()); }).kind() == ErrorKind::setting);
  SimulatedDevice pen({}, StylusScript({{0, Pose()}}));
  Channel channel = Channel::create();
  ServoSettings servo;
  servo.rate_hz = 1;
  CHECK(thrown([&] { Servo(pen, channel, servo); }).place().key == "rate_hz");
}

TEST_CASE("a budget of ages is none", "[error]") {
  Scene scene;
  scene.add_fixed("wall", test::box(Vec3(1, 1, 1)));
  scene.add_held("peg", test::box(Vec3(0.5, 0.5, 0.8)), {Quat::Identity(), Vec3(2, 0, 0)});
  scene.contact.tick_budget = 1e300;  // s; in ns it is beyond what a clock counts
  HapticLoop loop(scene);
  CHECK_FALSE(loop.step({Quat::Identity(), Vec3(1.9, 0, 0)}, 1e-3).flags.timed_out);
}
