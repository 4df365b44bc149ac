// Errors say to programs what they say to people.
#include <fstream>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/scene_file/scene_file.hpp"
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

  CHECK(thrown([] { Attachment pen("usb:1", {}, Vec3::Zero()); }).kind() == ErrorKind::device);
  CHECK(thrown([] { Attachment pen("shm:/tegotae-nobody-has-this-name", {}, Vec3::Zero()); }).kind() ==
        ErrorKind::device);
}
