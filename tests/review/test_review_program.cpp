// `tegotae review` as a user runs it: verdict, report, exports, bad input.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "absent.hpp"
#include "catch.hpp"
#include "recording.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

const char* const kCube =
    "v -5 -5 -5\nv 5 -5 -5\nv 5 5 -5\nv -5 5 -5\nv -5 -5 5\nv 5 -5 5\nv 5 5 5\nv -5 5 5\n"
    "f 1 4 3\nf 1 3 2\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

/// A block 3 mm over a floor cube; the hand takes it to (x, z) mm, with a turn, in 0.4 s.
void write_cubes(const TempFolder& folder, double x, double z) {
  folder.write("cube.obj", kCube);
  char end[96];
  std::snprintf(end, sizeof end, "0.4,%g,0,%g,0.995,0,0,0.0998749\n", 1e-3 * x, 1e-3 * z);
  folder.write("path.csv", std::string("t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.013,1,0,0,0\n") + end);
  folder.write("scene.toml",
               "unit = \"mm\"\n[[part]]\nname = \"floor, \\\"the\\\"\"\nmesh = \"cube.obj\"\n"
               "[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\nposition = [0, 0, 0.013]\n"
               "[device]\nscript = \"path.csv\"\n");
}

std::string record(const TempFolder& folder, const std::string& name, int code = 0) {
  const Output o = run_program("tegotae", "run --fast --record " + folder / name + " " + folder / "scene.toml");
  INFO(o.err);
  REQUIRE(o.code == code);
  return folder / name;
}

std::string without_last_line(const std::string& text) {
  return text.substr(0, text.rfind('\n', text.size() - 2));
}

std::vector<std::vector<std::string>> csv_rows(const std::string& path) {
  std::istringstream in(read_text(path));
  std::string line, cell;
  std::vector<std::vector<std::string>> out;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    out.emplace_back();
    while (std::getline(cells, cell, ',')) out.back().push_back(cell);
  }
  return out;
}

Pose pose_of(const aiNodeAnim& channel, unsigned i) {
  const aiVector3D p = channel.mPositionKeys[i].mValue;
  const aiQuaternion q = channel.mRotationKeys[i].mValue;
  return {Quat(q.w, q.x, q.y, q.z), Vec3(p.x, p.y, p.z)};
}

/// The glTF read by assimp against the recording.
void check_gltf(const std::string& path, const std::vector<RecordedRow>& rows) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_ValidateDataStructure);
  INFO(importer.GetErrorString());
  REQUIRE(scene);
  REQUIRE(scene->mNumMeshes == 2);
  for (unsigned i = 0; i < 2; ++i) CHECK(scene->mMeshes[i]->mNumFaces == 12);
  const aiNode* block = scene->mRootNode->FindNode("block");
  REQUIRE(block);
  // z is up in the scene, y in the file: what is 13 mm high in one is so in the other.
  const aiMatrix4x4 up = block->mParent->mTransformation;
  const aiVector3D high = up * aiVector3D(0, 0, 0.013f);
  CHECK(high.y == Approx(0.013));
  CHECK(std::abs(high.z) < 1e-8);
  REQUIRE(scene->mNumAnimations == 1);
  const aiAnimation& animation = *scene->mAnimations[0];
  REQUIRE(animation.mNumChannels == 1);
  const aiNodeAnim& channel = *animation.mChannels[0];
  CHECK(std::string(channel.mNodeName.C_Str()) == "block");
  REQUIRE(channel.mNumPositionKeys == channel.mNumRotationKeys);
  const double second = animation.mTicksPerSecond;
  CHECK(animation.mDuration / second == Approx(rows.back().t).epsilon(1e-5));
  std::size_t row = 0;
  for (unsigned k = 0; k < channel.mNumPositionKeys; ++k) {
    const double t = channel.mPositionKeys[k].mTime / second;
    while (row + 1 < rows.size() && rows[row + 1].t < t + 5e-4) ++row;
    const Pose X = pose_of(channel, k);
    REQUIRE((X.p - rows[row].x.p).norm() < 1e-8);
    REQUIRE(X.q.angularDistance(rows[row].x.q) < 1e-3);  // of single precision, near 1
  }
  CHECK(channel.mNumPositionKeys > 800);
}

}  // namespace

