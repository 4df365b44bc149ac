// `tegotae study` and the goal "out", by the program: answers that are known by construction, tables that do not belong
// together, and cases that are made again.
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "recording.hpp"
#include "study_scene.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "text.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;
using nlohmann::json;

namespace {

json summary_in(const std::string& folder) {
  return json::parse(read_text(folder + "/summary.json"));
}

}  // namespace

TEST_CASE("a peg that is larger than its hole never goes in, a loose one always") {
  const TempFolder folder;
  REQUIRE(run_program("peg_in_hole", "--ratio 0.94 --fast --scene-out " + folder / "m").code == 0);
  // The hole's radius is 10 mm, the peg's 9.4 mm and less by `by`.
  folder.write(
      "study.toml",
      "scenes = [\"m/peg_in_hole_0.94.toml\"]\nseconds = 4\nrepeats = 2\n[parameters]\noperator = [\"hasty\"]\n"
      "[[parameters.inward]]\npart = \"peg\"\nby = [-7e-4, -2e-4, 1e-4]\n");
  const std::string file = folder / "study.toml", out = folder / "study";
  run_study(file + " --jobs 2");
  run_study("merge " + file);
  const json by = summary_in(out).at("by_inward peg");
  CHECK(by.at("-7e-04").at("reached") == 0);
  CHECK(by.at("-7e-04").at("cases") == 2);
  CHECK(by.at("-2e-04").at("reached") == 2);
  CHECK(by.at("1e-04").at("reached") == 2);
  CHECK(summary_in(out).at("blocked_by") == json::object({{"hole", 2}}));
  CHECK_THAT(read_text(out + "/cases.csv"), Contains("\"blocked by hole at ("));
  CHECK_THAT(read_text(out + "/report.html"),
             Contains("\"tegotae\",\"study\",\"case\",\"../study.toml\",\"2\",\"--out\",\".\""));
  CHECK_THAT(read_text(out + "/report.html"), Contains("case-2/replay.html"));

  // The written case has the peg's size, and its recording a verdict in the review.
  const Output again = run_study("case " + file + " 2 --to " + folder / "c");
  CHECK_THAT(again.out, Contains("case 2: reached the goal"));
  for (const Part& part : load_scene(folder / "c/scene.toml").scene.parts) {
    double x = 0;
    for (const Vec3& v : part.mesh->vertices) x = std::max(x, v.x());
    if (part.held) CHECK(x == Approx(9.3e-3).margin(2e-6));
  }
  const Output review = run_program("tegotae", "review " + folder / "c/recording.mcap");
  INFO(review.out << review.err);
  CHECK(review.code == 0);
  CHECK_THAT(review.out, Contains("It goes in"));
  CHECK_THAT(read_text(folder / "c/replay.html"), Contains("</html>"));
  // Where the report's links lead, of several at once.
  run_study("case " + file + " 0 2");
  CHECK_THAT(read_text(out + "/case-0/replay.html"), Contains("</html>"));
  CHECK_THAT(read_text(out + "/case-2/replay.html"), Contains("</html>"));
  const Output none = run_study("case " + file + " 2 999", 2);
  CHECK_THAT(none.err, Contains("has no case 999; its cases are 0 to "));
  const Output fails = run_study("case " + file + " 0 --to " + folder / "d");
  CHECK_THAT(fails.out, Contains("case 0: FAILED: blocked by hole at ("));
  CHECK_THAT(run_program("tegotae", "review " + folder / "d/recording.mcap").out, Contains("It does not go in"));
}

TEST_CASE("out of a niche is where it is open, and the review of it has a verdict") {
  const TempFolder folder;
  write_niche(folder);
  const std::string scene = folder / "niche.toml", out = folder / "t";
  const Output o = run_program("tegotae", "try " + scene + " --goal out --tries 3 --seconds 8 --out " + out);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  const json summary = summary_in(out);
  CHECK(summary.at("by_route").size() == 1);
  CHECK(summary.at("by_route").at("along y").at("reached") == 3);
  // Out: beside the box around the others, whose face is at y = 5 mm, so the center is beyond 10 mm, and by as much
  // again as the cube is large from corner to corner, 17.3 mm.
  CHECK(summary.at("goal").at(1).get<double>() > 0.0273);
  CHECK(summary.at("goal").at(0).get<double>() == Approx(0).margin(1e-12));
  const FclOracle oracle(load_scene(scene).scene);
  const std::vector<RecordedRow> rows = read_recording(out + "/best.csv");
  for (const RecordedRow& row : rows) REQUIRE(oracle.intersecting(row.x).empty());
  CHECK(rows.back().x.p.y() > 0.010);
  const Output review = run_program("tegotae", "review " + out + "/best.csv");
  INFO(review.out << review.err);
  CHECK(review.code == 0);
  CHECK_THAT(review.out, Contains("It comes out"));
}

