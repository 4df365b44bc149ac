// `tegotae import`, and what is done with its scenes.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "apps/refusal.hpp"
#include "apps/run_program.hpp"
#include "catch.hpp"
#include "core/sanitizers.hpp"
#ifdef TEGOTAE_HAS_STEP
#include "mesh/step_assembly.hpp"
#endif
#include "recording.hpp"
#include "tegotae/mesh/report.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {}  // namespace

TEST_CASE("a mesh file becomes a scene that runs", "[import]") {
  const TempFolder folder;
  folder.write("two pieces.obj",
               "g a/b\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
               "g a/b\nv 40 0 0\nv 50 0 0\nv 40 10 0\nv 40 0 10\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
  const std::string file = "'" + (folder / "two pieces.obj") + "'";
  const Output o = run_program("tegotae", "import " + file + " --unit mm --split -o " + (folder / "out"));
  INFO(o.err);
  REQUIRE(o.code == 0);
  CHECK(o.out.find("2 parts, 2 meshes, 8 triangles, 50 x 10 x 10 mm") != std::string::npos);
  CHECK(o.out.find("tegotae view " + (folder / "out/scene.toml")) != std::string::npos);
  CHECK(o.out.find("--hold NAME") != std::string::npos);
  const SceneFile scene = load_scene(folder / "out/scene.toml", {"a/b", true, {}});
  REQUIRE(scene.scene.parts.size() == 2);
  CHECK(scene.scene.parts[1].name == "a/b_2");
  CHECK((scene.scene.parts[1].pose * report(*scene.scene.parts[1].mesh).box_max - Vec3(0.05, 0.01, 0.01)).norm() <
        1e-8);
  const Output rest = run_program("tegotae", "run --fast --hold a/b_2 " + (folder / "out/scene.toml"));
  CHECK(rest.code == 0);
  CHECK(rest.err.find("the scene has no script, so nothing moves a/b_2: --view") != std::string::npos);
  check_refused(run_program("tegotae", "run --fast " + (folder / "out/scene.toml")),
                {"no part is held", "--hold NAME", "(there are a/b, a/b_2)"});
  check_refused(run_program("tegotae", "run --fast --hold c " + (folder / "out/scene.toml")), {"no part is named c"});
  const Output check = run_program("tegotae", "check " + (folder / "out/scene.toml"));
  CHECK(check.code == 0);
  CHECK(check.out.find("no part is held") != std::string::npos);
  check_refused(run_program("tegotae", "import " + file + " -o " + (folder / "out")), {"scene.toml: exists already"});
  check_refused(run_program("tegotae", "import " + file + " --unit mm --hold c -o " + (folder / "new")),
                {"no part is named c"});
  CHECK(!std::filesystem::exists(folder / "new"));
  check_refused(run_program("tegotae", "import " + (folder / "none.glb") + " -o " + (folder / "new")), {"none.glb"});
  check_refused(run_program("tegotae", "import " + file + " --chord 5 -o " + (folder / "new")), {"--chord"});
  folder.write("plain", "");
  check_refused(run_program("tegotae", "import " + file + " --unit mm -o " + (folder / "plain")), {"plain"});
}

TEST_CASE("a file of parts runs with a script, and otherwise says the command that shows it", "[import]") {
  const TempFolder folder;
  folder.write("pin.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 50\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string file = folder / "pin.obj";
  folder.write("up.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.2,0,0,0.01,1,0,0,0\n");
  const std::string script = " --script " + (folder / "up.csv");
  check_refused(run_program("tegotae", "run --fast " + file), {"has no script", "`tegotae view " + file + "`"});
  check_refused(run_program("tegotae", "run --fast " + file + script), {"pin.obj: 51.96 m across", "--unit mm"});
  const Output o = run_program("tegotae", "run --fast --unit mm " + file + script);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK(o.out.find("The hand holds pin") != std::string::npos);
  CHECK(o.out.find("pin.obj: done") != std::string::npos);
  CHECK(o.out.find("depth        10.") != std::string::npos);
  check_refused(run_program("tegotae", "run --fast --unit mm --record " + (folder / "r.csv") + " " + file + script),
                {"a recording names its scene", "tegotae import"});
  check_refused(run_program("tegotae", "run --fast --unit mm --hold nut " + file + script), {"no part is named nut"});
  // Nothing stays beside the file.
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / ".")) files += entry.is_regular_file();
  CHECK(files == 2);
}

