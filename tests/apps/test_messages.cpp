// What programs print: numbers as people write them, and words while something takes long.
#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "models/write_stl.hpp"
#include "spawn.hpp"

using namespace tegotae::test;
using Catch::Contains;

namespace {

/// A setting of the environment of the programs, for as long as it lives.
class Setting {
 public:
  Setting(const char* name, const std::string& value) : name_(name) { ::setenv(name, value.c_str(), 1); }
  ~Setting() { ::unsetenv(name_); }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* name_;
};

/// The first number in `text` that nobody writes so: with an exponent, or a zero with a sign. Empty: there is none.
std::string odd_number(const std::string& text) {
  static const std::regex exponent(R"((^|[^\w.])-?\d+(\.\d+)?e[+-]?\d+)"),
      signed_zero(R"((^|[^\w.])-0(\.0*)?(?![\d.]))");
  std::smatch found;
  if (std::regex_search(text, found, exponent) || std::regex_search(text, found, signed_zero)) return found[0];
  return "";
}

/// The names under "Subcommands:" in a help text.
std::set<std::string> commands_in(const std::string& help) {
  std::set<std::string> names;
  std::istringstream lines(help.substr(std::min(help.size(), help.find("Subcommands:"))));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.substr(0, 2) == "  ")
    if (line[2] != ' ') names.insert(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

}  // namespace

TEST_CASE("numbers that nobody writes so are found", "[messages]") {
  for (const char* odd : {"limit 2.67e+03 N/m", "depth -0.0 mm", "at -0 0 1", "1e-05 mm", "(-0.00, 1.00) mm"})
    CHECK(odd_number(odd) != "");
  for (const char* good : {"limit 2667 N/m", "depth -0.03 mm", "scene-0.toml", "peg_0.94", "a1e-5", "-0.5"})
    CHECK(odd_number(good) == "");
}

TEST_CASE("programs write numbers as people do", "[messages]") {
  const TempFolder folder;
  write_small_scene(folder);
  // Extents with a sign of zero, far and near numbers, a contact length and a script of thousands.
  folder.write("tet.obj", "v -0 -0 -0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  folder.write("path.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,-1e-12,-1e-13,0.02,1,0,0,0\n0.3,0.00001,0,0.02,1,0,0,0\n"
               "5000,0.01,0,0.02,1,0,0,0\n");
  const std::string base = read_text(folder / "scene.toml");
  folder.write("scene.toml", base + "[contact]\nl_min = 0.002\n[coupling]\nstiffness = 12345.6\n");
  folder.write("light.toml", "weight = true\n" + base);
  folder.write("near.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.02,1,0,0,0\n0.1,-0.00002,0,0.02,1,0,0,0\n"
               "0.3,0.004,0,0.02,1,0,0,0\n");
  folder.write("touch.toml", base + "[contact]\ntouch_tolerance = 1e-9\n");
  folder.write("study.toml",
               "scenes = [\"light.toml\"]\nseconds = 5000\nrepeats = 1\n[parameters]\noperator = [\"hasty\"]\n"
               "[[parameters.friction]]\nvalue = [0]\n");
  const std::string scene = folder / "scene.toml", near = " --script " + (folder / "near.csv");
  const std::string record = folder / "r.mcap";
  std::vector<std::pair<std::string, std::string>> commands = {
      {"tegotae", "run --fast --seconds 0.01 " + scene},
      {"tegotae", "run --fast --seconds 0.05 " + (folder / "light.toml") + near},
      {"tegotae", "run --fast " + (folder / "light.toml") + near + " --record " + record},
      {"tegotae", "run --fast --seconds 4000 --device shm:none " + scene},
      {"tegotae", "run --progress --seconds 0.3 " + (folder / "light.toml") + near},
      {"tegotae", "check " + scene + " " + (folder / "tet.obj")},
      {"tegotae", "check --clash --within 90mm " + scene},
      {"tegotae", "import " + (folder / "tet.obj") + " -o " + (folder / "i") + " --unit um"},
      {"tegotae", "import " + (folder / "tet.obj") + " -o " + (folder / "j") + " --unit m"},
      {"tegotae", "import " + (folder / "tet.obj") + " -o " + (folder / "k") + " --unit mm --split"},
      {"tegotae", "review " + record + " --out " + (folder / "r.html") + " --band 1nm 20mm"},
      {"tegotae", "review " + record + " --goal 0,0,1 --out " + (folder / "r.html")},
      {"tegotae", "replay " + record + " --html " + (folder / "p.html")},
      {"tegotae", "plan " + scene + " --clearance 2mm --seed 1 --to " + (folder / "plan")},
      {"tegotae", "plan " + scene + " --all --seed 1 --to " + (folder / "all")},
      {"tegotae",
       "try " + (folder / "light.toml") + " --goal 0.01,0,0.02 --tries 2 --seconds 2 --out " + (folder / "t")},
      {"tegotae", "run --fast --guide " + (folder / "near.csv") + " --seconds 0.01 " + scene},
      {"tegotae", "--help"},
      {"peg_in_hole", "--fast --seconds 1"},
      {"peg_in_hole", "--fast --resolver penalty"}};
  const Setting often("TEGOTAE_PROGRESS_SECONDS", "0.05");
  for (const auto& [program, arguments] : commands) {
    const Output o = run_program(program, arguments);
    INFO(program << " " << arguments << "\n" << o.out << o.err);
    CHECK(o.code <= 2);
    CHECK(odd_number(o.out) == "");
    CHECK(odd_number(o.err) == "");
  }
}

TEST_CASE("every command has --progress, and those that have commands too", "[messages]") {
  const std::set<std::string> commands = commands_in(run_program("tegotae", "--help").out);
  for (const char* known : {"run", "view", "replay", "check", "import", "study", "bench"})
    CHECK(commands.count(known) == 1);
  for (const std::string& command : commands) {
    INFO(command);
    const Output help = run_program("tegotae", command + " --help");
    CHECK_THAT(help.out, Contains("--progress"));
    for (const std::string& part : commands_in(help.out)) {
      INFO(part);
      CHECK_THAT(run_program("tegotae", command + " " + part + " --help").out, Contains("--progress"));
    }
  }
  CHECK_THAT(run_program("peg_in_hole", "--help").out, Contains("--progress"));
  const Output study = run_program("tegotae", "study none.toml --progress");
  CHECK(study.code == 2);
  CHECK_THAT(study.err, Contains("none.toml: no such file"));
}

TEST_CASE("a file in the place of a command is looked at", "[messages]") {
  const TempFolder folder;
  write_small_scene(folder);
  for (const char* file : {"tet.obj", "scene.toml"}) {
    INFO(file);
    Program view({TEGOTAE_BIN_DIR "/tegotae", folder / file, "--no-browser"});
    std::string line;
    while ((line = view.line()).rfind("Open http://", 0) != 0 && !line.empty()) continue;
    CHECK(line != "");
    CHECK(view.end(SIGINT) == 0);
  }
}

TEST_CASE("in virtual time no tick is said to have ended for its time", "[messages]") {
  // The peg slips off the rim in a tick, and is where the pen wants it in the next one.
  const Output o = run_program("peg_in_hole", "--fast");
  INFO(o.out);
  CHECK(o.code == 0);
  CHECK(o.out.find("for time") == std::string::npos);
  CHECK(o.out.find("the tick ended") == std::string::npos);
}

TEST_CASE("what takes long with a large mesh is said, into a pipe too", "[messages]") {
  const TempFolder folder;
  write_small_scene(folder);
  write_stl(tegotae::shapes::cylinder(0.02, 0.06, 1000, 199), folder / "large.stl");  // 400 000 triangles
  std::string scene = read_text(folder / "scene.toml");
  scene.replace(scene.find("\"tet.obj\""), 9, "\"large.stl\"\nposition = [0.1, 0, 0]");
  folder.write("scene.toml", scene);
  // No cache: all of it is done each time. And often, so that no machine is too fast.
  const Setting no_cache("XDG_CACHE_HOME", "/dev/null/none"), often("TEGOTAE_PROGRESS_SECONDS", "0.02");
  const std::string file = folder / "scene.toml", record = folder / "r.csv";
  const std::string building = "building hierarchies ", reading = "reading mesh files ";
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"run --fast " + file + " --record " + record, {reading, building}},
      {"run --fast --json " + file, {reading, building}},
      {"check " + (folder / "large.stl"), {"reading " + (folder / "large.stl"), "checking " + (folder / "large.stl")}},
      {"check " + file, {reading, "checking block", building}},
      {"import " + (folder / "large.stl") + " --unit mm -o " + (folder / "i"), {"reading the file"}},
      {"replay " + record + " --html " + (folder / "r.html"), {reading, building}},
      {"review " + record + " --out " + (folder / "v.html"), {reading, building}}};
  for (const auto& [arguments, words] : cases) {
    const Output o = run_program("tegotae", arguments + " --progress");
    INFO(arguments << "\n" << o.out << o.err);
    CHECK(o.code == 0);
    for (const std::string& word : words) {
      CHECK_THAT(o.err, Contains(word));
      CHECK(o.out.find(word) == std::string::npos);
    }
    CHECK(o.err.find('\033') == std::string::npos);
    CHECK(run_program("tegotae", arguments + (arguments.rfind("import", 0) == 0 ? "2" : "")).err.find(words[0]) ==
          std::string::npos);
  }
  const std::string err = folder / "err";
  Program view(
      {"/bin/sh", "-c", "exec " TEGOTAE_BIN_DIR "/tegotae view --no-browser --progress " + file + " 2>" + err});
  std::string line;
  while ((line = view.line()).rfind("stability:", 0) != 0 && !line.empty()) continue;
  CHECK(line != "");
  view.end(SIGINT);
  const std::string told = read_text(err);
  INFO(told);
  for (const std::string& word : {reading, std::string("preparing the page"), building})
    CHECK_THAT(told, Contains(word));
}