TEST_CASE("a part with no way out fails, and who is in the way is told in the words of the review") {
  const TempFolder folder;
  write_niche(folder);
  std::string text = read_text(folder / "niche.toml");
  text += "[[part]]\nname = \"front\"\nmesh = \"cube.obj\"\nposition = [0, 0.0101, 0]\n";
  folder.write("closed.toml", text);
  const Output o =
      run_program("tegotae", "try " + folder / "closed.toml --goal out --tries 1 --seconds 2 --out " + folder / "t");
  CHECK(o.code == 1);
  CHECK_THAT(o.out, Contains("FAILED: blocked by "));
  const Output review = run_program("tegotae", "review " + folder / "t/best.csv");
  CHECK(review.code == 1);
  CHECK_THAT(review.out, Contains("It does not come out: blocked by ") || Contains("It does not go in: blocked by "));
  const Output already = run_program("tegotae", "try " + folder / "scene.toml --goal out --out " + folder / "u");
  CHECK(already.code == 2);
  CHECK_THAT(already.err, Contains("block is out of all other parts where it starts"));
}

TEST_CASE("an order that takes the lid first goes, the other way round does not") {
  const TempFolder folder;
  write_niche(folder);
  std::string text = read_text(folder / "niche.toml");
  text += "[[part]]\nname = \"front\"\nmesh = \"cube.obj\"\nposition = [0, 0.0101, 0]\n";
  folder.write("closed.toml", replaced(text, "held = true\n", ""));
  folder.write(
      "study.toml",
      "scenes = [\"closed.toml\"]\ngoal = \"out\"\nseconds = 8\n[parameters]\noperator = [\"hasty\"]\n"
      "[[parameters.order]]\nparts = [\"front\", \"block\"]\n[[parameters.order]]\nparts = [\"block\", \"front\"]\n");
  run_study(folder / "study.toml");
  run_study("merge " + folder / "study.toml");
  const json by = summary_in(folder / "study").at("by_order");
  CHECK(by.at("front, block").at("reached") == 1);
  CHECK(by.at("block, front").at("reached") == 0);
}

TEST_CASE("parts of a study that do not belong together are refused, with file and line") {
  const TempFolder folder;
  write_blocks(folder);
  const std::string text = "scenes = [\"scene.toml\"]\ngoal = \"0,0,0.0195\"\nseconds = 0.8\nrepeats = 6\n";
  folder.write("study.toml", text);
  const std::string file = folder / "study.toml", out = folder / "study";
  run_study(file + " --shard 1/2");
  CHECK_THAT(run_study("merge " + file, 1).err, Contains("3 of 6 cases are missing: 1, 3, 5"));
  CHECK_FALSE(std::filesystem::exists(out + "/cases.csv"));
  run_study(file + " --shard 2/2");
  run_study("merge " + file);
  const std::string table = read_text(out + "/cases.csv"), report = read_text(out + "/report.html");
  // However it is cut, and more than once.
  run_study(file + " --shard 2/3");
  run_study("merge " + file);
  CHECK(read_text(out + "/cases.csv") == table);
  std::filesystem::remove_all(out);
  for (const char* shard : {"4/4", "2/4", "3/4", "1/4"}) run_study(file + " --shard " + std::string(shard));
  run_study("merge " + file);
  CHECK(read_text(out + "/cases.csv") == table);
  CHECK(read_text(out + "/report.html") == report);

  const auto refused = [&](const std::string& why) {
    const Output o = run_study("merge " + file, 2);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK_THAT(o.err, Contains(why));
  };
  for (const std::string& other : {replaced(text, "0.8", "0.9"), replaced(text, "0.0195", "0.0194"),
                                   text + "seed = 2\n", text + "[parameters]\nmu = [0]\n"}) {
    folder.write("study.toml", other);
    refused("shards/1-of-4.csv:1: holds cases of another");
    run_study(file + " --shard 1/4", 2);
  }
  // The number of repeats and comments change no case.
  folder.write("study.toml", "# again\n" + replaced(text, "repeats = 6", "repeats = 5"));
  run_study("merge " + file);
  CHECK(std::count(table.begin(), table.end(), '\n') == 8);
  folder.write("study.toml", text);
  const std::string shard = out + "/shards/1-of-4.csv", rows = read_text(shard);
  folder.write("study/shards/1-of-4.csv", rows.substr(0, rows.size() - 3));
  refused("1-of-4.csv:4: is not a case; delete the line");
  // Cut off before that it tells nothing of what study it is.
  for (const std::size_t size : {std::size_t{0}, std::size_t{9}}) {
    folder.write("study/shards/1-of-4.csv", rows.substr(0, size));
    refused("1-of-4.csv:1: ends before its first case; delete the file");
  }
  folder.write("study/shards/1-of-4.csv", rows.substr(0, rows.find('\n') + 9));
  refused("1-of-4.csv:2: ends before its first case; delete the file");
  folder.write("study/shards/1-of-4.csv", rows);
  folder.write("study/shards/1-of-9.csv", replaced(rows, "careful", "Careful"));
  refused("has another result in ");
  folder.write("study/shards/1-of-9.csv", replaced(rows, "scene.toml", "other.toml"));
  refused("1-of-9.csv: case 0 has other parameters than the study gives it");
  std::filesystem::remove(out + "/shards/1-of-9.csv");
  std::string changed = read_text(folder / "scene.toml");
  folder.write("scene.toml", replaced(changed, "0.02]", "0.0201]"));
  refused("shards/1-of-4.csv:1: holds cases of another");
}