TEST_CASE("a block that goes to its goal: verdict, report, exports") {
  const TempFolder folder;
  write_cubes(folder, 4, 16);
  const std::string csv = record(folder, "r.csv"), mcap = record(folder, "m.mcap");
  const Output o = run_program("tegotae", "review " + csv + " --csv " + folder / "path_out.csv" + " --gltf " +
                                              folder / "p.gltf" + " --script " + folder / "s.csv");
  INFO(o.err);
  REQUIRE(o.code == 0);
  CHECK(o.err.empty());
  CHECK_THAT(o.out, Contains("It gets to its goal; it was out of the other parts where it began\n"));
  CHECK_THAT(o.out, Contains("No pose intersects another part"));
  CHECK_THAT(o.out, Contains("Nothing was touched."));

  const std::string report = read_text(folder / "r.review.html");
  CHECK(report.find("<script src") == std::string::npos);  // all is inside
  CHECK(report.size() > 500'000);
  CHECK(report.size() < 3'000'000);

  {  // MCAP says the same as CSV
    const Output m = run_program("tegotae", "review " + mcap + " --gltf " + folder / "m.glb");
    CHECK(m.code == 0);
    CHECK(without_last_line(m.out) == without_last_line(o.out));
    check_gltf(folder / "m.glb", read_recording(csv));
  }
  {  // the path in CSV
    const auto out = csv_rows(folder / "path_out.csv");
    const std::vector<RecordedRow> rows = read_recording(csv);
    REQUIRE(out.size() == rows.size() + 1);
    CHECK(out[0][8] == "clearance");
    for (std::size_t i = 0; i < rows.size(); i += 50) {
      const Pose& X = rows[i].x;
      CHECK(std::stod(out[i + 1][0]) == rows[i].t);
      CHECK(std::stod(out[i + 1][3]) == X.p.z());
      // Cubes one over the other, the upper one turned about z: their faces are apart by the height.
      CHECK(std::stod(out[i + 1][8]) == Approx(X.p.z() - 0.01).epsilon(1e-9));
      CHECK(out[i + 1][9] == "\"floor");  // quoted: the name has a comma and quotes in it
    }
  }
  {  // glTF
    check_gltf(folder / "p.gltf", read_recording(csv));
  }
  {  // the script goes the same way
    const Output again = run_program("tegotae", "run --fast --json --script " + folder / "s.csv" + " --record " +
                                                    folder / "again.csv " + folder / "scene.toml");
    REQUIRE(again.code == 0);
    const std::vector<RecordedRow> a = read_recording(csv), b = read_recording(folder / "again.csv");
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i].x.p - b[i].x.p).norm());
    CHECK(most < 3e-4);
    CHECK((a.back().x.p - b.back().x.p).norm() < 1e-4);
  }
}

TEST_CASE("a block that presses on the floor does not go, and the script presses alike") {
  const TempFolder folder;
  write_cubes(folder, 1, 6);
  const std::string csv = record(folder, "r.csv", 1);
  const Output o = run_program("tegotae", "review " + csv + " --script " + folder / "s.csv --out " + folder / "x.html");
  CHECK(o.code == 1);
  CHECK_THAT(o.out, Contains("It does not go in: blocked by floor, \"the\" at ("));
  CHECK_THAT(o.out, Contains("Stalled once"));
  CHECK_THAT(o.out, Contains("report: " + folder / "x.html"));
  const Output again = run_program(
      "tegotae", "run --fast --script " + folder / "s.csv --record " + folder / "again.csv " + folder / "scene.toml");
  const Output o2 = run_program("tegotae", "review " + folder / "again.csv");
  CHECK(o2.code == 1);
  CHECK_THAT(o2.out, Contains("It does not go in: blocked by floor, \"the\" at ("));
  const auto force = [](const std::string& text) { return std::stod(text.substr(text.find("At most ") + 8)); };
  CHECK(force(o2.out) == Approx(force(o.out)).epsilon(0.2));  // the hand's mass is not in it
  // To another goal, where it came by.
  CHECK(run_program("tegotae", "review " + csv + " --goal 0.0005,0,0.0102,0.995,0,0,0.09987").code == 0);
}

