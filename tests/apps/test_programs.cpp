// The programs from end to end: summary, recording, terminal.
#include <pty.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/program_summary.hpp"
#include "catch.hpp"
#include "core/sanitizers.hpp"
#include "mesh/gltf_doc.hpp"
#include "spawn.hpp"

using namespace tegotae;
using namespace tegotae::test;
using nlohmann::json;

namespace {

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

/// Names of the keys of `value`, and of the objects in it but those whose keys are reasons.
void collect_keys(const json& value, std::set<std::string>& keys) {
  if (value.is_array())
    for (const auto& item : value) collect_keys(item, keys);
  if (!value.is_object()) return;
  for (const auto& [key, inner] : value.items()) {
    keys.insert(key);
    if (key != "force_off") collect_keys(inner, keys);
  }
}

}  // namespace

TEST_CASE("the table of the summary is complete, and names nothing that is not there", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const Output o = run_program("tegotae", "run --fast --json " + (folder / "scene.toml"));
  REQUIRE(o.code == 0);
  const json summary = json::parse(o.out);
  std::set<std::string> keys;
  collect_keys(summary, keys);

  const std::string docs = read_text(TEGOTAE_TEST_DATA_DIR "/../docs/programs.md");
  const std::size_t begin = docs.find("## The summary as JSON"), end = docs.find("\n## ", begin + 1);
  REQUIRE(begin != docs.npos);
  const std::string table = docs.substr(begin, end - begin);
  for (const std::string& key : keys) {
    CAPTURE(key);
    CHECK(table.find("`" + key + "`") != table.npos);
  }
  std::istringstream rows(table);
  std::size_t named = 0;
  for (std::string row; std::getline(rows, row);) {
    if (row.rfind("| `", 0) != 0) continue;
    const std::string fields = row.substr(0, row.find('|', 1));
    for (std::size_t at = fields.find('`'); at != fields.npos; at = fields.find('`', at + 1)) {
      const std::size_t close = fields.find('`', at + 1);
      const std::string field = fields.substr(at + 1, close - at - 1);
      CAPTURE(field);
      CHECK(summary.contains(field));
      ++named;
      at = close;
    }
  }
  CHECK(named == summary.size());
}

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
                   "fx,fy,fz,tx,ty,tz,contacts,gap,tick_us,lag_reason",
                   0) == 0);
  CHECK(std::count(text.begin(), text.end(), '\n') >= 1101);
}

TEST_CASE("--progress says into a pipe how far a run is, and what is short says nothing", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string run = "run --progress --seconds ";
  const Output o = run_program("tegotae", run + "2.5 " + (folder / "scene.toml"));
  INFO(o.err);
  CHECK(o.code == 0);
  CHECK(o.err.find("s   depth ") != std::string::npos);
  CHECK(o.err.find('\033') == std::string::npos);
  CHECK(o.out.find("s   depth ") == std::string::npos);
  const Output brief = run_program("tegotae", run + "0.2 --fast " + (folder / "scene.toml"));
  CHECK(brief.err.find("s   depth ") == std::string::npos);
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
  // In words: who was in the way, and where, as in the JSON. The floor is at z = 0.
  const Output text =
      run_program("tegotae", "run --fast --record " + (folder / "r.csv") + " " + (folder / "scene.toml"));
  CHECK(text.code == 1);
  const json by = j.at("blocked_by"), at = by.at("place_m");
  CHECK(by.at("part") == "block");
  CHECK(std::abs(at.at(2).get<double>()) < 1e-9);
  char place[96];
  const auto mm = [&](int k) { return 0.01 * std::round(1e5 * at.at(k).get<double>()) + 0.0; };  // no "-0.00"
  std::snprintf(place, sizeof place, "(%.2f, %.2f, 0.00) mm\n", mm(0), mm(1));
  CHECK_THAT(text.out, Catch::Contains(": FAILED: blocked by block at " + std::string(place)));
  CHECK_THAT(run_program("tegotae", "review " + (folder / "r.csv")).out,
             Catch::StartsWith("It does not get to its goal: blocked by block at " + std::string(place)));
  // The script of --script is what the recording is judged by, and not that of its scene.
  folder.write("up.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.02,1,0,0,0\n0.5,0,0,0.03,1,0,0,0\n");
  const Output up = run_program("tegotae", "run --fast --script " + (folder / "up.csv") + " --record " +
                                               (folder / "r.csv") + " " + (folder / "scene.toml"));
  CHECK(up.code == 0);
  CHECK_THAT(up.out, Catch::Contains(": done\n"));
  const json info = json::parse(read_text(folder / "r.csv.info.json"));
  const std::string goal = info.at("goal");
  REQUIRE(goal.rfind("0,0,", 0) == 0);
  CHECK(std::stod(goal.substr(4)) == Approx(0.03).epsilon(1e-12));
  CHECK(info.at("judged_after") == "0.5");
  CHECK(run_program("tegotae", "review " + (folder / "r.csv")).code == 0);
}

