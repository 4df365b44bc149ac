// Where the report of a study leads, and what Ctrl-C leaves.
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "study_scene.hpp"

using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& path) {
  return "'" + path + "'";
}

/// The last section of the report, which has the cases.
json cases_in(const std::string& folder) {
  const std::string page = read_text(folder + "/report.html"), begin = "id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return json::parse(page.substr(from, page.find("</script>", from) - from)).at("sections").back();
}

/// What the page makes of a row's command: the words at `files` are paths from the report's folder.
std::string arguments_of(const json& cell, const fs::path& folder) {
  std::vector<std::string> words = cell.at("command");
  for (const std::size_t place : cell.at("files"))
    words[place] = quoted((folder / words[place]).lexically_normal().string());
  REQUIRE(words.size() > 2);
  REQUIRE(words[0] + words[1] == "tegotaestudy");
  std::string out;
  for (std::size_t i = 2; i < words.size(); ++i) out += words[i] + " ";
  return out;
}

void write_six(const TempFolder& folder, const std::string& name) {
  fs::create_directories(fs::path(folder / name).parent_path());
  write_blocks(folder);
  folder.write(name, "scenes = [\"../scene.toml\"]\ngoal = \"0,0,0.0195\"\nseconds = 0.8\nrepeats = 6\n");
}

/// The test's working folder and PATH, as they were.
struct Surroundings {
  fs::path folder = fs::current_path();
  std::string path = std::getenv("PATH");
  ~Surroundings() {
    fs::current_path(folder);
    ::setenv("PATH", path.c_str(), 1);
  }
};

}  // namespace

TEST_CASE("the links of a report lead to replays: some at once, any by the command of its row") {
  const TempFolder folder;
  write_six(folder, "a b/study.toml");
  const std::string file = folder / "a b/study.toml", out = folder / "some where/out";
  run_study(quoted(file) + " --out " + quoted(out));
  run_study("merge " + quoted(file) + " --replays 2 --out " + quoted(out));
  const json cases = cases_in(out);
  const json& rows = cases.at("tables").front().at("rows");
  REQUIRE(rows.size() == 6);
  std::vector<std::string> there;
  json absent;
  for (const json& row : rows) {
    const std::string page = out + "/" + row.front().at("href").get<std::string>();
    if (fs::exists(page)) {
      there.push_back(row.front().at("text"));
      CHECK_THAT(read_text(page), Contains("</html>"));
    } else {
      absent = row;
    }
  }
  REQUIRE(there.size() == 2);
  CHECK_THAT(cases.at("text").get<std::string>(), Contains("The replays of " + there[0] + ", " + there[1] + " are"));
  run_study(arguments_of(absent.back(), out));
  CHECK_THAT(read_text(out + "/" + absent.front().at("href").get<std::string>()), Contains("</html>"));
  run_study("merge " + quoted(file) + " --replays 0 --out " + quoted(out));
  CHECK_THAT(cases_in(out).at("text").get<std::string>(), !Contains("The replays of"));
}

TEST_CASE("a report is the same bytes however the paths of its study are spelled") {
  const TempFolder folder;
  const Surroundings restored;
  write_six(folder, "a/study.toml");
  run_study(folder / "a/study.toml" + " --out " + folder / "a/out");
  const auto merged = [&](const std::string& file, const std::string& out) {
    fs::remove(folder / "a/out/report.html");
    run_study("merge " + file + " --replays 0 --out " + out);
    return read_text(folder / "a/out/report.html") + read_text(folder / "a/out/summary.json");
  };
  const std::string bytes = merged(folder / "a/study.toml", folder / "a/out");
  CHECK_THAT(bytes, Contains("\"../study.toml\""));
  CHECK(merged(folder / "a/../a/./study.toml", folder / "a/out//") == bytes);
  fs::current_path(folder / "a");
  CHECK(merged("study.toml", "out") == bytes);
  CHECK(merged("../a/study.toml", "./out/") == bytes);
}

TEST_CASE("Ctrl-C ends study run and what its driver started; the same command continues") {
  const TempFolder folder;
  const Surroundings restored;
  write_six(folder, "a/study.toml");
  // Stands in for HyperShell's `hs cluster TASKS ...`: the first time it does one task and is interrupted in another
  // one.
  fs::create_directory(folder / "bin");
  folder.write("bin/hs", "#!/bin/sh\nif [ -e '" + folder / "worker" +
                             "' ]; then exec sh \"$2\"; fi\nhead -n 1 \"$2\" | sh\nsleep 600 &\necho $! > '" +
                             folder / "worker" + "'\nkill -INT $PPID\nwait\n");
  fs::permissions(folder / "bin/hs", fs::perms::owner_all);
  ::setenv("PATH", ((folder / "bin") + ":" + restored.path).c_str(), 1);
  fs::create_directories(folder / "a/study/driver");
  folder.write("a/study/driver/screw.stl", "somebody's\n");
  const std::string command = "run " + folder / "a/study.toml" + " --shards 3 --replays 0";
  const Output o = run_study(command, 1);
  CHECK_THAT(o.out, Contains("interrupted; the same command continues"));
  CHECK(o.err.empty());
  CHECK_FALSE(fs::exists(folder / "a/study/report.html"));
  const std::string worker = read_text(folder / "worker");
  REQUIRE(std::stoi(worker) > 1);
  const std::string stat = read_text("/proc/" + std::to_string(std::stoi(worker)) + "/stat");
  CHECK((stat.empty() || stat.find(") Z ") != std::string::npos));  // where nobody waits for it it stays as a zombie

  CHECK_THAT(run_study(command).out, Contains(" of 6 cases reached the goal"));
  const std::string tasks = read_text(folder / "a/study/driver/tasks");
  CHECK(std::count(tasks.begin(), tasks.end(), '\n') == 2);  // what was done is not asked again
  CHECK(read_text(folder / "a/study/driver/screw.stl") == "somebody's\n");
  CHECK(cases_in(folder / "a/study").at("tables").front().at("rows").size() == 6);
}