TEST_CASE("a block that starts pressed between two comes out, relieved of them until it is apart") {
  const TempFolder folder;
  folder.write("cube.obj", kCube);
  folder.write("path.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0.02,0,1,0,0,0\n");
  // Each 3 um too near.
  folder.write("scene.toml",
               "unit = \"mm\"\n[[part]]\nname = \"left\"\nmesh = \"cube.obj\"\nposition = [-0.009997, 0, 0]\n"
               "[[part]]\nname = \"right\"\nmesh = \"cube.obj\"\nposition = [0.009997, 0, 0]\n"
               "[[part]]\nname = \"block\"\nmesh = \"cube.obj\"\nheld = true\n[device]\nscript = \"path.csv\"\n");
  const std::string csv = record(folder, "r.csv");
  const Output o = run_program("tegotae", "review " + csv);
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  CHECK_THAT(o.out, Contains("It comes out\n"));
  CHECK_THAT(o.out, Contains("No pose intersects another part that was free of it"));
  for (const std::string name : {"left", "right"}) {
    // Until it has gone by its own 10 mm, after half a second.
    const auto at = o.out.find("Touching at the start: " + name + "; until 0.5");
    REQUIRE(at != std::string::npos);
    const std::string words = "contact is felt 4.30 um inside its surface";
    CHECK(o.out.find(words + "; no pose reached deeper.", at) < o.out.find('\n', at));
    // The run says it in the same words.
    const Output run = run_program("tegotae", "run --fast " + folder / "scene.toml");
    CHECK_THAT(run.err, Contains(name + ", depth 3.00 um; until they have come free, " + words));
  }
}

TEST_CASE("a shaft that is pulled by 2 mm and is still in its bushing has not come out") {
  const TempFolder folder;
  // A shaft of 60 mm between four walls 15 mm long, 20 um from each, on a plate that is wider than all.
  const auto box = [&](const std::string& name, double x, double y, double z) {
    std::string text;
    for (int i = 0; i < 8; ++i)
      text += "v " + std::to_string(i & 1 ? x : -x) + " " + std::to_string(i & 2 ? y : -y) + " " +
              std::to_string(i & 4 ? z : -z) + "\n";
    folder.write(name, text +
                           "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\n"
                           "f 3 5 7\nf 2 4 6\nf 4 8 6\n");
  };
  box("shaft.obj", 5, 5, 30);
  box("wall.obj", 5, 15, 7.5);
  box("plate.obj", 50, 50, 2);
  std::string scene = "unit = \"mm\"\n[[part]]\nname = \"plate\"\nmesh = \"plate.obj\"\nposition = [0, 0, -0.04]\n";
  for (const double side : {-1.0, 1.0})
    scene += std::string("[[part]]\nname = \"") + (side < 0 ? "left" : "right") +
             "\"\nmesh = \"wall.obj\"\nposition = [" + std::to_string(side * 0.01002) + ", 0, 0]\n";
  scene += "[[part]]\nname = \"Welle\"\nmesh = \"shaft.obj\"\nheld = true\n[device]\nscript = \"path.csv\"\n";
  folder.write("scene.toml", scene);
  const auto pulled = [&](const char* end) {
    folder.write("path.csv", std::string("t,px,py,pz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.5,") + end + ",1,0,0,0\n");
    return run_program("tegotae", "review --json " + record(folder, "r.csv"));
  };
  const Output little = pulled("0,0,0.002");
  INFO(little.out << little.err);
  CHECK(little.code == 0);
  const auto said = nlohmann::json::parse(little.out);
  CHECK(said.at("outcome") == "goes");
  const std::string headline = said.at("headline");
  const double depth = std::stod(headline.substr(std::string("It gets to its goal, ").size()));
  CHECK(depth == Approx(2).margin(0.1));  // where friction and resolution leave the pen
  CHECK_THAT(headline, Catch::EndsWith(" mm on the way out; still inside left and right"));
  // Past the walls; the plate is below it.
  CHECK_THAT(pulled("0,0,0.05").out, Contains("\"It comes out\""));
}

