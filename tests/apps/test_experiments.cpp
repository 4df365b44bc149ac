// `tegotae experiment`: a short form of each, its files, its claims, and its tables by judges of our own.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/experiment_judges.hpp"
#include "apps/run_program.hpp"
#include "catch.hpp"

using namespace tegotae::test;
using nlohmann::json;

namespace {

void check_claims(const json& summary) {
  REQUIRE(summary.at("claims").size() > 0);
  for (const json& claim : summary.at("claims")) {
    INFO(claim.dump());
    CHECK(claim.at("name").is_string());
    CHECK(claim.at("value").is_number());
    CHECK(claim.at("target").is_string());
    CHECK(claim.at("unit").is_string());
    CHECK(claim.at("holds") == true);
    CHECK(meets(claim.at("value"), claim.at("target")));
  }
}

/// Runs the experiment and looks at its claims and files.
void check_experiment(const std::string& name, const std::string& options) {
  CAPTURE(name);
  const TempFolder folder;
  const Output o = run_program("tegotae", "experiment " + name + " " + options + " --out " + (folder / "out"));
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK(o.err.empty());  // no progress line: not a terminal
  const std::string at = (folder / "out") + "/" + name;
  const json summary = json::parse(read_text(at + "/summary.json"));
  CHECK(summary.at("experiment") == name);
  check_claims(summary);
  CHECK(read_text(at + "/report.html").find("</html>") != std::string::npos);
  int tables = 0;
  for (const auto& entry : std::filesystem::directory_iterator(at)) {
    if (entry.path().extension() != ".csv") continue;
    ++tables;
    const std::string text = read_text(entry.path());
    const std::string head = text.substr(0, text.find('\n'));
    CHECK(std::count(text.begin(), text.end(), '\n') > 1);
    CHECK(head.find(',') != std::string::npos);
  }
  CHECK(tables > 0);
  judge_tables(name, at);
}

}  // namespace

TEST_CASE("the short form of each experiment holds its claims", "[experiment]") {
  check_experiment(GENERATE("wall", "insertion", "task-time", "ladder", "hold", "widening", "wrench", "friction"),
                   "--quick");
}

// The short ladder is for the default resolver; with the baselines, which may jam, it takes minutes.
TEST_CASE("every rung with all resolvers", "[.][experiment_long]") {
  check_experiment("ladder", "--seeds 1");
}

TEST_CASE("results do not depend on the number of threads", "[experiment]") {
  const TempFolder folder;
  for (const char* threads : {"1", "3"}) {
    const Output o = run_program("tegotae", std::string("experiment hold --quick --seeds 4 --threads ") + threads +
                                                " --out " + (folder / threads));
    CHECK(o.code == 0);
  }
  const std::string one = read_text(folder / "1/hold/hold.csv");
  CHECK(std::count(one.begin(), one.end(), '\n') == 17);  // a head and four cases of four resolvers
  CHECK(one == read_text(folder / "3/hold/hold.csv"));
}

TEST_CASE("what an experiment cannot be is told in one line", "[experiment]") {
  for (const char* arguments :
       {"experiment", "experiment wal", "experiment hold --seeds 0", "experiment hold --seeds -3"}) {
    const Output o = run_program("tegotae", arguments);
    CAPTURE(arguments, o.err);
    CHECK(o.code == 2);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
  }
  const Output o = run_program("tegotae", "experiment hold --quick --seeds 1 --out /dev/null/no");
  CHECK(o.code == 2);
  CHECK(o.err.find("/dev/null/no") != std::string::npos);
}
