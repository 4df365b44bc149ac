// Recordings become what the page shows, and contacts are found again.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "view/replay.hpp"
#include "view/wire.hpp"

using namespace tegotae;
using namespace tegotae::test;
using namespace tegotae::view;
using Catch::Contains;

namespace {

const std::string kHeader =
    "tick,substep,t,y_px,y_py,y_pz,y_qw,y_qx,y_qy,y_qz,x_px,x_py,x_pz,x_qw,x_qx,x_qy,x_qz,fx,fy,fz,tx,ty,tz,contacts,"
    "gap,tick_us\n";

// A row with the part at height z and the pen at height y.
std::string row(int tick, double z, double y) {
  const auto pose = [](double height) { return "0,0," + std::to_string(height) + ",1,0,0,0,"; };
  return std::to_string(tick) + ",0," + std::to_string(1e-3 * tick) + "," + pose(y) + pose(z) +
         "0,0,0,0,0,0,0,inf,12.5\n";
}
std::string row(int tick, double z) {
  return row(tick, z, z);
}

// Two cubes of 10 mm, the held one 8 mm over the other.
void write_cubes(const TempFolder& folder) {
  folder.write(
      "cube.obj",
      "v -5 -5 -5\nv 5 -5 -5\nv 5 5 -5\nv -5 5 -5\nv -5 -5 5\nv 5 -5 5\nv 5 5 5\nv -5 5 5\n"
      "f 1 4 3\nf 1 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n");
  folder.write("path.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.018,1,0,0,0\n");
  folder.write("scene.toml",
               "unit = \"mm\"\n[[part]]\nname = \"floor\"\nmesh = \"cube.obj\"\n"
               "[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\nposition = [0, 0, 0.018]\n"
               "[device]\nscript = \"path.csv\"\n");
}

nlohmann::json about_of(const std::string& bundle) {
  std::uint32_t length = 0;
  std::memcpy(&length, bundle.data(), 4);
  return nlohmann::json::parse(bundle.substr(4, length));
}

std::vector<float> floats_of(const std::string& bundle, const nlohmann::json& array) {
  std::uint32_t length = 0;
  std::memcpy(&length, bundle.data(), 4);
  std::vector<float> values(array.at("count").get<std::size_t>());
  std::memcpy(values.data(), bundle.data() + 4 + length + 4 * array.at("at").get<std::size_t>(), 4 * values.size());
  return values;
}

}  // namespace

TEST_CASE("a replay finds the contacts of the recorded poses") {
  const TempFolder folder;
  write_cubes(folder);
  // Down to 10 µm over the floor: its top is at 5 mm, the block's bottom 5 mm below its center.
  std::string text = kHeader;
  for (int i = 0; i <= 80; ++i) text += row(i, 0.018 - 1e-4 * i + (i == 80 ? 1e-5 : 0), 0.018 - 1.1e-4 * i);
  folder.write("r.csv", text);
  const std::string bytes = replay_bundle(folder / "r.csv", folder / "scene.toml");
  const auto about = about_of(bytes);
  const std::vector<float> frames = floats_of(bytes, about.at("frames")), pairs = floats_of(bytes, about.at("pairs"));
  REQUIRE(frames.size() == 81 * kFrameFloats);
  const float* last = frames.data() + 80 * kFrameFloats;
  CHECK(last[1] == 80);                           // tick
  CHECK(std::abs(last[4 + 2] - 0.01001) < 1e-8);  // x, height
  const auto count = static_cast<std::size_t>(last[31]);
  REQUIRE(count >= 4);  // the block's corners
  const float* at = pairs.data() + pairs.size() - count * kPairFloats;
  for (std::size_t i = 0; i < count; ++i, at += kPairFloats) {
    CHECK(std::abs(at[2] - 0.005) < 6e-5);  // on the block's bottom
    CHECK(std::abs(at[5] - 1) < 1e-4);      // from the floor to the block
    CHECK(at[6] < 6e-5);                    // gap: the loop is led up to 50 µm farther
    CHECK(at[6] > 0);
    CHECK(std::floor(at[7] / 18) == 0);  // the floor is part 0
  }
}

