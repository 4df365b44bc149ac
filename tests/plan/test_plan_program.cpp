// `tegotae plan`: what it writes, and what it says.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

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

/// What a page has in its element "data".
std::string page_data(const std::string& page) {
  const std::size_t begin = page.find("id=\"data\"");
  REQUIRE(begin != std::string::npos);
  const std::size_t text = page.find('>', begin) + 1;
  return page.substr(text, page.find("</script>", text) - text);
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t out;
  std::memcpy(&out, bytes.data() + at, 4);
  return out;
}

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  std::uint32_t bits = 0;
  int known = 0;
  for (const char c : text) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) continue;
    bits = (bits << 6) | static_cast<std::uint32_t>(digit);
    if ((known += 6) < 8) continue;
    known -= 8;
    out += static_cast<char>((bits >> known) & 0xff);
  }
  return out;
}

/// How many poses of a review's page are in each zone.
std::map<std::uint32_t, std::size_t> zones_of_page(const std::string& page) {
  const std::string bundle = from_base64(page_data(page));
  const std::size_t arrays = 4 + word_at(bundle, 0);
  const json band = json::parse(bundle.substr(4, arrays - 4)).at("band");
  CHECK(band.at("low") == 0.05e-3);
  CHECK(band.at("high") == 0.5e-3);
  const auto at = band.at("zones").at("at").get<std::size_t>(), count = band.at("zones").at("count").get<std::size_t>();
  std::map<std::uint32_t, std::size_t> out;
  for (std::size_t i = 0; i < count; ++i) ++out[word_at(bundle, arrays + 4 * (at + i))];
  return out;
}

json glb_json(const std::string& path) {
  const std::string bytes = read_text(path);
  REQUIRE(bytes.size() > 20);
  return json::parse(bytes.substr(20, word_at(bytes, 12)));
}

/// The numbers of a buffer view.
std::vector<float> glb_floats(const std::string& path, const json& view_number) {
  const std::string bytes = read_text(path);
  const json view = glb_json(path).at("bufferViews").at(view_number.get<std::size_t>());
  std::vector<float> out(view.at("byteLength").get<std::size_t>() / 4);
  const std::size_t begin = 28 + word_at(bytes, 12) + view.at("byteOffset").get<std::size_t>();
  REQUIRE(begin + 4 * out.size() <= bytes.size());
  std::memcpy(out.data(), bytes.data() + begin, 4 * out.size());
  return out;
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

TEST_CASE("the review of a planned way, and of a run along it, says what the plan said") {
  const TempFolder folder;
  // The hand of the run stays behind the end of the way a little, and that is no farther out than it has to be.
  for (const char* name : {"straight", "bent-bar"}) {
    CAPTURE(name);
    const std::string to = folder / name, run = to + "/run.mcap";
    REQUIRE(run_program("tegotae", "plan " + scene(name) + " --seed 1 --to " + to).code == 0);
    REQUIRE(
        run_program("tegotae", "run " + scene(name) + " --fast --script " + to + "/script.csv --record " + run).code ==
        0);
    for (const std::string& recording : {to + "/recording.csv", run}) {
      const Output o = run_program("tegotae", "review " + recording);
      INFO(recording << "\n" << o.out << o.err);
      CHECK(o.code == 0);
      CHECK(o.out.rfind("It comes out\n", 0) == 0);
    }
  }
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
  CHECK_THAT(read_text(to + "/order.dot"),
             Contains("digraph") && Contains("\"key\" [label=\"1. key\"]") && Contains("\"lock\" [label=\"lock\"]"));
  CHECK_THAT(read_text(to + "/order.html"), Contains("Order of disassembly"));
  CHECK(read_text(to + "/step-01.glb").substr(0, 4) == "glTF");
  CHECK(read_text(to + "/step-01.csv").substr(0, 5) == "t,px,");
  const Output stays =
      run_program("tegotae", "plan " + scene("locked-in") + " --all --iterations 30 --to " + (folder / "in"));
  CHECK(stays.code == 1);
  CHECK_THAT(stays.out, Contains("Did not come apart: key, lock") && Contains("key was stopped by lock"));
  // The cross is tried first, and in vain; once the cage is off it, nothing is in its way.
  const Output burr = run_program("tegotae", "plan " + scene("burr") + " --all --to " + (folder / "burr"));
  CHECK(burr.code == 0);
  CHECK_THAT(burr.out, Contains("1. cage: ") && Contains("\nLeft: cross\n") && !Contains("stopped by"));
  CHECK_THAT(read_text(folder / "burr" + "/order.dot"), Contains("\"cross\" -> \"cage\""));
  // The graph: two parts, and who stops whom.
  const std::string page = read_text(folder / "in" + "/order.html");
  const json report = json::parse(page_data(page));
  const json graph = report.at("sections").back().at("graph");
  CHECK(graph.at("nodes").size() == 2);
  CHECK(graph.at("nodes").at(0).at("text") == "key");
  // Each of two that do not come apart stops the other.
  const std::set<json> arrows(graph.at("arrows").begin(), graph.at("arrows").end());
  CHECK(arrows == std::set<json>{json::parse("[0, 1]"), json::parse("[1, 0]")});
}

TEST_CASE("a plan with a band tells and shows where its path is to it") {
  const TempFolder folder;
  const std::string to = folder / "out";
  // In its hole the peg has 0.1 mm on each side, and outside of it more.
  const Output o = run_program("tegotae", "plan " + scene("straight") + " --seed 1 --band 0.05mm 0.5mm --to " + to);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK_THAT(o.out, Contains("clearance of 50 µm to 0.5 mm: below 0.00 s and 0.00 mm, inside "));
  const json band = json::parse(read_text(to + "/plan.json")).at("band");
  CHECK(band.at("low_m") == 0.05e-3);
  CHECK(band.at("high_m") == 0.5e-3);
  CHECK(band.at("below").at("way_m") == 0);
  CHECK(band.at("inside").at("way_m").get<double>() > 0.01);
  CHECK(band.at("above").at("way_m").get<double>() > 0);
  // The column, by the clearance beside it.
  std::istringstream csv(read_text(to + "/path.csv"));
  std::string line;
  std::getline(csv, line);
  CHECK(line == "t,px,py,pz,qw,qx,qy,qz,clearance,part,force,torque,band");
  std::size_t inside = 0, above = 0;
  while (std::getline(csv, line)) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    REQUIRE(cells.size() == 13);
    const bool wide = std::stod(cells[8]) > 0.5e-3;
    CHECK(cells[12] == (wide ? "above" : "inside"));
    ++(wide ? above : inside);
  }
  CHECK(inside > 10);
  CHECK(above > 1);
  // The page has the same zones.
  CHECK(zones_of_page(read_text(to + "/review.html")) == std::map<std::uint32_t, std::size_t>{{1, inside}, {2, above}});
  // Red below, yellow inside, blue above: two ends of a line for each row but the last.
  const json gltf = glb_json(to + "/path.glb");
  const json& lines = gltf.at("meshes").back().at("primitives").at(0);
  CHECK(lines.at("mode") == 1);
  const json& colors = gltf.at("accessors").at(lines.at("attributes").at("COLOR_0").get<std::size_t>());
  CHECK(colors.at("count") == 2 * (inside + above - 1));
  CHECK(gltf.at("nodes").back().at("name") == "clearance");
  const std::vector<float> rgb = glb_floats(to + "/path.glb", colors.at("bufferView"));
  CHECK(rgb[2] < rgb[0]);                   // it begins in its hole
  CHECK(rgb.back() > rgb[rgb.size() - 3]);  // and ends outside

  const Output none = run_program("tegotae", "plan " + scene("straight") + " --seed 2 --to " + to);
  CHECK(none.code == 0);
  CHECK(!std::filesystem::exists(to + "/review.html"));  // the one that was there is about another path
  CHECK(glb_json(to + "/path.glb").at("meshes").size() == 2);
  // An order of two steps was there, and something else.
  std::filesystem::create_directories(folder / "all");
  for (const char* file : {"step-01.csv", "step-02.csv", "step-02.glb", "step-2.csv"})
    folder.write(std::string("all/") + file, "old\n");
  const Output all =
      run_program("tegotae", "plan " + scene("straight") + " --all --band 0.05mm 0.5mm --to " + (folder / "all"));
  CHECK(all.code == 0);
  CHECK_THAT(read_text(folder / "all/step-01.csv"), Contains(",band\n") && Contains(",inside\n"));
  CHECK(glb_json(folder / "all/step-01.glb").at("nodes").back().at("name") == "clearance");
  CHECK(!std::filesystem::exists(folder / "all/step-02.csv"));
  CHECK(!std::filesystem::exists(folder / "all/step-02.glb"));
  CHECK(read_text(folder / "all/step-2.csv") == "old\n");
}

