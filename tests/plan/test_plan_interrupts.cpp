// `tegotae plan` as somebody watches it through a pipe and ends it with Ctrl-C.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "spawn.hpp"
#include "tegotae/record/recording.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// `tegotae plan` on a scene, without end unless it is ended; its stderr is the program's output here, and its stdout
/// goes into a file.
struct Planning {
  TempFolder folder;
  std::string to = folder / "out", said = folder / "said";
  std::unique_ptr<Program> program;

  void begin(const std::string& scene, const std::string& arguments) {
    REQUIRE(run_program("tegotae-models", "--puzzles --out " + (folder / "puzzles")).code == 0);
    program = std::make_unique<Program>(std::vector<std::string>{
        "/bin/sh", "-c",
        "TEGOTAE_PROGRESS_SECONDS=0.1 exec " TEGOTAE_BIN_DIR "/tegotae plan " + (folder / ("puzzles/" + scene)) +
            " --progress --iterations 1000000000 " + arguments + " --to " + to + " 2>&1 >" + said});
  }
  /// Reads what it is at until that begins with one of `these`; REQUIREs that it comes to that.
  void wait_for(const std::vector<std::string>& these) {
    const auto is_one = [&](const std::string& line) {
      return std::any_of(these.begin(), these.end(),
                         [&](const std::string& begin) { return line.rfind(begin, 0) == 0; });
    };
    std::string line;
    do {
      line = program->line();
      REQUIRE(!line.empty());
      CHECK(line.find('\033') == std::string::npos);
      CHECK(line.find('\r') == std::string::npos);
    } while (!is_one(line));
  }
};

/// A path's files are whole, and about one path.
void check_files(const std::string& folder) {
  const std::string csv = read_text(folder + "/path.csv");
  REQUIRE(!csv.empty());
  CHECK(csv.back() == '\n');
  std::istringstream lines(csv);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) CHECK(std::count(line.begin(), line.end(), ',') == 11);
  const Recording recording = read_recording(folder + "/recording.csv");
  CHECK(recording.damage.empty());
  CHECK(recording.frames.size() > 1);
  CHECK(rows > 1);
  CHECK(read_text(folder + "/script.csv").back() == '\n');
  const std::string glb = read_text(folder + "/path.glb");
  REQUIRE(glb.size() > 12);
  std::uint32_t size;
  std::memcpy(&size, glb.data() + 8, 4);
  CHECK(size == glb.size());
}

}  // namespace

TEST_CASE("Ctrl-C in the search keeps the way to the farthest pose") {
  Planning p;
  p.begin("locked-in.toml", "");
  p.wait_for({"searching: "});
  CHECK(p.program->end(SIGINT) == 1);
  CHECK_THAT(read_text(p.said), Contains("no way out was found") && Contains("interrupted"));
  const json plan = json::parse(read_text(p.to + "/plan.json"));
  CHECK(plan.at("found") == false);
  CHECK(plan.at("interrupted") == true);
  check_files(p.to);
}

// Shortening and certifying the way of a screw takes a hundred times what a line of progress takes to come.
TEST_CASE("Ctrl-C after a way was found keeps it, and says that it was interrupted") {
  Planning p;
  p.begin("screw.toml", "--seed 1");
  p.wait_for({"shortening: ", "certifying: ", "searching for a wider way: "});
  CHECK(p.program->end(SIGINT) == 1);
  CHECK_THAT(read_text(p.said),
             Contains("\"screw\" comes out") && Contains("proved to leave") && Contains("  interrupted: "));
  const json plan = json::parse(read_text(p.to + "/plan.json"));
  CHECK(plan.at("found") == true);
  CHECK(plan.at("interrupted") == true);
  CHECK(plan.at("clearance_m").get<double>() > 1e-6);
  CHECK(plan.at("turn_rad").get<double>() > 6);
  check_files(p.to);
}

TEST_CASE("Ctrl-C while an assembly is taken apart keeps the steps that were found") {
  Planning p;
  // The block and its peg come apart; the key stays in its lock for as long as it is tried.
  p.folder.write("two.toml",
                 "unit = \"mm\"\n"
                 "[[part]]\nname = \"lock\"\nmesh = \"puzzles/locked-in_fixed.obj\"\n"
                 "[[part]]\nname = \"key\"\nmesh = \"puzzles/locked-in_held.obj\"\n"
                 "orientation = [0.707106781, 0, 0, 0.707106781]\n"
                 "[[part]]\nname = \"block\"\nmesh = \"puzzles/straight_fixed.obj\"\nposition = [0.2, 0, 0]\n"
                 "[[part]]\nname = \"peg\"\nmesh = \"puzzles/straight_held.obj\"\nposition = [0.2, 0, -0.0049]\n");
  p.begin("../two.toml", "--all");
  p.wait_for({"2 parts left, trying "});
  CHECK(p.program->end(SIGINT) == 1);
  CHECK_THAT(read_text(p.said), Contains("peg: ") && Contains("block: ") && Contains("(interrupted)"));
  const std::string order = read_text(p.to + "/order.csv");
  CHECK(std::count(order.begin(), order.end(), '\n') == 3);
  for (const char* file : {"/step-01.csv", "/step-02.csv", "/order.dot"}) {
    CAPTURE(file);
    REQUIRE(!read_text(p.to + file).empty());
    CHECK(read_text(p.to + file).back() == '\n');
  }
  CHECK_THAT(read_text(p.to + "/order.html"), Contains("</html>"));
  CHECK(!std::filesystem::exists(p.to + "/step-03.csv"));
}

TEST_CASE("a judge that was ended goes on with the scenes that it has not done") {
  const TempFolder folder;
  const std::string rows = folder / "rows.json", table = folder / "table.md";
  folder.write("table.md", "before\n<!-- begin generated -->\nold\n<!-- end generated -->\nafter\n");
  const auto begin = [&](const std::string& seconds, const std::vector<std::string>& more) {
    std::vector<std::string> command = {TEGOTAE_BIN_DIR "/plan_judge", "--seeds", "1", "--seconds", seconds};
    command.insert(command.end(), {"--rows", rows});
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  {
    Program judge(begin("0.1", {"--markdown", table}));
    CHECK_THAT(judge.line(), Contains("| loose | 1 of 1"));
    CHECK_THAT(judge.line(), Contains("| straight | 1 of 1"));
    judge.end(SIGKILL);
  }
  CHECK_THAT(read_text(table), Contains("\nold\n"));  // a table is of all scenes
  json kept = json::parse(read_text(rows));
  CHECK(kept.at("loose").at("ours").at("found") == 1);
  // Figures that no search makes: those of "straight" are taken, the others are made.
  kept.at("straight").at("ours").at("clearance") = 77e-6;
  kept.erase("loose");
  folder.write("rows.json", kept.dump());
  const auto run = [&](const std::string& seconds) {
    Program judge(begin(seconds, {"--scene", "straight", "--scene", "loose"}));
    const std::string first = judge.line(), out = first + "\n" + judge.line();
    judge.end(SIGKILL);
    return out;
  };
  CHECK_THAT(run("0.1"), Contains("| loose | 1 of 1") && Contains("| straight | 1 of 1") && Contains("| 77 |"));
  // Of other searches they are not taken.
  CHECK_THAT(run("0.2"), Contains("| straight | 1 of 1") && !Contains("| 77 |"));
}