TEST_CASE("a value that is not allowed is told with its option and with what is", "[messages]") {
  // The ranges and names are those of programs.md and --help.
  const std::vector<std::tuple<std::string, std::string, std::string>> lines = {
      {"tegotae", "try s.toml --tries 0", "tegotae: --tries: 0 is not a whole number from 1 to 100000 (see --help)\n"},
      {"tegotae", "try s.toml --tries 1.5",
       "tegotae: --tries: 1.5 is not a whole number from 1 to 100000 (see --help)\n"},
      {"tegotae", "try s.toml --seconds nan", "tegotae: --seconds: nan is not a number from 1 to 3600 (see --help)\n"},
      {"tegotae", "run s.toml --seconds -1",
       "tegotae: --seconds: -1 is not a positive number up to 1000000 (see --help)\n"},
      {"tegotae", "plan s.toml --seconds 1e9",
       "tegotae: --seconds: 1e9 is not a number from 0.1 to 1000000 (see --help)\n"},
      {"tegotae", "study case s.toml x", "tegotae: NUMBER: x is not a whole number of at least 0 (see --help)\n"},
      {"tegotae", "import a.step -o b --unit km", "tegotae: --unit: km is none of m, cm, mm, um, in (see --help)\n"},
      {"tegotae", "review r.csv --band 5um", "tegotae: --band needs 2 values (see --help)\n"},
      {"tegotae", "run s.toml --script", "tegotae: --script needs FILE (see --help)\n"},
      {"tegotae", "run s.toml --seconds 1 --seconds 2", "tegotae: --seconds is given more than once (see --help)\n"},
      {"tegotae", "run a.toml b.toml c", "tegotae: run has no use for b.toml, c (see --help)\n"},
      {"tegotae-device", "--cpu -2", "tegotae-device: --cpu: -2 is not a whole number of at least 0 (see --help)\n"},
      {"tegotae-device", "--type simulated --rate 5",
       "tegotae-device: --rate: 5 is not a number from 10 to 4000 (see --help)\n"},
      {"tegotae-device", "--type gampad",
       "tegotae-device: --type: gampad is none of simulated, openhaptics, spacemouse, gamepad; did you mean gamepad? "
       "(see --help)\n"},
      {"peg_in_hole", "--ratio 2", "peg_in_hole: --ratio: 2 is not a number from 0.5 to 0.9995\n"},
      {"tegotae-models", "--out x --rings 0",
       "tegotae-models: --rings: 0 is not a whole number from 1 to 8192 (see --help)\n"}};
  for (const auto& [program, arguments, told] : lines) {
    CAPTURE(program, arguments);
    const Output o = run_program(program, arguments);
    CHECK(o.code == 2);
    CHECK(o.out == "");
    CHECK(o.err == told);
  }
}

