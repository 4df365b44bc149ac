#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "catch.hpp"
#include "scene_file/scene_text.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "text.hpp"

using namespace tegotae;
using namespace tegotae::test;
namespace fs = std::filesystem;

namespace {

// A folder of its own with a mesh, a script, and scene.toml; gone with the object.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("tegotae_scene_file_" + std::to_string(::getpid()))) {
    fs::create_directories(path_ / "meshes");
    write("tet.obj", kTetrahedron);
    write("meshes/other.obj", kTetrahedron);
    write("insert.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.1,1,0,0,0\n2,0,0,0.05,1,0,0,0\n");
  }
  ~Folder() { fs::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  SceneFile load(const std::string& scene) const {
    write("scene.toml", scene);
    return load_scene(scene_path());
  }
  // The error that the scene gives, without the folder in front; "" when there is none.
  std::string error(const std::string& scene) const {
    try {
      load(scene);
    } catch (const Error& e) {
      std::string text = e.what();
      const std::string prefix = path_.string() + "/";
      for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
      return text;
    }
    return "";
  }
  std::string scene_path() const { return (path_ / "scene.toml").string(); }

 private:
  static constexpr const char* kTetrahedron =
      "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  fs::path path_;
};

// Lines 1 to 9; what a test adds starts at line 10.
const std::string kParts = R"(unit = "mm"
[[part]]
name = "block"
mesh = "tet.obj"
[[part]]
name = "peg"
mesh = "tet.obj"
held = true
position = [0, 0, 0.1]
)";
const std::string kDevice = "[device]\nscript = \"insert.csv\"\n";

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.rfind(prefix, 0) == 0;
}

}  // namespace

TEST_CASE("a scene of parts and a script loads with every default", "[scene_file]") {
  const Folder folder;
  const SceneFile file = folder.load(kParts + kDevice);
  REQUIRE(file.scene.parts.size() == 2);
  const Part &block = file.scene.parts[0], &peg = file.scene.parts[1];
  CHECK(block.name == "block");
  CHECK_FALSE(block.held);
  CHECK(peg.held);
  CHECK(peg.pose.p == Vec3(0, 0, 0.1));
  CHECK(peg.pose.q.coeffs() == Quat::Identity().coeffs());
  CHECK(peg.mesh == block.mesh);  // one file, one unit: one mesh in memory
  CHECK(peg.mesh->triangles.size() == 4);
  CHECK(file.up == UpAxis::z);
  CHECK(!file.scene.contact.l_min);
  CHECK(!file.scene.contact.l_0);
  CHECK(file.scene.coupling.stiffness == CouplingSettings().stiffness);
  CHECK(file.device.hand.stiffness == HandSettings().stiffness);
  CHECK(file.script.end() == 2);
  CHECK(file.script.pose(1).p.z() == Approx(0.075));
}