TEST_CASE("in real time every period of the servo is a tick or a counted miss", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const json j = summary_of(run_program("tegotae", "run --json " + (folder / "scene.toml")));
  // How long it takes and how many periods are missed is the machine's; that none is made twice, and that each is a
  // tick or counted, is not.
  const double seconds = j.at("seconds").get<double>();
  CHECK(seconds >= 1.1);
  CHECK(j.at("ticks").get<double>() <= 1000 * seconds + 2);
  CHECK(j.at("ticks").get<int>() > 0);
  const double rate = j.at("servo").at("rate_hz").get<double>(), missed = j.at("servo").at("missed").get<double>();
  CHECK(rate <= 1001);
  CHECK(rate * seconds + missed >= 500 * seconds);
}

TEST_CASE("the progress line is for terminals", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string scene = folder / "scene.toml";
  CHECK(run_program("tegotae", "run " + scene).out.find('\r') == std::string::npos);
  CHECK(on_a_terminal("tegotae", {"run", scene}).find("\r\033[K") != std::string::npos);
  CHECK(on_a_terminal("tegotae", {"run", "--json", scene}).find("\033[K") == std::string::npos);
}

TEST_CASE("a run says first how stiff its pen may be", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string run = "run --fast --seconds 0.01 ";
  const Output o = run_program("tegotae", run + (folder / "scene.toml"));
  // As in test_device_program, at 1 kHz.
  CHECK(o.out.rfind("stability:   stiffness 800 N/m", 0) == 0);
  CHECK(o.out.find("(limit 72 N·m/rad)") < o.out.find("cut short"));
  CHECK(run_program("tegotae", run + "--json " + (folder / "scene.toml")).out.rfind("{", 0) == 0);
}

