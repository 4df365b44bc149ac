// A STEP assembly written with OpenCASCADE is imported, taken apart and put together again; the same through glTF.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "mesh/step_assembly.hpp"
#include "recording.hpp"
#include "tegotae/scene_file/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// The scene as binary glTF: a node for each part, meshes shared, positions as floats in meters.
std::string glb_of(const Scene& scene) {
  using nlohmann::json;
  json top = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  std::string bytes;
  std::map<const TriangleMesh*, std::size_t> meshes;
  const auto add = [&](const void* data, std::size_t size, json accessor) {
    top["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    accessor["bufferView"] = top["bufferViews"].size() - 1;
    top["accessors"].push_back(accessor);
    bytes.append(static_cast<const char*>(data), size);
    return top["accessors"].size() - 1;
  };
  for (const Part& part : scene.parts) {
    const TriangleMesh& mesh = *part.mesh;
    if (meshes.emplace(&mesh, meshes.size()).second) {
      Eigen::Matrix3Xf points(3, mesh.vertices.size());
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i) points.col(i) = mesh.vertices[i].cast<float>();
      const Eigen::Vector3f lo = points.rowwise().minCoeff(), hi = points.rowwise().maxCoeff();
      const std::size_t at = add(points.data(), 12 * mesh.vertices.size(),
                                 {{"componentType", 5126},
                                  {"type", "VEC3"},
                                  {"count", mesh.vertices.size()},
                                  {"min", {lo.x(), lo.y(), lo.z()}},
                                  {"max", {hi.x(), hi.y(), hi.z()}}});
      const std::size_t faces =
          add(mesh.triangles.data(), 12 * mesh.triangles.size(),
              {{"componentType", 5125}, {"type", "SCALAR"}, {"count", 3 * mesh.triangles.size()}});
      top["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", at}}}, {"indices", faces}}}}});
    }
    const Quat& q = part.pose.q;
    const Vec3& p = part.pose.p;
    top["nodes"].push_back({{"name", part.name},
                            {"mesh", meshes[&mesh]},
                            {"rotation", {q.x(), q.y(), q.z(), q.w()}},
                            {"translation", {p.x(), p.y(), p.z()}}});
  }
  json nodes = json::array();
  for (std::size_t i = 0; i < scene.parts.size(); ++i) nodes.push_back(i);
  top["scenes"] = {{{"nodes", nodes}}};
  top["buffers"] = {{{"byteLength", bytes.size()}}};
  std::string text = top.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const auto word = [](std::size_t n) {
    const auto value = static_cast<std::uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  return "glTF" + word(2) + word(28 + text.size() + bytes.size()) + word(text.size()) + "JSON" + text +
         word(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

/// Where the hand is to be, from where the held part starts: in the part's frame, whose z is the assembly's axis.
struct Waypoint {
  double t;               ///< s
  Vec3 p = Vec3::Zero();  ///< m
  double turn = 0;        ///< about z, rad
};

/// Leads `held` along `way` by `tegotae run`, back to where it started: FCL finds no recorded pose intersecting.
/// Returns the recording, poses from where the part started.
std::vector<RecordedRow> there_and_back(const TempFolder& folder, const std::string& scene, const std::string& held,
                                        const std::vector<Waypoint>& way) {
  CAPTURE(scene, held);
  const SceneFile file = load_scene(scene, {held, true, {}});
  const Pose start =
      std::find_if(file.scene.parts.begin(), file.scene.parts.end(), [](const Part& p) { return p.held; })->pose;
  std::ostringstream script;
  script.precision(17);
  script << "t,px,py,pz,qw,qx,qy,qz\n";
  for (const Waypoint& w : way) {
    const Pose X = start * Pose{rotation(Vec3(0, 0, w.turn)), w.p};
    script << w.t;
    for (const double x : {X.p.x(), X.p.y(), X.p.z(), X.q.w(), X.q.x(), X.q.y(), X.q.z()}) script << ',' << x;
    script << '\n';
  }
  const std::filesystem::path beside = std::filesystem::path(scene).parent_path();
  std::ofstream(beside / "way.csv") << script.str();
  std::ofstream(beside / "run.toml") << read_text(scene) << "\n[device]\nscript = \"way.csv\"\n";
  const Output run = run_program("tegotae", "run --fast --hold " + held + " --record " + (folder / "run.csv") + " " +
                                                (beside / "run.toml").string());
  INFO(run.out << run.err);
  CHECK(run.code == 0);  // it is where the script ends
  std::vector<RecordedRow> rows = read_recording(folder / "run.csv");
  const FclOracle oracle(file.scene);
  int intersecting = 0;
  // The run has asked about every pose itself, which takes FCL 4 ms each where plates lie on one another.
  for (std::size_t i = 0; i < rows.size(); i += 5) intersecting += oracle.intersecting(rows[i].x).empty() ? 0 : 1;
  for (RecordedRow& row : rows) row.x = start.inverse() * row.x;
  CHECK(intersecting == 0);
  REQUIRE(!rows.empty());
  return rows;
}

// Facets of hole and shaft add at most their chords to a radial clearance, m; rounding of files besides.
constexpr double kChords = 10.1e-6;
constexpr double kKept = 1e-5;  // m: of a gap, half of what contact.l_min is at most when it is not set

/// The shaft goes out along its axis to 60 mm, and back.
void check_shaft(const TempFolder& folder, const std::string& scene) {
  const auto rows = there_and_back(folder, scene, "Welle", {{0}, {0.8, {0, 0, 0.06}}, {1.6}});
  double farthest = 0;
  for (const RecordedRow& row : rows) farthest = std::max(farthest, row.x.p.z());
  CHECK(farthest > 0.95 * 0.06);
  const Vec3 end = rows.back().x.p;
  CHECK(end.head<2>().norm() < 0.5e-3 * (20 - 19.993) + kChords);
  CHECK(std::abs(end.z()) < 2e-4);  // of the hand's friction
}

/// The cover, which lies on the plate exactly in line, goes up off its dowels and 0.1 mm aside, and down again; there
/// it is turned and shifted to and fro. How far its holes are off their dowels is known in closed form.
void check_cover(const TempFolder& folder, const std::string& scene) {
  CAPTURE(scene);
  const StepSizes sizes;
  const double up = 0.02;
  const Vec3 high(0, 0, up), aside(7e-5, 7e-5, up), pressed(0, 0, -2e-4), along_y(0, 1e-3, -2e-4);
  const double turned = 0.03;
  const auto rows = there_and_back(folder, scene, "Blech",
                                   {{0},
                                    {0.6, high},
                                    {0.8, aside},
                                    {1.6, {7e-5, 7e-5, -2e-4}},
                                    {1.8, pressed, turned},
                                    {2.0, pressed, turned},
                                    {2.2, pressed, -turned},
                                    {2.4, pressed, -turned},
                                    {2.6, along_y},
                                    {2.8, along_y},
                                    {3.0}});
  const auto off = [&](const Pose& X, double side) {
    const Vec3 hole(side * 1e-3 * sizes.dowel_at, 0, 0);
    return Vec3(X * hole - hole);
  };
  const double clearance = 0.5e-3 * (sizes.dowel_hole - sizes.dowel), widest = clearance + kChords;
  double highest = 0;
  const RecordedRow *left_turn = nullptr, *right_turn = nullptr, *shifted = nullptr;
  for (const RecordedRow& row : rows) {
    highest = std::max(highest, row.x.p.z());
    // Where the straight part of the dowels is in the holes they hold it.
    if (off(row.x, 1).z() < 1e-3 * (sizes.cover_z - sizes.chamfer_length) &&
        off(row.x, -1).z() < 1e-3 * (sizes.cover_z - sizes.chamfer_length))
      for (const double side : {-1.0, 1.0}) REQUIRE(off(row.x, side).head<2>().norm() < widest);
    if (row.t < 2.0) left_turn = &row;
    if (row.t < 2.4) right_turn = &row;
    if (row.t < 2.8) shifted = &row;
  }
  CHECK(highest > 0.95 * up);
  // Turned to either side both dowels are touched, on opposite sides; shifted, on the same side.
  const double touching = 1e-6;
  for (const auto& [row, sign] : {std::pair(left_turn, 1.0), {right_turn, -1.0}}) {
    CHECK(sign * off(row->x, 1).y() > touching);
    CHECK(sign * off(row->x, -1).y() < -touching);
  }
  CHECK(off(shifted->x, 1).y() > touching);
  CHECK(off(shifted->x, -1).y() > touching);
  for (const RecordedRow* row : {left_turn, right_turn, shifted, &rows.back()}) {
    // On its seat: the gap that the contact loop keeps, and no more.
    CHECK(row->x.p.z() > 0);
    CHECK(row->x.p.z() < 1.01 * kKept);
    CHECK(row->contacts >= 4);
  }
}

}  // namespace

TEST_CASE("shaft and cover of a STEP assembly are taken out and put back, also through glTF", "[import]") {
  const TempFolder folder;
  write_step_assembly(folder / "a.step", {}, "MM", "AP214IS");
  const Output o = run_program("tegotae", "import " + (folder / "a.step") + " --hold Welle -o " + (folder / "out"));
  INFO(o.err);
  REQUIRE(o.code == 0);
  CHECK(o.err.empty());
  CHECK(o.out.find("7 parts, 5 meshes") != std::string::npos);
  const SceneFile file = load_scene(folder / "out/scene.toml");
  const auto& parts = file.scene.parts;
  REQUIRE(parts.size() == 7);
  CHECK(parts[6].held);
  CHECK(parts[1].path == std::vector<std::string>{"Baugruppe", "Träger"});
  CHECK(parts[1].mesh == parts[2].mesh);
  CHECK(parts[4].mesh == parts[5].mesh);
  REQUIRE(parts[0].color);
  CHECK(*parts[0].color == Color{0.1, 0.2, 0.9, 1});
  CHECK((parts[2].pose.p - Vec3(0.12, 0.215, 0.3)).norm() < 1e-12);
  CHECK(run_program("tegotae", "run --fast " + (folder / "out/scene.toml")).code == 0);
  // The cover lies on the plate; every other pair has a clearance: 3.5 um of shaft, 2 um of dowels, 10 um of bushings.
  const Output clash = run_program("tegotae", "check --clash --within 20um " + (folder / "out/scene.toml"));
  INFO(clash.out);
  CHECK(clash.out.find("of 7 parts 0 pairs overlap") != std::string::npos);
  CHECK(clash.out.find("Grundplatte and Blech: touch, depth") != std::string::npos);
  // Nothing closes a clearance, and two chord errors of 5 um are the most that facets add to it.
  const std::pair<const char*, double> gaps[] = {{"Buchse links and Welle: ", 3.5e-3},
                                                 {"Grundplatte and Stift: ", 2e-3},
                                                 {"Blech and Stift_2: ", 2e-3},
                                                 {"Grundplatte and Buchse links: ", 10e-3}};
  for (const auto& [pair, nominal] : gaps) {
    INFO(pair);
    const auto at = clash.out.find(pair);
    REQUIRE(at != std::string::npos);
    const auto number = clash.out.find("gap ", at);
    REQUIRE(number < clash.out.find('\n', at));
    const double gap = std::stod(clash.out.substr(number + 4));
    CHECK(gap >= nominal - 1e-9);
    CHECK(gap <= nominal + 10.1e-3);
  }
  check_shaft(folder, folder / "out/scene.toml");
  check_cover(folder, folder / "out/scene.toml");

  // The same assembly through glTF.
  folder.write("a.glb", glb_of(file.scene));
  const Output gltf = run_program("tegotae", "import " + (folder / "a.glb") + " -o " + (folder / "gltf"));
  INFO(gltf.err);
  REQUIRE(gltf.code == 0);
  CHECK(gltf.out.find("7 parts, 5 meshes") != std::string::npos);
  CHECK(load_scene(folder / "gltf/scene.toml", {{}, false, {}}).up == UpAxis::y);
  check_shaft(folder, folder / "gltf/scene.toml");
  check_cover(folder, folder / "gltf/scene.toml");
}