TEST_CASE("the review of a run says what the run said, also of another script") {
  const TempFolder folder;
  write_cubes(folder, 1, 6);
  const auto agree = [&](const std::string& options, const char* outcome) {
    const std::string csv = folder / "s.csv";
    const Output run =
        run_program("tegotae", "run --fast " + options + " --record " + csv + " " + folder / "scene.toml");
    const Output review = run_program("tegotae", "review --json " + csv);
    INFO(options << "\n" << run.out << run.err << review.out << review.err);
    CHECK(run.code == review.code);
    const auto said = nlohmann::json::parse(review.out);
    CHECK(said.at("outcome") == outcome);
    const auto failed = run.out.find("FAILED: ");
    CHECK((failed != std::string::npos) == (run.code == 1));
    if (failed == std::string::npos) return;
    const std::string why = run.out.substr(failed + 8, run.out.find('\n', failed) - failed - 8);
    CHECK_THAT(said.at("headline").get<std::string>(), Catch::EndsWith(": " + why));
  };
  const auto script = [&](const std::string& rows) {
    folder.write("other.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.013,1,0,0,0\n" + rows);
    return "--script " + folder / "other.csv";
  };
  agree("", "does not go");
  agree("--seconds 0.1", "open");
  agree(script("0.4,0,0,0.02,1,0,0,0\n"), "goes");
  agree(script("0.4,0,0,0.006,1,0,0,0\n"), "does not go");
  agree(script("0.4,0.005,0,0.004,1,0,0,0\n"), "does not go");
  agree(script("0.4,0,0,0.02,1,0,0,0\n0.8,0,0,0.013,1,0,0,0\n"), "open");  // back where it began
  agree(script("0.4,0,0,0.02,1,0,0,0\n0.41,0,0.02,0.02,1,0,0,0\n"), "goes");
  agree(script("0.4,0,0,0.006,1,0,0,0\n0.8,0,0,0.0106,1,0,0,0\n"), "goes");  // presses, and comes back to its goal
  agree(script("0.4,0,0,0.0106,1,0,0,0\n0.8,0,0,0.004,1,0,0,0\n"), "does not go");  // comes by, and goes on
  agree(script("0.4,0,0,0.02,1,0,0,0\n") + " --seconds 0.2", "open");
}

TEST_CASE("what is not a recording, or not of this scene, is one line") {
  const TempFolder folder;
  write_cubes(folder, 4, 16);
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const Output o = run_program("tegotae", "review " + arguments);
    INFO(arguments << ": " << o.err);
    CHECK(o.code == 2);
    CHECK(o.out.empty());
    CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
    CHECK_THAT(o.err, Contains(why));
  };
  const std::string scene = " " + folder / "scene.toml";
  const std::string header =
      "tick,substep,t,y_px,y_py,y_pz,y_qw,y_qx,y_qy,y_qz,x_px,x_py,x_pz,x_qw,x_qx,x_qy,x_qz,fx,fy,fz,tx,ty,tz,contacts,"
      "gap,tick_us\n";
  const auto row = [](const char* t, const char* z) {
    const std::string pose = std::string("0,0,") + z + ",1,0,0,0,";
    return std::string("0,0,") + t + "," + pose + pose + "0,0,0,0,0,0,0,inf,0\n";
  };
  folder.write("empty.csv", header);
  folder.write("garbage.csv", "no recording\n");
  folder.write("inside.csv", header + row("0", "0.002"));
  folder.write("back.csv", header + row("0.5", "0.02") + row("0.4", "0.02"));
  folder.write("good.csv", header + row("0", "0.02") + row("0.1", "0.02"));
  refused(folder / "none.csv" + scene, "cannot read the recording");
  refused(folder / "garbage.csv" + scene, "garbage.csv:1:");
  refused(folder / "empty.csv" + scene, "has no rows");
  refused(folder / "inside.csv" + scene, "does not fit this scene");
  refused(folder / "back.csv" + scene, "row 2: its time is earlier");
  refused(folder / "good.csv", "does not name its scene");
  refused(folder / "good.csv" + scene + " --goal 1,2", "is not a pose");
  refused(folder / "good.csv" + scene + " --out " + folder / "no/such/x.html", "cannot be written");
  CHECK(run_program("tegotae", "review " + folder / "good.csv" + scene).code == 1);  // it never left the start
}

