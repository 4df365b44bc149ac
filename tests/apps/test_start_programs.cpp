// How the programs tell of a start that is not free.
#include <nlohmann/json.hpp>

#include "apps/run_program.hpp"
#include "catch.hpp"

using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// A cube of 10 mm on a plate whose top face is at z = 0, `into` it (m), beside a post; the pen lifts it.
void write_scene(const TempFolder& folder, double into, double post_x, const std::string& contact) {
  const auto box = [](double x, double y, double z0, double z1) {
    std::string obj;
    for (int i = 0; i < 8; ++i)
      obj += "v " + std::to_string(i & 1 ? x : -x) + " " + std::to_string(i & 2 ? y : -y) + " " +
             std::to_string(i & 4 ? z1 : z0) + "\n";
    return obj +
           "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\n"
           "f 2 4 6\nf 4 8 6\n";
  };
  folder.write("plate.obj", box(50, 50, -10, 0));
  folder.write("cube.obj", box(5, 5, 0, 10));
  folder.write("lift.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,0,0," + std::to_string(-into) + ",1,0,0,0\n0.3,0,0,0.02,1,0,0,0\n");
  folder.write("scene.toml", "unit = \"mm\"\n[contact]\n" + contact +
                                 "[[part]]\nname = \"plate\"\nmesh = \"plate.obj\"\n"
                                 "[[part]]\nname = \"post\"\nmesh = \"cube.obj\"\nposition = [" +
                                 std::to_string(post_x) +
                                 ", 0, 0]\n"
                                 "[[part]]\nname = \"cube\"\nmesh = \"cube.obj\"\nheld = true\nposition = [0, 0, " +
                                 std::to_string(-into) + "]\n[device]\nscript = \"lift.csv\"\n");
}

}  // namespace

TEST_CASE("a seat and a suspended part are told in summary, text and recording", "[start]") {
  const TempFolder folder;
  write_scene(folder, 3e-6, 0.008, "initial_overlap = \"ignore\"\n");
  const std::string run = "run --fast --record " + (folder / "r.csv") + " ";
  const Output text = run_program("tegotae", run + (folder / "scene.toml"));
  INFO(text.out << text.err);
  CHECK(text.code == 0);
  CHECK_THAT(text.err, Contains("touching     plate, depth 3.00 um") && Contains("moved by ") &&
                           Contains("overlapping  post, depth 2.000 mm; SUSPENDED"));
  CHECK_THAT(text.out, Contains("overlapping  post, depth 2.000 mm; came free"));
  CHECK(json::parse(read_text(folder / "r.csv.info.json")).at("suspended") == "post");
  const Output replay = run_program("tegotae", "replay --html " + (folder / "r.html") + " " + (folder / "r.csv"));
  INFO(replay.err);
  CHECK(replay.code == 0);

  // Cut short before it is out.
  const Output o = run_program("tegotae", "run --fast --json --seconds 0.05 " + (folder / "scene.toml"));
  const json summary = json::parse(o.out), start = summary.at("start");
  CHECK(summary.at("penetrating") == 0);
  CHECK(start.at("suspended") == json::array({"post"}));
  REQUIRE(start.at("pairs").size() == 2);
  for (const json& pair : start.at("pairs")) {
    const bool post = pair.at("part") == "post";
    CHECK(pair.at("start") == (post ? "overlapping" : "touching"));
    CHECK(pair.at("depth_m").get<double>() == Approx(post ? 2e-3 : 3e-6).margin(1e-9));
    CHECK(pair.at("state") == (post ? "suspended" : "active"));
  }
  CHECK(start.at("shift_m").get<double>() == Approx(4.3e-6).margin(0.2e-6));
}

TEST_CASE("an overlap is refused in one line; the tolerance is the scene's", "[start]") {
  const TempFolder folder;
  write_scene(folder, 15e-6, 0.02, "");
  const Output refused = run_program("tegotae", "run --fast " + (folder / "scene.toml"));
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Contains("\"cube\" and \"plate\" intersect at the start, 15 um deep") &&
                              Contains("initial_overlap") && Contains("scene.toml"));
  CHECK(refused.err.find('\n') == refused.err.size() - 1);
  write_scene(folder, 15e-6, 0.02, "touch_tolerance = 2e-5\n");
  CHECK(run_program("tegotae", "run --fast " + (folder / "scene.toml")).code == 0);
  const Output check = run_program("tegotae", "check " + (folder / "scene.toml"));
  CHECK_THAT(check.out, Contains("touching     plate, depth 15.00 um"));
  write_scene(folder, 0, 0.02, "initial_overlap = \"allow\"\n");
  CHECK_THAT(run_program("tegotae", "run --fast " + (folder / "scene.toml")).err,
             Contains("initial_overlap") && Contains("refuse, ignore"));
}

TEST_CASE("a fit without room says which part holds, and by how much", "[start]") {
  const TempFolder folder;
  write_scene(folder, 5e-6, 0.02, "");
  // A second plate on the cube, 5 um into it: between the two there is no way, and none out.
  std::string scene = read_text(folder / "scene.toml");
  scene.insert(scene.find("[[part]]\nname = \"post\""),
               "[[part]]\nname = \"lid\"\nmesh = \"plate.obj\"\nposition = [0, 0, 0.01999]\n");
  folder.write("scene.toml", scene);
  const Output text = run_program("tegotae", "run --fast --seconds 1.5 " + (folder / "scene.toml"));
  INFO(text.out << text.err);
  CHECK_THAT(text.out, Contains("HELD FAST") && Contains("by lid: went ") && Contains("where its pen went "));
  const json held =
      json::parse(run_program("tegotae", "run --fast --json --seconds 1.5 " + (folder / "scene.toml")).out)
          .at("held_fast");
  CHECK(held.at("parts").dump().find("lid") != std::string::npos);
  CHECK(held.at("moved_m").get<double>() < 50e-6);
  CHECK(held.at("pen_m").get<double>() > 0.005);
  // The same cube that may be lifted off says nothing of it.
  write_scene(folder, 5e-6, 0.02, "");
  const Output free = run_program("tegotae", "run --fast --seconds 1.5 " + (folder / "scene.toml"));
  CHECK(free.out.find("HELD FAST") == std::string::npos);
}
