// tegotae.h, called as C would: closed forms, and what goes wrong is told and never thrown.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "apps/run_program.hpp"
#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/tegotae.h"

using tegotae::CouplingSettings;
using tegotae::TriangleMesh;
using tegotae::Vec3;
using tegotae::test::TempFolder;

namespace {

int64_t add(tegotae_scene* scene, const char* name, const TriangleMesh& mesh, const double (&pose)[7], bool held) {
  std::vector<double> vertices;
  for (const Vec3& v : mesh.vertices) vertices.insert(vertices.end(), v.data(), v.data() + 3);
  std::vector<uint32_t> triangles;
  for (const auto& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
  return tegotae_scene_add(scene, name, vertices.data(), mesh.vertices.size(), triangles.data(), mesh.triangles.size(),
                           pose, held);
}

const double kFloor[7] = {0, 0, -0.01, 1, 0, 0, 0}, kAbove[7] = {0, 0, 0.015, 1, 0, 0, 0};

tegotae_scene* floor_scene() {
  tegotae_scene* scene = tegotae_scene_create();
  REQUIRE(scene != nullptr);
  REQUIRE(add(scene, "floor", tegotae::test::box(Vec3(0.2, 0.2, 0.02)), kFloor, false) == 0);
  REQUIRE(add(scene, "block", tegotae::test::box(Vec3(0.02, 0.02, 0.02)), kAbove, true) == 1);
  return scene;
}

std::string error() {
  return tegotae_last_error();
}

}  // namespace

TEST_CASE("a rig from C is pressed on a floor and feels it", "[c_interface]") {
  tegotae_scene* scene = floor_scene();
  tegotae_rig* rig = tegotae_rig_create(scene, nullptr, TEGOTAE_CLOCK_SIMULATED);
  REQUIRE(rig != nullptr);
  REQUIRE(tegotae_rig_start(rig) == 0);
  const double below[7] = {0, 0, 0.006, 1, 0, 0, 0};
  REQUIRE(tegotae_rig_lead(rig, below) == 0);
  tegotae_tick tick;
  int began = 0;
  for (int i = 0; i < 1500; ++i) {
    REQUIRE(tegotae_rig_step(rig, &tick) == 0);
    tegotae_contact contacts[32];
    const int64_t count = tegotae_rig_contacts(rig, contacts, 32);
    REQUIRE(count == tick.contacts);
    for (int64_t k = 0; k < count; ++k) began += contacts[k].began;
  }
  CHECK(tick.connected == 1);
  CHECK(tick.touching == 1);
  CHECK(tick.part[2] == Approx(0.01).margin(2e-5));
  CHECK(tick.force[2] == Approx(CouplingSettings().stiffness * (tick.part[2] - tick.pen[2])).epsilon(0.01));
  CHECK(tick.force[2] > 0.5);
  CHECK(began >= 4);

  tegotae_contact contacts[32];
  const int64_t count = tegotae_rig_contacts(rig, contacts, 32);
  REQUIRE(count >= 4);
  double sum = 0;
  for (int64_t k = 0; k < count; ++k) {
    CHECK(contacts[k].part == 0);
    CHECK(contacts[k].normal[2] == Approx(1));
    CHECK(contacts[k].point_b[2] == Approx(0).margin(1e-9));
    CHECK(contacts[k].point_a[2] == Approx(contacts[k].gap).margin(1e-9));
    sum += contacts[k].force;
  }
  CHECK(sum == Approx(tick.force[2]).epsilon(0.02));
  // Fewer than there are: the first of them, and nothing beyond.
  tegotae_contact one[2];
  std::memset(one, 0x5a, sizeof one);
  const tegotae_contact before = one[1];
  CHECK(tegotae_rig_contacts(rig, one, 1) == count);
  CHECK(one[0].gap == contacts[0].gap);
  CHECK(std::memcmp(&one[1], &before, sizeof before) == 0);
  CHECK(tegotae_rig_contacts(rig, nullptr, 0) == count);

  double pose[7];
  REQUIRE(tegotae_rig_part(rig, pose) == 0);
  CHECK(std::memcmp(pose, tick.part, sizeof pose) == 0);
  tegotae_scene_destroy(scene);  // the rig goes on
  CHECK(tegotae_rig_step(rig, nullptr) == 0);
  CHECK(tegotae_rig_stop(rig) == 0);
  tegotae_rig_destroy(rig);
}

TEST_CASE("a contact from C tells its friction, and whether it slides", "[c_interface]") {
  const TempFolder folder;
  folder.write("scene.toml",
               "unit = \"mm\"\n[friction]\nmu = 0.3\n"
               "[[part]]\nname = \"floor\"\nmesh = \"" TEGOTAE_MODELS_DIR
               "/floor.obj\"\n"
               "[[part]]\nname = \"cube\"\nmesh = \"" TEGOTAE_MODELS_DIR
               "/cube.obj\"\nheld = true\nposition = [0, 0, 0.03]\n");
  tegotae_scene* scene = tegotae_scene_load((folder / "scene.toml").c_str());
  INFO(error());
  REQUIRE(scene != nullptr);
  tegotae_rig* rig = tegotae_rig_create(scene, nullptr, TEGOTAE_CLOCK_SIMULATED);
  REQUIRE(rig != nullptr);
  REQUIRE(tegotae_rig_start(rig) == 0);
  tegotae_tick tick = {};
  double pen[7] = {0, 0, 0.03, 1, 0, 0, 0};
  const auto step = [&] {
    REQUIRE(tegotae_rig_lead(rig, pen) == 0);
    REQUIRE(tegotae_rig_step(rig, &tick) == 0);
  };
  for (int i = 0; i < 3000 && tick.contacts == 0; ++i) {
    pen[2] -= 1e-5;
    step();
  }
  REQUIRE(tick.contacts > 0);
  pen[2] -= 1e-3;
  for (int i = 0; i < 1000; ++i) step();
  tegotae_contact contacts[32];
  int64_t count = tegotae_rig_contacts(rig, contacts, 32);
  for (int64_t k = 0; k < count; ++k) CHECK(contacts[k].slides == 0);
  // The pen goes in steps of its resolution, so that there are ticks without a motion.
  int slid = 0;
  for (int i = 0; i < 1000; ++i) {
    pen[0] += 1e-5;
    step();
    count = tegotae_rig_contacts(rig, contacts, 32);
    for (int64_t k = 0; k < count; ++k) slid += contacts[k].force > 0 && contacts[k].slides != 0 ? 1 : 0;
  }
  REQUIRE(count >= 4);
  REQUIRE(count <= 32);
  CHECK(slid > 200);
  double normal = 0, friction[3] = {0, 0, 0};
  for (int64_t k = 0; k < count; ++k) {
    normal += contacts[k].force;
    for (int i = 0; i < 3; ++i) friction[i] += contacts[k].friction[i];
  }
  CHECK(normal > 0.2);
  CHECK(friction[0] == Approx(-0.3 * normal).epsilon(0.01));
  CHECK(friction[1] == Approx(0).margin(0.01 * normal));
  CHECK(friction[2] == Approx(0).margin(1e-6));
  tegotae_rig_destroy(rig);
  tegotae_scene_destroy(scene);
}

TEST_CASE("a scene is changed from C while it runs", "[c_interface]") {
  tegotae_scene* scene = floor_scene();
  tegotae_rig* rig = tegotae_rig_create(scene, nullptr, TEGOTAE_CLOCK_SIMULATED);
  REQUIRE(rig != nullptr);
  REQUIRE(tegotae_rig_start(rig) == 0);
  const double lower[7] = {0, 0, -0.03, 1, 0, 0, 0}, below[7] = {0, 0, -0.01, 1, 0, 0, 0};
  REQUIRE(tegotae_scene_move(scene, 0, lower) == 0);
  REQUIRE(tegotae_rig_change(rig, scene, 0) == 0);
  REQUIRE(tegotae_rig_lead(rig, below) == 0);
  tegotae_tick tick;
  for (int i = 0; i < 1500; ++i) REQUIRE(tegotae_rig_step(rig, &tick) == 0);
  CHECK(tick.part[2] == Approx(-0.01).margin(2e-5));
  // Nobody steps: the change is taken back.
  const double aside[7] = {1, 0, -0.03, 1, 0, 0, 0};
  REQUIRE(tegotae_scene_move(scene, 0, aside) == 0);
  CHECK(tegotae_rig_change(rig, scene, 0.01) < 0);
  CHECK_THAT(error(), Catch::Contains("steps"));
  tegotae_rig_destroy(rig);
  tegotae_scene_destroy(scene);
}

TEST_CASE("what goes wrong in a call from C is told", "[c_interface]") {
  const double no_turn[7] = {0, 0, 0, 0, 0, 0, 0}, far[7] = {1e300, 0, 0, 1, 0, 0, 0};
  const double nan[7] = {0, 0, 0, std::nan(""), 0, 0, 0}, one[3] = {0, 0, 0};
  const uint32_t triangle[3] = {0, 1, 2};
  CHECK(tegotae_scene_add(nullptr, "a", one, 1, triangle, 1, kFloor, 0) < 0);
  CHECK(error() == "scene must not be NULL");
  tegotae_scene* scene = floor_scene();
  CHECK(tegotae_scene_add(scene, nullptr, one, 1, triangle, 1, kFloor, 0) < 0);
  CHECK(tegotae_scene_add(scene, "a", nullptr, 1, triangle, 1, kFloor, 0) < 0);
  CHECK(tegotae_scene_add(scene, "a", one, 1, nullptr, 1, kFloor, 0) < 0);
  CHECK(tegotae_scene_add(scene, "a", one, 1, triangle, 1, kFloor, 0) < 0);
  CHECK_THAT(error(), Catch::Contains("\"a\"") && Catch::Contains("vertex"));
  for (const double* pose : {no_turn, far, nan, static_cast<const double*>(nullptr)})
    CHECK(tegotae_scene_move(scene, 0, pose) < 0);
  CHECK(tegotae_scene_move(scene, 2, kFloor) < 0);
  CHECK(tegotae_scene_load("/no/such/scene.toml") == nullptr);
  CHECK_THAT(error(), Catch::Contains("/no/such/scene.toml"));
  CHECK(tegotae_rig_create(scene, "shm:/tegotae-nobody-has-this-name", TEGOTAE_CLOCK_REAL) == nullptr);
  CHECK(tegotae_rig_create(scene, "shm:/x", TEGOTAE_CLOCK_SIMULATED) == nullptr);
  CHECK(tegotae_rig_create(scene, nullptr, 7) == nullptr);
  REQUIRE(tegotae_scene_move(scene, 1, kFloor) == 0);
  CHECK(tegotae_rig_create(scene, nullptr, TEGOTAE_CLOCK_SIMULATED) == nullptr);
  CHECK_THAT(error(), Catch::Contains("\"block\" and \"floor\" intersect"));
  CHECK(tegotae_rig_step(nullptr, nullptr) < 0);
  CHECK(tegotae_rig_contacts(nullptr, nullptr, 0) < 0);
  // Another thread has its own last error.
  std::string others = "unset";
  std::thread([&others] { others = tegotae_last_error(); }).join();
  CHECK(others.empty());
  tegotae_scene_destroy(scene);
  tegotae_scene_destroy(nullptr);
  tegotae_rig_destroy(nullptr);
}

TEST_CASE("what is not read of a scene's mesh files is told in C", "[c_interface]") {
  const TempFolder folder;
  // A triangle that moves and that ACME shows otherwise; the second part shares its mesh, the third has one of its own.
  folder.write("c.bin",
               std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
  folder.write("told.gltf", R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],
"animations":[{"channels":[],"samplers":[]}],"extensionsUsed":["ACME_shape"],"buffers":[{"byteLength":36,"uri":"c.bin"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})");
  folder.write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("s.toml", R"([[part]]
name = "a"
mesh = "told.gltf"
held = true
[[part]]
name = "b"
mesh = "told.gltf"
position = [5, 0, 0]
[[part]]
name = "c"
mesh = "plain.obj"
position = [0, 5, 0]
)");
  tegotae_scene* scene = tegotae_scene_load((folder / "s.toml").c_str());
  INFO(error());
  REQUIRE(scene != nullptr);
  const int64_t size = tegotae_scene_notes(scene, nullptr, 0);
  REQUIRE(size > 0);
  std::vector<char> bytes(static_cast<std::size_t>(size) + 2, 'x');
  REQUIRE(tegotae_scene_notes(scene, bytes.data(), bytes.size() - 1) == size);
  CHECK(bytes.back() == 'x');
  const std::string text = bytes.data();
  REQUIRE(text.size() == static_cast<std::size_t>(size));
  CHECK(std::count(text.begin(), text.end(), '\n') == 2);
  CHECK(text.back() == '\n');
  CHECK(text.find("told.gltf: animations") != std::string::npos);
  CHECK(text.find("ACME_shape") != std::string::npos);
  CHECK(text.find("plain.obj") == std::string::npos);
  // Room for less: the beginning, and nothing beyond.
  std::fill(bytes.begin(), bytes.end(), 'x');
  CHECK(tegotae_scene_notes(scene, bytes.data(), 5) == size);
  CHECK(std::string(bytes.data()) == text.substr(0, 4));
  CHECK(bytes[5] == 'x');
  CHECK(tegotae_scene_notes(scene, nullptr, 5) < 0);
  CHECK(error() == "text must not be NULL");
  CHECK(tegotae_scene_notes(nullptr, nullptr, 0) < 0);
  tegotae_scene_destroy(scene);
  tegotae_scene* quiet = floor_scene();
  CHECK(tegotae_scene_notes(quiet, nullptr, 0) == 0);
  tegotae_scene_destroy(quiet);
}

TEST_CASE("a scene file is loaded from C", "[c_interface]") {
  tegotae_scene* scene = tegotae_scene_load(TEGOTAE_MODELS_DIR "/peg_in_hole_0.94.toml");
  REQUIRE(scene != nullptr);
  tegotae_rig* rig = tegotae_rig_create(scene, nullptr, TEGOTAE_CLOCK_SIMULATED);
  REQUIRE(rig != nullptr);
  CHECK(tegotae_rig_start(rig) == 0);
  CHECK(tegotae_rig_step(rig, nullptr) == 0);
  tegotae_rig_destroy(rig);
  tegotae_scene_destroy(scene);
  CHECK(std::string(tegotae_version()).find('.') != std::string::npos);
}