TEST_CASE("options and commands that are not there: what was meant", "[messages]") {
  // A letter too many, too few, another one, two swapped; the beginning of a name.
  const std::vector<std::tuple<std::string, std::string, std::string>> meant = {
      {"tegotae", "run s.toml --fastt", "--fast"},
      {"tegotae", "run s.toml --recod r.csv", "--record"},
      {"tegotae", "view s.toml --tristed", "--trusted"},
      {"tegotae", "try s.toml --treis=5", "--tries"},
      {"tegotae", "plan s.toml --iter 5", "--iterations"},
      {"tegotae", "study run s.toml --replay 5", "--replays"},
      {"peg_in_hole", "--rato 0.9", "--ratio"},
      {"tegotae-device", "--scrpit s.csv", "--script"},
      {"tegotae-models", "--ring 5", "--rings"},
      {"tegotae", "--versoin", "--version"},
      {"tegotae", "rnu s.toml", "run"},
      {"tegotae", "experiments wall", "experiment"}};
  for (const auto& [program, arguments, name] : meant) {
    CAPTURE(program, arguments);
    const Output o = run_program(program, arguments);
    CHECK(o.code == 2);
    CHECK_THAT(o.err, Contains("there is no ") && Contains("; did you mean " + name + "?"));
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
  }
  // What is like nothing is not guessed at.
  CHECK(run_program("tegotae", "run s.toml --color").err ==
        "tegotae: there is no option --color for run (see --help)\n");
  CHECK_THAT(run_program("tegotae", "mesh s.toml").err,
             Contains("there is no command mesh, but run, ") && !Contains("mean"));
}
