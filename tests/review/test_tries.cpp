// `tegotae try`: the same for any number of jobs, after an interruption, and in words.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "recording.hpp"
#include "review/cube_scene.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;
using nlohmann::json;

namespace {

// Onto the floor, 20 µm over it.
const char* const kGoal = " --goal 0,0,0.01002 --seconds 6";

Output tries(const std::string& scene, const std::string& out, const std::string& more) {
  const Output o = run_program("tegotae", "try " + scene + " --out " + out + " " + more);
  INFO(o.err);
  CHECK(o.err.empty());
  return o;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("tries are the same for any number of jobs and after going on") {
  const TempFolder folder;
  const std::string scene = write_cube_scene(folder);
  const std::string one = folder / "one", two = folder / "two", bits = folder / "bits";
  const Output o = tries(scene, one, std::string("--tries 4 --jobs 1") + kGoal);
  CHECK(o.code == 0);
  CHECK_THAT(o.out, Contains("4 of 4 tries reached the goal"));
  tries(scene, two, std::string("--tries 4 --jobs 2") + kGoal);
  tries(scene, bits, std::string("--tries 2 --jobs 2") + kGoal);
  CHECK(lines(read_text(bits + "/tries.csv")) == 4);
  tries(scene, bits, std::string("--tries 4 --jobs 2") + kGoal);
  for (const char* file : {"/tries.csv", "/summary.json", "/best.csv"}) {
    INFO(file);
    CHECK(!read_text(one + file).empty());
    CHECK(read_text(one + file) == read_text(two + file));
    CHECK(read_text(one + file) == read_text(bits + file));
  }
  const json summary = json::parse(read_text(one + "/summary.json"));
  CHECK(summary.at("tries") == 4);
  CHECK(summary.at("reached") == 4);
  for (const char* group : {"by_operator", "by_route"}) {
    int made = 0, reached = 0;
    for (const auto& counted : summary.at(group)) {
      made += counted.at("tries").get<int>();
      reached += counted.at("reached").get<int>();
    }
    CHECK(made == 4);
    CHECK(reached == 4);
  }
  CHECK(read_text(one + "/report.html").find("4 of 4 tries reached the goal") != std::string::npos);

  // Another seed is another task, and gives other paths.
  const Output refused = run_program("tegotae", "try " + scene + " --out " + one + " --seed 2 --tries 4" + kGoal);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Contains("tries.csv:1: holds tries of another"));
  tries(scene, folder / "other", std::string("--seed 2 --tries 4") + kGoal);
  CHECK(read_text(folder / "other/best.csv") != read_text(one + "/best.csv"));

  // The best path, asked of FCL, ends at its goal.
  const FclOracle oracle(load_scene(scene).scene);
  const std::vector<RecordedRow> rows = read_recording(one + "/best.csv");
  for (const RecordedRow& row : rows) REQUIRE(oracle.intersecting(row.x).empty());
  CHECK((rows.back().x.p - Vec3(0, 0, 0.01002)).norm() < 2e-3);
  const Output review = run_program("tegotae", "review " + one + "/best.csv --goal 0,0,0.01002");
  INFO(review.out << review.err);
  CHECK(review.code == 0);
  CHECK_THAT(review.out, Contains("It goes in"));
}

TEST_CASE("tries that cannot succeed tell who is in the way") {
  const TempFolder folder;
  const std::string scene = write_cube_scene(folder);
  // Into the roof from below: the straight way only, for no other one is free.
  const Output o = tries(scene, folder / "t", "--tries 2 --goal 0.02,0,0.036 --seconds 3");
  CHECK(o.code == 1);
  CHECK_THAT(o.out, Contains("0 of 2 tries reached the goal"));
  const json summary = json::parse(read_text(folder / "t/summary.json"));
  CHECK(summary.at("reached") == 0);
  CHECK(summary.at("blocked_by").at("roof") == 2);
  CHECK_THAT(o.out, Contains("  2 failed: blocked by roof\n"));
  // Nothing in the way, and no time to go there.
  const Output late = tries(scene, folder / "late", "--tries 1 --goal 0.5,0,0.03 --seconds 1");
  CHECK(late.code == 1);
  CHECK_THAT(late.out, Contains("  1 failed: nothing blocked it at the end; the hand did not bring it there\n"));
}

namespace {

/// A try and the review of its recording. What `try` says of why it failed is what the review says; returns whether it
/// did fail.
bool agrees(const std::string& scene, const std::string& options, const std::string& out) {
  std::filesystem::remove_all(out);
  const Output tried = run_program("tegotae", "try " + scene + " --tries 1 --out " + out + " " + options);
  const Output review = run_program("tegotae", "review " + out + "/best.csv");
  INFO(scene << " " << options << "\n" << tried.out << tried.err << review.out << review.err);
  CHECK(tried.code <= 1);
  CHECK(review.code == tried.code);
  const auto failed = tried.out.find("FAILED: ");
  CHECK((failed != std::string::npos) == (tried.code == 1));
  if (failed == std::string::npos) return false;
  const std::string why = tried.out.substr(failed + 8, tried.out.find('\n', failed) - failed - 8);
  const std::string headline = review.out.substr(0, review.out.find('\n'));
  CHECK_THAT(headline, StartsWith("It does not ") && EndsWith(": " + why));
  return true;
}

}  // namespace

TEST_CASE("a try and the review of its recording never disagree") {
  const TempFolder folder;
  const std::string scene = write_cube_scene(folder), out = folder / "t";
  int failed = 0, all = 0;
  const auto look = [&](const std::string& file, const std::string& options) {
    failed += agrees(file, options, out) ? 1 : 0;
    ++all;
  };
  // Whenever the time is over: before the part is there, there, and for less than half a second.
  for (const char* goal : {"0,0,0.01002", "0.012,0,0.03", "0.02,0,0.036", "out"})
    for (const char* seconds : {"1", "1.5", "3"})
      look(scene, std::string("--goal ") + goal + " --seconds " + seconds + " --seed " + std::to_string(all));
  CHECK(failed > 3);
  CHECK(all - failed > 3);
  // Fits: a pin in a slot 40 um wider, in and out.
  folder.write("fit.toml",
               "unit = \"mm\"\n[[part]]\nname = \"left\"\nmesh = \"cube.obj\"\nposition = [-0.01002, 0, 0]\n"
               "[[part]]\nname = \"right\"\nmesh = \"cube.obj\"\nposition = [0.01002, 0, 0]\n"
               "[[part]]\nname = \"below\"\nmesh = \"cube.obj\"\nposition = [0, 0, -0.0101]\n"
               "[[part]]\nname = \"pin\"\nmesh = \"cube.obj\"\nheld = true\n");
  for (const char* goal : {"out", "0,0,0.0002", "0,0,0.002", "0,0,-0.003", "0.003,0,0.02"})
    look(folder / "fit.toml", std::string("--goal ") + goal + " --seconds 2");
}

TEST_CASE("a try of a peg and its review never disagree", "[.][parts]") {
  const TempFolder folder;
  for (const char* model : {"/peg_in_hole_0.94.toml", "/peg_in_hole_0.99.toml"})
    for (const char* options : {"--seconds 1.5", "--seconds 3", "--seconds 4 --seed 2", "--seconds 2 --goal 0,0,0.03"})
      agrees(std::string(TEGOTAE_MODELS_DIR) + model, options, folder / "t");
}

TEST_CASE("an interrupted call keeps its tries and goes on") {
  const TempFolder folder;
  const std::string scene = write_cube_scene(folder), out = folder / "t";
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const std::string command =
        std::string(TEGOTAE_BIN_DIR "/tegotae try ") + scene + " --out " + out + " --tries 5000" + kGoal;
    ::execl("/bin/sh", "sh", "-c", ("exec " + command + " >" + folder / "log" + " 2>&1").c_str(),
            static_cast<char*>(nullptr));
    ::_exit(127);
  }
  for (int i = 0; i < 3000 && lines(read_text(out + "/tries.csv")) < 5; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 1);
  CHECK_THAT(read_text(folder / "log"), Contains("interrupted; the same command continues from here"));
  const std::string kept = read_text(out + "/tries.csv");
  REQUIRE(lines(kept) >= 5);
  CHECK(lines(kept) < 5000);
  // What is there agrees with a call of its own.
  tries(scene, folder / "fresh", std::string("--tries 3") + kGoal);
  const std::string fresh = read_text(folder / "fresh/tries.csv");
  tries(scene, out, std::string("--tries 3") + kGoal);
  CHECK(read_text(out + "/tries.csv").compare(0, fresh.size(), fresh) == 0);
  CHECK(read_text(out + "/best.csv") == read_text(folder / "fresh/best.csv"));
}

TEST_CASE("bad input of try is one line") {
  const TempFolder folder;
  const std::string scene = write_cube_scene(folder);
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const Output o = run_program("tegotae", "try " + scene + " --out " + folder / "t " + arguments);
    INFO(arguments << ": " << o.err);
    CHECK(o.code == 2);
    CHECK(lines(o.err) == 1);
    CHECK_THAT(o.err, Contains(why));
  };
  refused("", "its script does not move");
  refused("--goal 1", "is not a pose");
  refused("--goal 0,0,0.03", "the goal is where the held part starts");
  refused("--goal 0,0,0.02 --tries 0", "--tries");
  std::filesystem::create_directories(folder / "t");
  folder.write("t/tries.csv", "something else\n");
  refused("--goal 0,0,0.02", "tries.csv:1:");
}