TEST_CASE("a time limit ends the whole plan, also where a way was found") {
  const TempFolder folder;
  // To shorten and widen the way of a screw takes several times as long.
  const Output o = run_program("tegotae", "plan " + scene("screw") + " --seconds 1 --json --to " + (folder / "out"));
  INFO(o.out << o.err);
  const json plan = json::parse(o.out);
  CHECK(plan.at("out_of_time") == true);
  CHECK(plan.at("interrupted") == false);
  CHECK(o.code == (plan.at("found") == true ? 0 : 1));
  const Output whole = run_program("tegotae", "plan " + scene("straight") + " --json --to " + (folder / "out"));
  CHECK(json::parse(whole.out).at("out_of_time") == false);
}

TEST_CASE("an order of disassembly neither replaces nor removes what it reads") {
  const TempFolder folder;
  const std::string first = folder / "first";
  REQUIRE(run_program("tegotae", "plan " + scene("straight") + " --seed 1 --to " + first).code == 0);
  // An order of two parts writes one step, and removes those that an earlier one had more.
  for (const char* name : {"step-01.glb", "step-02.glb"}) {
    CAPTURE(name);
    const std::string to = folder / ("of " + std::string(name)), mesh = to + "/" + name;
    std::filesystem::create_directories(to);
    std::filesystem::copy_file(first + "/path.glb", mesh);
    folder.write("assembly.toml", "[[part]]\nname = \"a\"\nmesh = \"of " + std::string(name) + "/" + name +
                                      "\"\n[[part]]\nname = \"b\"\nmesh = \"first/path.glb\"\n"
                                      "position = [1, 0, 0]\n");
    const std::string before = read_text(mesh);
    const Output o = run_program("tegotae", "plan " + (folder / "assembly.toml") + " --all --to '" + to + "'");
    INFO(o.out << o.err);
    CHECK(o.code == 2);
    CHECK_THAT(o.err, Contains(name) && Contains("would be replaced, but is read by the same command"));
    REQUIRE(std::filesystem::exists(mesh));
    CHECK(read_text(mesh) == before);
    CHECK(!std::filesystem::exists(to + "/order.csv"));
  }
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
  refused(scene("straight") + " --clearance 5", "not a length with a unit");
  refused(scene("straight") + " --goal 0,0,0 --out", "--out");
  refused(scene("straight") + " --hold nobody", "nobody");
  refused(scene("straight") + " --seed -1", "--seed: -1 is not a whole number of at least 0");
  refused("nothing.toml", "nothing.toml");
}