TEST_CASE("a peg in its hole, and a peg out of its tray", "[.][parts]") {
  const TempFolder folder;
  SECTION("peg in hole") {
    const Output run = run_program(
        "tegotae", "run --fast --record " + folder / "peg.csv " TEGOTAE_MODELS_DIR "/peg_in_hole_0.94.toml");
    REQUIRE(run.code == 0);
    const Output o = run_program("tegotae", "review " + folder / "peg.csv --script " + folder / "s.csv");
    CHECK(o.code == 0);
    CHECK_THAT(o.out, Contains("It goes in\n"));
    const Output again = run_program(
        "tegotae", "run --fast --json --script " + folder / "s.csv " TEGOTAE_MODELS_DIR "/peg_in_hole_0.94.toml");
    CHECK(again.code == 0);
    const auto j = nlohmann::json::parse(again.out);
    CHECK(j.at("completed") == true);
    CHECK(j.at("depth_m").get<double>() == Approx(0.06).margin(2e-4));
  }
  SECTION("tray") {
    const std::string peg = TEGOTAE_PARTS_DIR "/industreal/industreal_rectangular_peg_8mm.obj",
                      tray = TEGOTAE_PARTS_DIR "/industreal/industreal_tray_insert_rectangular_peg_8mm.obj";
    if (!std::filesystem::exists(peg)) {
      note_absent("no parts folder");
      return;
    }
    folder.write("path.csv",
                 "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.001,1,0,0,0\n0.3,0,0,0.001,1,0,0,0\n2,0,0,0.04,1,0,0,0\n");
    folder.write("scene.toml", "[[part]]\nname = \"tray\"\nmesh = \"" + tray +
                                   "\"\n[[part]]\nname = \"peg\"\nmesh = \"" + peg +
                                   "\"\nheld = true\nposition = [0, 0, 0.001]\n[device]\nscript = \"path.csv\"\n");
    record(folder, "r.csv");
    const Output o = run_program("tegotae", "review " + folder / "r.csv");
    INFO(o.out << o.err);
    CHECK(o.code == 0);
    CHECK_THAT(o.out, Contains("It comes out\n"));
    const Output tried =
        run_program("tegotae", "try " + folder / "scene.toml --tries 3 --seconds 8 --out " + folder / "t");
    INFO(tried.out << tried.err);
    CHECK(tried.code == 0);
  }
}

TEST_CASE("a band of clearances: said, in the CSV and in the report") {
  const TempFolder folder;
  write_cubes(folder, 4, 16);
  const std::string csv = record(folder, "r.csv");
  // The gap goes from 3 mm to 6 mm.
  const Output o = run_program("tegotae", "review " + csv + " --band 1mm 0.4cm --csv " + folder / "path_out.csv");
  INFO(o.err);
  REQUIRE(o.code == 0);
  CHECK_THAT(o.out, Contains("clearance of 1 mm to 4 mm: below 0.00 s and 0.00 mm, inside "));
  CHECK_THAT(o.out, Contains("inside the band from 0.000 to "));
  CHECK_THAT(o.out, Contains(" mm to floor, \"the\" at "));
  const auto rows = csv_rows(folder / "path_out.csv");
  CHECK(rows[0].back() == "band");
  int inside = 0, above = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double clearance = std::stod(rows[i][8]);
    REQUIRE(rows[i].back() == (clearance <= 0.004 ? "inside" : "above"));
    ++(clearance <= 0.004 ? inside : above);
  }
  CHECK(inside > 50);
  CHECK(above > 50);
  for (const std::string wrong : {"4mm 1mm", "1 4", "1mm", "1mm 1mm"}) {
    const Output refused = run_program("tegotae", "review " + csv + " --band " + wrong);
    INFO(wrong);
    CHECK(refused.code != 0);
    CHECK_THAT(refused.err, Contains("--band"));
  }
}
