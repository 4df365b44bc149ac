// `tegotae plan`: what it writes, and what it says.
#include <nlohmann/json.hpp>
#include <set>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "models/puzzles.hpp"
#include "tegotae/record/recording.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// The puzzles as files.
const TempFolder& models() {
  static const TempFolder folder;
  static const Output made = run_program("tegotae-models", "--puzzles --out " + (folder / "puzzles"));
  REQUIRE(made.code == 0);
  return folder;
}

std::string scene(const std::string& name) {
  return models() / ("puzzles/" + name + ".toml");
}

}  // namespace

TEST_CASE("a plan is written, and a hand that follows it takes the part out") {
  const TempFolder folder;
  const std::string to = folder / "out";
  const Output o = run_program("tegotae", "plan " + scene("l-shaped") + " --seed 1 --to " + to);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK(o.err.empty());
  CHECK_THAT(o.out,
             Contains("\"cube\" comes out") && Contains("proved to leave") && Contains("nearest to \"channel\""));
  const json plan = json::parse(read_text(to + "/plan.json"));
  CHECK(plan.at("found") == true);
  CHECK(plan.at("held") == "cube");
  CHECK(plan.at("clearance_m").get<double>() > 1e-6);
  CHECK(plan.at("tightest").at(0).at("distance_m").get<double>() >= plan.at("clearance_m").get<double>() - 0.05e-6);
  CHECK(read_text(to + "/path.glb").substr(0, 4) == "glTF");
  CHECK(read_text(to + "/path.csv").substr(0, 16) == "t,px,py,pz,qw,qx");
  const Recording recording = read_recording(to + "/recording.csv");
  CHECK(recording.info.held == "cube");
  CHECK(recording.frames.size() > 100);

  const Output run =
      run_program("tegotae", "run " + scene("l-shaped") + " --fast --check-all --json --script " + to + "/script.csv");
  INFO(run.out << run.err);
  const json summary = json::parse(run.out);
  CHECK(summary.at("completed") == true);
  CHECK(summary.at("penetrating") == 0);

  const Output review = run_program("tegotae", "review " + to + "/recording.csv --out " + (folder / "review.html"));
  INFO(review.out << review.err);
  CHECK(review.code != 2);
}

TEST_CASE("a planned path guides the hand of a run, and no recording replaces it") {
  const TempFolder folder;
  const std::string to = folder / "out", path = to + "/path.csv";
  REQUIRE(run_program("tegotae", "plan " + scene("straight") + " --seed 1 --to " + to).code == 0);
  const std::string run = "run " + scene("straight") + " --fast --seconds 1 --guide " + path;
  const std::string record = folder / "run.csv";
  const Output o = run_program("tegotae", run + " --record " + record);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK_THAT(o.out, Contains("guide:       0.7 N and "));
  // The scene's hand stays, and feels the pull up, out of the hole.
  const Recording recording = read_recording(record);
  CHECK(recording.info.guide == path);
  CHECK(recording.frames.back().wrench.force.z() == Approx(0.7).epsilon(0.05));
  const std::string before = read_text(path);
  const Output over = run_program("tegotae", run + " --record " + path);
  CHECK(over.code == 2);
  CHECK(read_text(path) == before);
}

TEST_CASE("the same seed writes the same bytes") {
  const TempFolder folder;
  for (const char* to : {"a", "b"})
    CHECK(run_program("tegotae", "plan " + scene("key") + " --seed 5 --json --to " + (folder / to)).code == 0);
  for (const char* file : {"/path.csv", "/path.glb", "/script.csv", "/recording.csv", "/plan.json"}) {
    INFO(file);
    CHECK(!read_text(folder / ("a" + std::string(file))).empty());
    CHECK(read_text(folder / ("a" + std::string(file))) == read_text(folder / ("b" + std::string(file))));
  }
}

TEST_CASE("where nothing is found it says how far it got, what is in the way, and for how long it tried") {
  const TempFolder folder;
  const std::string to = folder / "out";
  const Output o = run_program("tegotae", "plan " + scene("locked-in") + " --iterations 200 --to " + to);
  INFO(o.out << o.err);
  CHECK(o.code == 1);
  CHECK_THAT(o.out, Contains("no way out was found for \"key\"") && Contains("(200 iterations)") &&
                        Contains("no proof that there is none") && Contains("from its start at most") &&
                        Contains("in the way: \"lock\" stopped 100 %"));
  CHECK(json::parse(read_text(to + "/plan.json")).at("found") == false);
  CHECK(read_recording(to + "/recording.csv").frames.size() > 1);
}

TEST_CASE("an assembly is taken apart") {
  const TempFolder folder;
  const std::string to = folder / "out";
  const Output o = run_program("tegotae", "plan " + scene("key") + " --all --to " + to);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK_THAT(o.out, Contains("1. key: ") && Contains("Left: lock"));
  CHECK(read_text(to + "/order.csv").find("1,\"key\",") != std::string::npos);
  CHECK_THAT(read_text(to + "/order.dot"), Contains("digraph") && Contains("1. key"));
  CHECK_THAT(read_text(to + "/order.html"), Contains("Order of disassembly"));
  CHECK(read_text(to + "/step-01.glb").substr(0, 4) == "glTF");
  CHECK(read_text(to + "/step-01.csv").substr(0, 5) == "t,px,");
  const Output stays =
      run_program("tegotae", "plan " + scene("locked-in") + " --all --iterations 30 --to " + (folder / "in"));
  CHECK(stays.code == 1);
  CHECK_THAT(stays.out, Contains("Did not come apart: key, lock") && Contains("key was stopped by lock"));
  // The graph: two parts, and who stops whom.
  const std::string page = read_text(folder / "in" + "/order.html");
  const std::size_t begin = page.find("id=\"data\">") + 10;
  const json report = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  const json graph = report.at("sections").back().at("graph");
  CHECK(graph.at("nodes").size() == 2);
  CHECK(graph.at("nodes").at(0).at("text") == "key");
  // Each of two that do not come apart stops the other.
  const std::set<json> arrows(graph.at("arrows").begin(), graph.at("arrows").end());
  CHECK(arrows == std::set<json>{json::parse("[0, 1]"), json::parse("[1, 0]")});
}

TEST_CASE("what cannot be planned is an error of one line") {
  const TempFolder folder;
  const std::string to = " --to " + (folder / "out");
  const auto refused = [&](const std::string& arguments, const char* why) {
    const Output o = run_program("tegotae", "plan " + arguments + to);
    INFO(arguments << "\n" << o.err);
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK_THAT(o.err, Contains(why));
  };
  refused(scene("straight") + " --goal 0.003,0,0", "at the goal the held part is in \"block\"");
  refused(scene("straight") + " --clearance 1mm", "starts nearer to \"block\"");
  refused(scene("straight") + " --clearance 5", "no length with a unit");
  refused(scene("straight") + " --goal 0,0,0 --out", "--out");
  refused(scene("straight") + " --hold nobody", "nobody");
  refused("nothing.toml", "nothing.toml");
}