TEST_CASE("a replay has the contact forces of the recording, which MCAP keeps and CSV does not") {
  const TempFolder folder;
  write_cubes(folder);
  // Down to 3 mm into the floor, and there.
  folder.write("path.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.018,1,0,0,0\n0.3,0,0,0.007,1,0,0,0\n0.9,0,0,0.007,1,0,0,0\n");
  for (const std::string name : {"r.mcap", "r.csv"}) {
    CAPTURE(name);
    const Output run = run_program("tegotae", "run " + (folder / "scene.toml") + " --fast --record " + (folder / name));
    INFO(run.err);
    REQUIRE(run.code != 2);
    const std::string bytes = replay_bundle(folder / name);
    const auto about = about_of(bytes);
    const std::vector<float> frames = floats_of(bytes, about.at("frames")),
                             forces = floats_of(bytes, about.at("forces"));
    const float* last = frames.data() + frames.size() - kFrameFloats;
    CHECK(last[20] > 0.5);  // N, up
    const auto count = static_cast<std::size_t>(last[33]);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += forces[forces.size() - kForceFloats * (i + 1) + 5];
    if (name == "r.mcap") CHECK(sum == Approx(last[20]).epsilon(0.01));
    if (name == "r.csv") CHECK(forces.empty());
    CHECK((about.at("notes").dump().find("MCAP has those") != std::string::npos) == (name == "r.csv"));
  }
}

TEST_CASE("a recording knows its scene") {
  const TempFolder folder;
  write_cubes(folder);
  folder.write("r.csv", kHeader + row(0, 0.018));
  CHECK_THROWS_WITH(replay_bundle(folder / "r.csv"), Contains("does not name its scene"));
  folder.write("r.csv.info.json", R"({"scene": "scene.toml"})");
  CHECK_THAT(about_of(replay_bundle(folder / "r.csv")).at("parts").dump(), Contains("block"));
  folder.write("r.csv.info.json", R"({"scene": "gone.toml"})");
  CHECK_THROWS_WITH(replay_bundle(folder / "r.csv"), Contains("gone.toml is gone"));
}

TEST_CASE("the part in the hand is the recording's, whatever the scene file holds") {
  const TempFolder folder;
  write_cubes(folder);
  for (const std::string name : {"r.csv", "r.mcap"}) {
    CAPTURE(name);
    // The script takes the hand, and with it the floor, up to the block.
    const Output run = run_program("tegotae", "run " + (folder / "scene.toml") + " --hold floor --fast --seconds 0.5 " +
                                                  "--record " + (folder / name));
    INFO(run.err);
    CHECK(run.code != 2);
    const auto about = about_of(replay_bundle(folder / name));
    CHECK(about.at("parts")[0].at("held") == true);
    CHECK(about.at("parts")[1].at("held") == false);
    CHECK(about.at("parts")[1].at("pose")[2] == 0.018);
    CHECK(run_program("tegotae", "replay " + (folder / name) + " --html " + (folder / "r.html")).code == 0);
  }
  folder.write("r.csv.info.json", R"({"scene": "scene.toml", "held": "lid"})");
  CHECK_THROWS_WITH(replay_bundle(folder / "r.csv"), Contains("no part is named lid"));
}

TEST_CASE("a recording of another scene is refused") {
  const TempFolder folder;
  write_cubes(folder);
  folder.write("inside.csv", kHeader + row(0, 0.005));
  CHECK_THROWS_WITH(replay_bundle(folder / "inside.csv", folder / "scene.toml"), Contains("does not fit this scene"));
  std::string text = kHeader;
  for (int i = 0; i <= 200; ++i) text += row(i, std::max(0.0, 0.018 - 1e-3 * i));
  folder.write("through.csv", text);
  CHECK_THROWS_WITH(replay_bundle(folder / "through.csv", folder / "scene.toml"), Contains("does not fit this scene"));
}

TEST_CASE("the program writes a page that needs no server") {
  const TempFolder folder;
  write_cubes(folder);
  folder.write("r.csv", kHeader + row(0, 0.018) + row(1, 0.017));
  const Output o = run_program(
      "tegotae", "replay " + (folder / "r.csv") + " " + (folder / "scene.toml") + " --html " + (folder / "r.html"));
  INFO(o.err);
  CHECK(o.code == 0);
  const std::string page = read_text(folder / "r.html");
  CHECK_THAT(page, Contains("id=\"data\">"));
  CHECK(page.find("http://") == page.find("http://www.w3.org"));  // loads nothing from elsewhere
  CHECK(run_program("tegotae", "replay " + (folder / "r.csv") + " " + (folder / "scene.toml") + " --html /nowhere/x")
            .code == 2);
  CHECK(run_program("tegotae", "replay " + (folder / "r.csv") + " " + (folder / "scene.toml") + " --view-address x")
            .code == 2);
}