TEST_CASE("every key of a scene file arrives", "[scene_file]") {
  const Folder folder;
  const SceneFile file = folder.load(R"(
up = "x"
[[part]]
name = "a"
mesh = "tet.obj"
unit = "cm"
orientation = [2, 0, 0, 2]
[[part]]
name = "b"
mesh = "meshes/../tet.obj"
unit = "in"
held = true
rpy_deg = [90, 0, 90]
position = [1, 2.5, -3]
[contact]
l_min = 1e-6
l_0 = 2e-6
resolver = "lp"
helper_threads = 5
touch_tolerance = 3e-6
initial_overlap = "ignore"
density = 7800
[coupling]
stiffness = 1
damping = 0
torsional_stiffness = 3
torsional_damping = 4
[safety]
force_limit = 5
torque_limit = 0.06
continuous_force = 0
force_slew = 700
torque_slew = 8
velocity_limit = 0.9
heartbeat_timeout = 0.01
[device]
type = "simulated"
script = "insert.csv"
scale = 0.5
hand = { stiffness = 11, damping = 12, torsional_stiffness = 13, torsional_damping = 14, mass = 15, inertia = 16 }
)");
  const Part &a = file.scene.parts[0], &b = file.scene.parts[1];
  CHECK(a.pose.q.w() == Approx(std::sqrt(0.5)));
  CHECK(a.pose.q.z() == Approx(std::sqrt(0.5)));
  // Rz(90°) Rx(90°): y goes to z by roll and stays; z goes to -y by roll and to x by yaw.
  CHECK((b.pose.q * Vec3::UnitY() - Vec3::UnitZ()).norm() < 1e-15);
  CHECK((b.pose.q * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-15);
  CHECK(b.pose.p == Vec3(1, 2.5, -3));
  double a_max = 0, b_max = 0;
  for (const Vec3& v : a.mesh->vertices) a_max = std::max(a_max, v.maxCoeff());
  for (const Vec3& v : b.mesh->vertices) b_max = std::max(b_max, v.maxCoeff());
  CHECK(a_max == Approx(0.1));
  CHECK(b_max == Approx(0.254));
  const ContactSettings& contact = file.scene.contact;
  CHECK(file.up == UpAxis::x);
  CHECK(contact.l_min == 1e-6);
  CHECK(contact.l_0 == 2e-6);
  CHECK(contact.resolver == ResolverKind::lp);
  CHECK(contact.density == 7800);
  CHECK(contact.helper_threads == 5);
  CHECK(contact.touch_tolerance == 3e-6);
  CHECK(contact.initial_overlap == InitialOverlap::ignore);
  const CouplingSettings& coupling = file.scene.coupling;
  CHECK(coupling.stiffness == 1);
  CHECK(coupling.damping == 0);
  CHECK(coupling.torsional_stiffness == 3);
  CHECK(coupling.torsional_damping == 4);
  const SafetySettings& safety = file.safety;
  CHECK(safety.limits.force == 5);
  CHECK(safety.limits.torque == 0.06);
  CHECK(safety.continuous_force == 0);
  CHECK(safety.slew.force == 700);
  CHECK(safety.slew.torque == 8);
  CHECK(safety.velocity_limit == 0.9);
  CHECK(safety.heartbeat_timeout == 0.01);
  CHECK(file.scene.scale == 0.5);
  const HandSettings& hand = file.device.hand;
  CHECK(hand.stiffness == 11);
  CHECK(hand.damping == 12);
  CHECK(hand.torsional_stiffness == 13);
  CHECK(hand.torsional_damping == 14);
  CHECK(hand.mass == 15);
  CHECK(hand.inertia == 16);
}

TEST_CASE("friction and weight arrive, and what of them cannot be is named", "[scene_file]") {
  const Folder folder;
  const std::string parts = replaced(kParts, "held = true", "held = true\nmass = 0.25");
  const std::string pair = "[[friction.pair]]\nparts = [\"peg\", \"block\"]\nmu = 0.1\n";
  const SceneFile file =
      folder.load("weight = true\ngravity = [0, -9.8, 0]\n" + parts + "[friction]\nmu = 0.3\n" + pair + kDevice);
  CHECK(file.scene.weight.on);
  CHECK(file.scene.weight.gravity == Vec3(0, -9.8, 0));
  CHECK(*file.scene.weight.max_force == Approx(0.7));  // half of what the pen stands for long
  CHECK(*file.scene.parts[1].mass == 0.25);
  CHECK(file.scene.friction.mu == 0.3);
  REQUIRE(file.scene.friction.pairs.size() == 1);
  CHECK(file.scene.friction.pairs[0].a == "peg");
  CHECK(file.scene.friction.pairs[0].b == "block");
  CHECK(file.scene.friction.pairs[0].mu == 0.1);
  // Without a part its pairs are gone.
  Scene now = file.scene;
  now.parts.erase(now.parts.begin());
  CHECK(scene_text(file, now, "").find("friction.pair") == std::string::npos);

  const SceneFile plain = folder.load(kParts + kDevice);
  CHECK(plain.scene.friction.mu == 0);
  CHECK(plain.scene.friction.pairs.empty());
  CHECK_FALSE(plain.scene.weight.on);
  CHECK_FALSE(plain.scene.parts[1].mass);

  const auto named = [&](const std::string& added, const std::string& key) {
    const std::string error = folder.error(kParts + added);
    CAPTURE(added, error);
    CHECK(error.find(key) != std::string::npos);
  };
  named("[friction]\nmu = -0.1\n", "friction.mu");
  named("[friction]\nmu = 11\n", "friction.mu");
  named("[friction]\nmu = nan\n", "friction.mu");
  named("[[friction.pair]]\nparts = [\"peg\"]\nmu = 0.1\n", "two parts");
  named("[[friction.pair]]\nparts = [\"peg\", \"nobody\"]\nmu = 0.1\n", "nobody");
  named("[[friction.pair]]\nparts = [\"peg\", \"block\"]\n", "mu");
  named("[friction]\nmu = 0.1\n[contact]\nresolver = \"lp\"\n", "does not support friction");
  CHECK(folder.error("weight = true\n" + kParts + "[contact]\nresolver = \"lp\"\n").find("does not support weight") !=
        std::string::npos);
  CHECK(folder.error(replaced(kParts, "held = true", "held = true\nmass = 0")).find("mass") != std::string::npos);
}

TEST_CASE("roll, pitch and yaw turn about the fixed axes in this order", "[scene_file]") {
  const Folder folder;
  const SceneFile file = folder.load(replaced(kParts, "position", "rpy_deg = [20, -35, 110]\nposition") + kDevice);
  const double r = 20 * M_PI / 180, p = -35 * M_PI / 180, y = 110 * M_PI / 180;
  Mat3 expected;  // the closed form of Rz(y) Ry(p) Rx(r)
  expected << std::cos(y) * std::cos(p), std::cos(y) * std::sin(p) * std::sin(r) - std::sin(y) * std::cos(r),
      std::cos(y) * std::sin(p) * std::cos(r) + std::sin(y) * std::sin(r), std::sin(y) * std::cos(p),
      std::sin(y) * std::sin(p) * std::sin(r) + std::cos(y) * std::cos(r),
      std::sin(y) * std::sin(p) * std::cos(r) - std::cos(y) * std::sin(r), -std::sin(p), std::cos(p) * std::sin(r),
      std::cos(p) * std::cos(r);
  CHECK((file.scene.parts[1].pose.q.toRotationMatrix() - expected).norm() < 1e-14);
}

TEST_CASE("what is wrong is named with file, line and key", "[scene_file]") {
  const Folder folder;
  folder.write("empty.obj", "");
  folder.write("bad.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,zero,1,0,0,0\n");
  struct Case {
    std::string scene;
    std::string error;  // how the message starts
  };
  const std::string good = kParts + kDevice;
  REQUIRE(folder.error(good) == "");
  const Case cases[] = {
      {"unit = mm\n", "scene.toml:1: not valid TOML"},
      {good + "[contact]\nl_min = 1\nl_min = 2\n", "scene.toml:14: not valid TOML"},
      // Unknown keys, at every level.
      {"units = 1\n" + good, "scene.toml:1: units: unknown key"},
      {good + "[contacts]\n", "scene.toml:12: contacts: unknown key"},
      {replaced(good, "held = true", "hold = true"), "scene.toml:8: part.hold: unknown key"},
      {good + "[contact]\nlmin = 1\n", "scene.toml:13: contact.lmin: unknown key"},
      {good + "[coupling]\n\nk = 1\n", "scene.toml:14: coupling.k: unknown key"},
      {good + "port = 1\n", "scene.toml:12: device.port: unknown key"},
      {good + "hand = { k = 1 }\n", "scene.toml:12: device.hand.k: unknown key"},
      {good + "[safety]\nforce = 1\n", "scene.toml:13: safety.force: unknown key"},
      {good + "[safety]\nheartbeat_timeout = 2\n", "scene.toml:13: safety.heartbeat_timeout: must be at most 1 s"},
      {good + "scale = 1000\n", "scene.toml:12: device.scale: must be from 0.01 to 100"},
      // Wrong types.
      {replaced(good, "\"mm\"", "1"), "scene.toml:1: unit: must be a string"},
      {"up = \"w\"\n" + good, "scene.toml:1: up: unknown up w (known: x, y, z)"},
      {replaced(good, "\"block\"", "7"), "scene.toml:3: part.name: must be a string"},
      {replaced(good, "held = true", "held = 1"), "scene.toml:8: part.held: must be true or false"},
      {replaced(good, "[0, 0, 0.1]", "[0, 0]"), "scene.toml:9: part.position: must be a list of 3 numbers"},
      {replaced(good, "[0, 0, 0.1]", "[0, 0, \"1\"]"), "scene.toml:9: part.position: must be a list of numbers"},
      {replaced(good, "[0, 0, 0.1]", "0.1"), "scene.toml:9: part.position: must be a list of 3 numbers"},
      {"contact = 1\n" + good, "scene.toml:1: contact: must be a table"},
      {"part = 1\n" + kDevice, "scene.toml:1: part: must be written [[part]]"},
      {good + "[contact]\nl_min = true\n", "scene.toml:13: contact.l_min: must be a number"},
      {good + "hand = 3\n", "scene.toml:12: device.hand: must be a table"},
      // Line breaks in keys and values.
      {"\"a\\nb\" = 1\n" + good, "scene.toml:1: a?b: unknown key"},
      {replaced(good, "\"block\"", "\"a\\nb\""), "scene.toml:3: part.name: must be one line"},
      // Impossible values.
      {replaced(good, "\"mm\"", "\"mile\""), "scene.toml:1: unit: "},
      {replaced(good, "[0, 0, 0.1]", "[0, 0, nan]"), "scene.toml:9: part.position: must be finite"},
      {replaced(good, "[0, 0, 0.1]", "[0, 1e300, 0]"), "scene.toml:9: part.position: lies beyond 10 km"},
      {replaced(good, "[0, 0, 0.1]", "[-10001, 0, 0]"), "scene.toml:9: part.position: lies beyond 10 km"},
      {replaced(good, "[0, 0, 0.1]", "[0, 0, 0]\norientation = [0, 0, 0, 0]"), "scene.toml:10: part.orientation: "},
      {replaced(good, "[0, 0, 0.1]", "[0, 0, 0]\norientation = [1, 0, 0, 0]\nrpy_deg = [0, 0, 0]"),
       "scene.toml:11: part.rpy_deg: "},
      {good + "[contact]\nl_min = 0\n", "scene.toml:13: contact.l_min: must be greater than zero"},
      {good + "[contact]\nl_0 = -1e-6\n", "scene.toml:13: contact.l_0: must be greater than zero"},
      {good + "[contact]\nhelper_threads = -1\n",
       "scene.toml:13: contact.helper_threads: must be a whole number from 0 to 64 (it is -1)"},
      {good + "[contact]\nhelper_threads = 1.5\n", "scene.toml:13: contact.helper_threads: must be a whole number"},
      {good + "[contact]\nhelper_threads = 65\n", "scene.toml:13: contact.helper_threads: must be a whole number"},
      {good + "[contact]\nhelper_threads = true\n", "scene.toml:13: contact.helper_threads: must be a number"},
      {good + "[contact]\ndensity = inf\n", "scene.toml:13: contact.density: must be finite"},
      {good + "[contact]\nresolver = \"magic\"\n", "scene.toml:13: contact.resolver: "},
      {good + "[contact.impulse]\nrestitution = 1.5\n",
       "scene.toml:13: contact.impulse.restitution: must be at most 1"},
      {good + "[contact.impulse]\nfriction = 0.2\n", "scene.toml:13: contact.impulse.friction: unknown key"},
      {good + "[contact.penalty]\nstiffness = 0\n",
       "scene.toml:13: contact.penalty.stiffness: must be greater than zero"},
      {good + "[coupling]\nstiffness = -800\n", "scene.toml:13: coupling.stiffness: must be greater than zero"},
      {good + "[coupling]\ndamping = -1\n", "scene.toml:13: coupling.damping: must not be negative"},
      {good + "hand = { mass = -1 }\n", "scene.toml:12: device.hand.mass: must not be negative"},
      {good + "type = \"phantom\"\n", "scene.toml:12: device.type: unknown device type"},
      // Parts.
      {kDevice, "scene.toml:1: part: the scene has no [[part]]"},
      {replaced(good, "held = true", "held = false"), "scene.toml:2: part: no part is held"},
      {replaced(good, "\"block\"", "\"block\"\nheld = true"), "scene.toml:9: part.held: part block is already held"},
      {replaced(good, "\"peg\"", "\"block\""), "scene.toml:6: part.name: another part is named block"},
      {replaced(good, "name = \"block\"", ""), "scene.toml:2: part.name: missing"},
      {replaced(good, "mesh = \"tet.obj\"", ""), "scene.toml:2: part.mesh: missing"},
      // Files.
      {replaced(good, "tet.obj", "none.obj"), "scene.toml:4: part.mesh: none.obj: no such file"},
      {replaced(good, "tet.obj", "meshes"), "scene.toml:4: part.mesh: meshes: not a file"},
      {replaced(good, "tet.obj", "empty.obj"), "scene.toml:4: part.mesh: "},
      {good + "[[part]]\nname = \"c\"\nmesh = \"tet.obj\"\npath = \"a\"\n",
       "scene.toml:15: part.path: must be a list of strings"},
      {good + "[[part]]\nname = \"c\"\nmesh = \"tet.obj\"\npath = [\"a\", 1]\n",
       "scene.toml:15: part.path: must be a list of strings"},
      {good + "[[part]]\nname = \"c\"\nmesh = \"tet.obj\"\ncolor = [1, 0]\n",
       "scene.toml:15: part.color: must be a list of 3 to 4 numbers"},
      {good + "[[part]]\nname = \"c\"\nmesh = \"tet.obj\"\ncolor = [1, 0, 1.5]\n",
       "scene.toml:15: part.color: each number must be between 0 and 1"},
      {replaced(good, "insert.csv", "none.csv"), "scene.toml:11: device.script: none.csv: no such file"},
      {replaced(good, "insert.csv", "bad.csv"), "scene.toml:11: device.script: bad.csv:2"},
  };
  for (const Case& c : cases) {
    INFO(c.scene);
    const std::string error = folder.error(c.scene);
    INFO("error: " << error);
    INFO("expected: " << c.error);
    CHECK(starts_with(error, c.error));
    CHECK(error.find('\n') == std::string::npos);
  }
}

TEST_CASE("groups and colors of parts are kept", "[scene_file]") {
  const Folder folder;
  const SceneFile file = folder.load(kParts + kDevice +
                                     "[[part]]\nname = \"cover\"\nmesh = \"tet.obj\"\n"
                                     "path = [\"pump\", \"lid / top\"]\ncolor = [0.25, 0.5, 1]\n"
                                     "[[part]]\nname = \"glass\"\nmesh = \"tet.obj\"\ncolor = [0, 0, 0, 0.5]\n");
  REQUIRE(file.scene.parts.size() == 4);
  CHECK(file.scene.parts[0].path.empty());
  CHECK(!file.scene.parts[0].color);
  CHECK(file.scene.parts[2].path == std::vector<std::string>{"pump", "lid / top"});
  CHECK(file.scene.parts[2].color == Color{0.25, 0.5, 1, 1});
  CHECK(file.scene.parts[3].color == Color{0, 0, 0, 0.5});
}

TEST_CASE("the part to hold can be named when loading", "[scene_file]") {
  const Folder folder;
  folder.load(kParts + kDevice);
  SceneOptions options;
  options.hold = "block";
  const SceneFile file = load_scene(folder.scene_path(), options);
  CHECK(file.scene.parts[0].held);
  CHECK(!file.scene.parts[1].held);
  options.hold = "lid";
  CHECK_THROWS_WITH(load_scene(folder.scene_path(), options), Catch::Contains("no part is named lid"));
  const auto at = kParts.find("held = true");
  REQUIRE(at != std::string::npos);
  const std::string nothing_held = kParts.substr(0, at) + "held = false" + kParts.substr(at + 11);
  CHECK(folder.error(nothing_held).find("--hold NAME") != std::string::npos);
  CHECK_NOTHROW(load_scene(folder.scene_path(), {"block", true, {}}));
  CHECK_NOTHROW(load_scene(folder.scene_path(), {"", false, {}}));
}

TEST_CASE("without a script the hand stays where the held part starts", "[scene_file]") {
  const Folder folder;
  const SceneFile file = folder.load(kParts);
  CHECK(file.script.begin() == file.script.end());
  for (const Part& part : file.scene.parts)
    if (part.held) CHECK(file.script.pose(0).p == part.pose.p);
}

TEST_CASE("a scene file in UTF-16 is refused as such", "[scene_file]") {
  const Folder folder;
  std::string wide;
  for (const char c : std::string("[[part]]\nname = \"a\"\n")) (wide += c) += '\0';
  for (const char* mark : {"", "\xff\xfe"})
    CHECK(folder.error(mark + wide) == "scene.toml: its text is in UTF-16, and TOML is UTF-8: save it as that");
}

TEST_CASE("a scene file that is not there is an error", "[scene_file]") {
  const Folder folder;
  CHECK_THROWS_WITH(load_scene(folder.scene_path()), folder.scene_path() + ": no such file");
  const std::string parent = fs::path(folder.scene_path()).parent_path().string();
  CHECK_THROWS_WITH(load_scene(parent), parent + ": not a file");
}

TEST_CASE("a scene with parts moved, left out, and another one held is written so that it reads back the same") {
  const Folder folder;
  const fs::path before = fs::current_path();
  folder.write("scene.toml", R"(unit = "mm"
[[part]]
name = "left \"one\""
mesh = "meshes/other.obj"
rpy_deg = [10, 20, 30]
path = ["group"]
color = [1, 0.5, 0]
[[part]]
name = "gone"
mesh = "tet.obj"
[[part]]
name = "peg"
mesh = "tet.obj"
unit = "cm"
held = true
position = [0, 0, 0.3]
[contact]
l_min = 3e-6
penalty = { stiffness = 123.456789012345678 }
[safety]
force_limit = 3.3
[device]
script = "insert.csv"
scale = 2.5
)");
  // As a user in the folder names it, and from elsewhere.
  fs::current_path(fs::path(folder.scene_path()).parent_path());
  const SceneFile file = load_scene("scene.toml");
  Scene now = file.scene;
  now.contact.resolver = ResolverKind::lp;
  now.parts.erase(now.parts.begin() + 1);
  now.parts[0].pose = {Quat(0.1, 0.2, 0.3, 0.4).normalized(), Vec3(1.0 / 3, -1e-7, 0.1 + 0.2)};
  for (const std::string to : {"", "meshes"}) {
    CAPTURE(to);
    const fs::path written = fs::path(to) / "changed.toml";
    std::ofstream(written) << scene_text(file, now, to);
    const SceneFile read = load_scene(written.string());
    REQUIRE(read.scene.parts.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      const Part &a = now.parts[i], &b = read.scene.parts[i];
      CHECK(a.name == b.name);
      CHECK(a.held == b.held);
      CHECK(a.path == b.path);
      CHECK(a.color == b.color);
      CHECK(a.pose.p == b.pose.p);
      CHECK((a.pose.q.coeffs() - b.pose.q.coeffs()).norm() < 1e-15);  // normalized once more
      CHECK(a.mesh->vertices == b.mesh->vertices);
    }
    CHECK(read.scene.contact.resolver == ResolverKind::lp);
    CHECK(read.scene.contact.l_min == file.scene.contact.l_min);
    CHECK(read.scene.contact.penalty.stiffness == file.scene.contact.penalty.stiffness);
    CHECK(read.safety.limits.force == 3.3);
    CHECK(read.scene.scale == 2.5);
    CHECK(read.script.end() == file.script.end());
  }
  // The script is for the part that the file holds.
  now.parts[0].held = true;
  now.parts[1].held = false;
  std::ofstream("changed.toml") << scene_text(file, now, "");
  const SceneFile other = load_scene("changed.toml");
  CHECK(other.scene.parts[0].held);
  CHECK(other.script.end() == other.script.begin());
  SceneFile unread = file;
  unread.text.clear();
  CHECK_THROWS_AS(scene_text(unread, now, ""), Error);
  fs::current_path(before);
}