TEST_CASE("Ctrl-C ends a run and keeps the recording", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string record = folder / "rec.csv";
  Program run(
      {TEGOTAE_BIN_DIR "/tegotae", "run", "--json", "--seconds", "60", "--record", record, folder / "scene.toml"});
  for (int i = 0; i < 2000 && !std::filesystem::exists(record); ++i) ::usleep(10'000);
  ::usleep(200'000);  // some ticks
  ::kill(run.pid(), SIGINT);
  const json j = json::parse(run.rest());
  CHECK(run.wait() == 1);
  CHECK(j.at("completed") == false);
  CHECK(j.at("seconds").get<double>() < 60);
  const std::string text = read_text(record);
  REQUIRE(!text.empty());
  CHECK(text.back() == '\n');
  CHECK(std::count(text.begin(), text.end(), '\n') > j.at("ticks").get<int>());
}

TEST_CASE("check and run tell what of a mesh is not as its file says", "[programs]") {
  const TempFolder folder;
  write_small_scene(folder);
  test::GltfDoc doc;
  doc.node({{"mesh", doc.mesh(doc.tetrahedron())}, {"scale", {10, 10, 10}}});
  doc.uses("ACME_bends", false);
  doc.save(folder, "tet");
  std::string scene = read_text(folder / "scene.toml");
  for (std::size_t at = 0; (at = scene.find("tet.obj")) != std::string::npos;) scene.replace(at, 7, "tet.gltf");
  folder.write("scene.toml", scene);
  const std::string note = "ACME_bends is not read";
  for (const char* trusted : {"", " --trusted"}) {
    INFO(trusted);
    for (const char* file : {"tet.gltf", "scene.toml"})
      CHECK_THAT(run_program("tegotae", "check " + (folder / file) + trusted).out,
                 Catch::Contains("note: ") && Catch::Contains(note));
    CHECK_THAT(run_program("tegotae", "check --clash " + (folder / "scene.toml") + trusted).err, Catch::Contains(note));
    const Output run = run_program("tegotae", "run --fast --json " + (folder / "scene.toml") + trusted);
    CHECK(run.code == 0);
    // Once, though two parts have the mesh.
    const auto at = run.err.find(note);
    REQUIRE(at != std::string::npos);
    CHECK(run.err.find("tet.gltf: ") < at);
    CHECK(run.err.find(note, at + 1) == std::string::npos);
  }
}

TEST_CASE("every program that reads a scene has its meshes read by the helper, unless they are trusted", "[programs]") {
  const TempFolder folder, alone;
  write_small_scene(folder);
  const std::string scene = folder / "scene.toml", recording = folder / "r.csv";
  folder.write("study.toml", "scenes = [\"scene.toml\"]\nseconds = 1\n");
  const Output made = run_program("tegotae", "run --fast " + scene + " --record " + recording);
  INFO(made.err);
  REQUIRE(made.code == 0);
  // A copy of the program, and no helper beside it or in PATH.
  std::filesystem::copy_file(TEGOTAE_BIN_DIR "/tegotae", alone / "tegotae");
  const auto run = [&](const std::string& arguments) {
    const std::string command = "PATH=" + (alone / "none") + " XDG_CACHE_HOME=" + (alone / "cache") + " " +
                                (alone / "tegotae") + " " + arguments + " </dev/null >" + (alone / "out") + " 2>" +
                                (alone / "err");
    Output o;
    o.code = WEXITSTATUS(std::system(command.c_str()));
    o.out = read_text(alone / "out");
    o.err = read_text(alone / "err");
    return o;
  };
  const std::string commands[] = {"check " + (folder / "tet.obj"),
                                  "check " + scene,
                                  "check --clash " + scene,
                                  "run --fast " + scene,
                                  "try " + scene + " --tries 1 --seconds 1 --out " + (alone / "tries"),
                                  "study " + (folder / "study.toml") + " --out " + (alone / "study"),
                                  "study case " + (folder / "study.toml") + " 0 --out " + (alone / "case"),
                                  "replay " + recording + " --html " + (alone / "r.html"),
                                  "review " + recording + " --out " + (alone / "review.html"),
                                  "plan " + scene + " --seconds 1 --to " + (alone / "plan"),
                                  "plan --all " + scene + " --to " + (alone / "order")};
  for (const std::string& command : commands) {
    INFO(command);
    const Output kept = run(command);
    if (kept.err.find("libompl-dev") != std::string::npos) continue;  // built without a planner
    INFO(kept.err);
    CHECK(kept.code == 2);
    CHECK_THAT(kept.err, Catch::Contains("tet.obj: the loading program tegotae-load-mesh cannot be started"));
    const Output trusted = run(command + " --trusted");
    INFO(trusted.out + trusted.err);
    CHECK(trusted.code < 2);  // done, or tried in vain
    CHECK_THAT(trusted.err, !Catch::Contains("cannot be started"));
  }
  // A page would be served until a signal.
  const Output page = run("view --no-browser " + scene);
  CHECK(page.code == 2);
  CHECK_THAT(page.err, Catch::Contains("cannot be started"));
}

TEST_CASE("a bound on memory that was set before does not stop a mesh from being read", "[programs]") {
#if !defined(TEGOTAE_SANITIZED)
  const TempFolder folder;
  write_small_scene(folder);
  for (const char* limits : {"ulimit -v 2000000; ", "ulimit -t 20; ", "ulimit -c 0; "}) {
    INFO(limits);
    const std::string command = std::string(limits) + TEGOTAE_BIN_DIR "/tegotae check " + (folder / "tet.obj") + " >" +
                                (folder / "out") + " 2>&1";
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 0);
    CHECK_THAT(read_text(folder / "out"), Catch::Contains("4 triangles"));
  }
#endif
}

TEST_CASE("check names shells that look the wrong way, also beside open ones", "[programs]") {
  const TempFolder folder;
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nv 5 0 1\n";
  const std::string inward = "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n", outward = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const std::string open = "f 5 7 6\nf 5 6 8\nf 6 7 8\n", inward_too = "f 5 6 7\nf 5 8 6\nf 6 8 7\nf 5 7 8\n";
  const auto check = [&](const std::string& faces) {
    folder.write("s.obj", corners + faces);
    return run_program("tegotae", "check " + (folder / "s.obj")).out;
  };
  const char* const rule = "the wrong way: a shell faces outwards, the wall of a cavity inwards\n";
  CHECK_THAT(check(inward + open), Catch::Contains(", 2 components, not closed\n") &&
                                       Catch::Contains(std::string("  1 of 2 shells looks ") + rule));
  CHECK_THAT(check(inward + inward_too), Catch::Contains(", 2 components, closed\n") &&
                                             Catch::Contains(std::string("  2 of 2 shells look ") + rule));
  CHECK_THAT(check(outward + open), !Catch::Contains("the wrong way"));
}

TEST_CASE("check names T-junctions", "[programs]") {
  const TempFolder folder;
  // A tetrahedron of which one face is cut in two at the middle of a side, and the face beyond is not.
  folder.write("t.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 0\nf 1 3 5\nf 5 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  CHECK_THAT(
      run_program("tegotae", "check " + (folder / "t.obj")).out,
      Catch::Contains("not closed") && Catch::Contains("  1 vertex lies on an edge of another face (T-junction)"));
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