TEST_CASE("control characters in names become spaces, so that the scene can be read", "[import]") {
  const TempFolder folder;
  folder.write("two.obj",
               "g a\x01"
               "b\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
               "g c\nv 40 0 0\nv 50 0 0\nv 40 10 0\nv 40 0 10\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
  REQUIRE(run_program("tegotae", "import " + (folder / "two.obj") + " --unit mm --split -o " + (folder / "out")).code ==
          0);
  CHECK(load_scene(folder / "out/scene.toml", {"a b", true, {}}).scene.parts.size() == 2);
}

TEST_CASE("clashes are listed by name, depth and place", "[import]") {
  const TempFolder folder;
  write_small_scene(folder);
  std::string scene = read_text(folder / "scene.toml");
  scene = scene.substr(0, scene.find("[device]"));
  scene += "[[part]]\nname = \"third\"\nmesh = \"tet.obj\"\nposition = [0, 0, 0.009]\n";
  folder.write("clash.toml", scene);
  const Output o = run_program("tegotae", "check --clash " + (folder / "clash.toml"));
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  // The tip of the block, 10 mm high, ends 1 mm inside the third one: nearest are the planes x = 0 and y = 0, on which
  // it lies.
  CHECK(o.out.find("block and third: ") != std::string::npos);
  CHECK(o.out.find("peg and third") == std::string::npos);
  const Output wide = run_program("tegotae", "check --clash --within 2mm " + (folder / "clash.toml"));
  CHECK(wide.out.find("peg and third: near, gap 1 mm") != std::string::npos);
  CHECK(wide.out.find("of 3 parts") != std::string::npos);
  check_refused(run_program("tegotae", "check --clash " + (folder / "tet.obj")), {"tet.obj: --clash needs a scene"});
  check_refused(run_program("tegotae", "check --within 2mm " + (folder / "clash.toml")), {"--clash"});
}

#if !defined(TEGOTAE_SANITIZED)
TEST_CASE("an import that takes too much memory says so, and leaves nothing", "[import]") {
  const TempFolder folder;
  std::string big;
  for (int i = 0; i < 100'000; ++i)
    big += "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf -4 -2 -3\nf -4 -3 -1\nf -3 -2 -1\n";
  folder.write("big.obj", big);
  const std::string command = "import " + (folder / "big.obj") + " --unit mm -o " + (folder / "out");
  const Output o = run_program("tegotae", command + " --megabytes 100");
  CHECK(o.code == 2);
  CHECK(o.err == "tegotae: " + (folder / "big.obj") +
                     ": not read: it takes more than 100 MB of memory; tegotae import has --megabytes\n");
  CHECK(!std::filesystem::exists(folder / "out"));
  CHECK(run_program("tegotae", command + " --megabytes 4000").code == 0);
  std::filesystem::remove_all(folder / "out");
  CHECK(run_program("tegotae", command).code == 0);
}
#endif

#ifdef TEGOTAE_HAS_STEP
TEST_CASE("an import that takes too long says at what, and leaves nothing", "[import]") {
  const TempFolder folder;
  StepSizes huge;  // as when millimeters are taken for meters: facets of 5 um on cones of 6 m take minutes
  for (double* size :
       {&huge.plate_x, &huge.plate_y, &huge.plate_z, &huge.bore, &huge.bushing_outer, &huge.bushing_inner,
        &huge.bushing_length, &huge.shaft, &huge.shaft_length, &huge.window, &huge.dowel_hole, &huge.dowel,
        &huge.dowel_length, &huge.chamfer_length, &huge.chamfer_depth, &huge.cover_z, &huge.bore_at, &huge.dowel_at})
    *size *= 1000;
  write_step_assembly(folder / "huge.step", huge, "MM", "AP214IS");
  const Output o = run_program("tegotae", "import " + (folder / "huge.step") + " --seconds 2 -o " + (folder / "out"));
  INFO(o.err);
  CHECK(o.code == 2);
  CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
  for (const char* part : {"huge.step: not read: tessellating \"", " m across) took more than 2 s", "unit", "--chord"})
    CHECK(o.err.find(part) != std::string::npos);
  CHECK(!std::filesystem::exists(folder / "out"));
}

TEST_CASE("damaged STEP files end in one line, whatever the reader does with them", "[import]") {
  const TempFolder folder;
  write_step_assembly(folder / "a.step", {}, "MM", "AP214IS");
  const std::string whole = read_text(folder / "a.step");
  std::mt19937 random(5);
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    std::string bad = whole;
    for (int k = 0; k < 1 + 3 * (i % 3); ++k)
      bad[whole.find("DATA;") + random() % (whole.size() - whole.find("DATA;") - 40)] =
          "0123456789,#()$.AB"[random() % 18];
    folder.write("bad.step", bad);
    const Output o = run_program("tegotae", "import " + (folder / "bad.step") + " -o " + (folder / "out"));
    INFO(i << " " << o.err);
    CHECK((o.code == 0 || o.code == 2));
    if (o.code == 2) {
      ++refused;
      CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
      CHECK(!std::filesystem::exists(folder / "out"));
    }
    std::filesystem::remove_all(folder / "out");
  }
  CHECK(refused > 0);
}
#endif