TEST_CASE("bad commands of study are one line") {
  const TempFolder folder;
  write_blocks(folder);
  folder.write("study.toml", "scenes = [\"scene.toml\"]\ngoal = \"0,0,0.0195\"\nseconds = 0.2\n");
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const Output o = run_study(arguments, 2);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK_THAT(o.err, Contains(why));
  };
  const std::string file = folder / "study.toml";
  refused("", "name a study file");
  refused(file + " --shard 0/4", "is not I/N");
  refused(file + " --shard 5/4", "is not I/N");
  refused(file + " --shard 1/4x", "is not I/N");
  refused("case " + file + " 1", "has no case 1; its cases are 0 to 0");
  folder.write("study.toml", "scenes = [\"scene.toml\"]\n");
  refused(file, "its script does not move; give the part's goal with goal in ");
  folder.write("study.toml",
               "scenes = [\"scene.toml\"]\ngoal = \"out\"\n[[parameters.inward]]\npart = \"lid\"\nby = [0]\n");
  refused(file, "has no part lid, which the study names (there are floor, block)");
  // A cube of 10 mm; whatever a case would draw.
  for (const char* by : {"[1e-6, 1e-3]", "[-1e-3]", "{ uniform = [0, 1e-3] }"}) {
    folder.write("study.toml",
                 "scenes = [\"scene.toml\"]\ngoal = \"out\"\n[[parameters.inward]]\npart = \"block\"\nby = " +
                     std::string(by) + "\n");
    refused(file, "scene.toml: the faces of block cannot go inward by 1 mm: it is only 17.3 mm large");
  }
  folder.write("study.toml",
               "scenes = [\"scene.toml\"]\ngoal = \"out\"\n[[parameters.order]]\nparts = [\"block\", \"floor\"]\n");
  refused(file, "scene.toml: has no other parts than an order of the study takes out");
  const Output seed = run_program("tegotae", "try " + (folder / "scene.toml") + " --seed -1");
  CHECK(seed.code == 2);
  CHECK_THAT(seed.err, Contains("--seed: -1 is not a whole number of at least 0"));
  // Without HyperShell.
  folder.write("study.toml", "scenes = [\"scene.toml\"]\ngoal = \"out\"\n");
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);
  const Output o = run_program("tegotae", "study run " + file);
  ::setenv("PATH", path.c_str(), 1);
  CHECK(o.code == 2);
  CHECK_THAT(o.err, Contains("pip install hypershell") && Contains("tegotae study " + file));
}

TEST_CASE("a case that is made again replaces nothing that its study reads") {
  const TempFolder folder;
  write_blocks(folder);
  folder.write(
      "part-2.ply",
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 12\nproperty list uchar int vertex_indices\nend_header\n"
      "-5 -5 -5\n5 -5 -5\n5 5 -5\n-5 5 -5\n-5 -5 5\n5 -5 5\n5 5 5\n-5 5 5\n3 0 3 2\n3 0 2 1\n3 4 5 6\n3 4 6 7\n"
      "3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n");
  // The changed part's mesh has the name that a case gives it, and so has one of the two studies that of its scene.
  folder.write("blocks.toml", replaced(read_text(folder / "scene.toml"), "name = \"block\"\nmesh = \"cube.obj\"",
                                       "name = \"block\"\nmesh = \"part-2.ply\""));
  const std::string study = "scenes = [\"blocks.toml\"]\ngoal = \"0,0,0.0195\"\nseconds = 0.2\n";
  folder.write("changed.toml", study + "[[parameters.inward]]\npart = \"block\"\nby = [1e-6]\n");
  folder.write("scene.toml", study);
  for (const auto& [file, name] : {std::pair("changed.toml", "part-2.ply"), std::pair("scene.toml", "scene.toml")}) {
    CAPTURE(file);
    const std::string before = read_text(folder / name);
    const Output o = run_study("case " + (folder / file) + " 0 --to " + (folder / "."), 2);
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK_THAT(o.err, Contains(name) && Contains("would be replaced, but is read by the same command"));
    CHECK(read_text(folder / name) == before);
    CHECK(!std::filesystem::exists(folder / "recording.mcap"));
    if (name != std::string(file)) folder.write("scene.toml", study);  // what the first one may have written
  }
}
