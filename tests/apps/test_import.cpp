// `tegotae import`, and what is done with its scenes.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "apps/run_program.hpp"
#include "catch.hpp"
#ifdef TEGOTAE_HAS_STEP
#include "mesh/step_assembly.hpp"
#endif
#include "recording.hpp"
#include "tegotae/mesh/report.hpp"
#include "tegotae/sim/scene_file.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

void check_refused(const Output& o, const std::vector<std::string>& named) {
  INFO("stdout: " << o.out);
  INFO("stderr: " << o.err);
  CHECK(o.code == 2);
  CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
  for (const std::string& text : named) CHECK(o.err.find(text) != std::string::npos);
}

}  // namespace

TEST_CASE("a mesh file becomes a scene that runs", "[import]") {
  const TempFolder folder;
  folder.write("two pieces.obj",
               "g a/b\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
               "g a/b\nv 40 0 0\nv 50 0 0\nv 40 10 0\nv 40 0 10\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
  const std::string file = "'" + (folder / "two pieces.obj") + "'";
  const Output o = run_program("tegotae", "import " + file + " --unit mm --split -o " + (folder / "out"));
  INFO(o.err);
  REQUIRE(o.code == 0);
  CHECK(o.out.find("2 parts, 2 meshes, 8 triangles") != std::string::npos);
  CHECK(o.out.find("--hold NAME") != std::string::npos);
  const SceneFile scene = load_scene(folder / "out/scene.toml", {"a/b", true, {}});
  REQUIRE(scene.scene.parts.size() == 2);
  CHECK(scene.scene.parts[1].name == "a/b_2");
  CHECK((scene.scene.parts[1].pose * report(*scene.scene.parts[1].mesh).box_max - Vec3(0.05, 0.01, 0.01)).norm() <
        1e-8);
  CHECK(run_program("tegotae", "run --fast --hold a/b_2 " + (folder / "out/scene.toml")).code == 0);
  check_refused(run_program("tegotae", "run --fast " + (folder / "out/scene.toml")),
                {"no part is held", "--hold NAME"});
  check_refused(run_program("tegotae", "run --fast --hold c " + (folder / "out/scene.toml")), {"no part is named c"});
  const Output check = run_program("tegotae", "check " + (folder / "out/scene.toml"));
  CHECK(check.code == 0);
  CHECK(check.out.find("no part is held") != std::string::npos);
  check_refused(run_program("tegotae", "import " + file + " -o " + (folder / "out")), {"scene.toml: exists already"});
  check_refused(run_program("tegotae", "import " + file + " --hold c -o " + (folder / "new")), {"no part is named c"});
  CHECK(!std::filesystem::exists(folder / "new"));
  check_refused(run_program("tegotae", "import " + (folder / "none.glb") + " -o " + (folder / "new")), {"none.glb"});
  check_refused(run_program("tegotae", "import " + file + " --chord 5 -o " + (folder / "new")), {"--chord"});
  folder.write("plain", "");
  check_refused(run_program("tegotae", "import " + file + " -o " + (folder / "plain")), {"plain"});
}

TEST_CASE("control characters in names become spaces, so that the scene can be read", "[import]") {
  const TempFolder folder;
  folder.write("two.obj",
               "g a\x01"
               "b\nv 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
               "g c\nv 40 0 0\nv 50 0 0\nv 40 10 0\nv 40 0 10\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
  REQUIRE(run_program("tegotae", "import " + (folder / "two.obj") + " --split -o " + (folder / "out")).code == 0);
  CHECK(load_scene(folder / "out/scene.toml", {"a b", true, {}}).scene.parts.size() == 2);
}

TEST_CASE("clashes are listed by name, depth and place", "[import]") {
  const TempFolder folder;
  write_small_scene(folder);
  std::string scene = read_text(folder / "scene.toml");
  scene = scene.substr(0, scene.find("[device]"));
  scene += "[[part]]\nname = \"third\"\nmesh = \"tet.obj\"\nposition = [0, 0, 0.009]\n";
  folder.write("clash.toml", scene);
  const Output o = run_program("tegotae", "check --clash " + (folder / "clash.toml"));
  INFO(o.out << o.err);
  CHECK(o.code == 0);
  // The tip of the block, 10 mm high, ends 1 mm inside the third one: nearest are the planes x = 0 and y = 0, on which
  // it lies.
  CHECK(o.out.find("block and third: ") != std::string::npos);
  CHECK(o.out.find("peg and third") == std::string::npos);
  const Output wide = run_program("tegotae", "check --clash --within 2mm " + (folder / "clash.toml"));
  CHECK(wide.out.find("peg and third: near, gap 1 mm") != std::string::npos);
  CHECK(wide.out.find("of 3 parts") != std::string::npos);
  check_refused(run_program("tegotae", "check --clash " + (folder / "tet.obj")), {"tet.obj: --clash needs a scene"});
  check_refused(run_program("tegotae", "check --within 2mm " + (folder / "clash.toml")), {"--clash"});
}

#ifdef TEGOTAE_HAS_STEP
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

/// Takes `held` out of its place by `way` (m) along the assembly's axis, the world's -y, and puts it `back`.
void check_out(const TempFolder& folder, const std::string& scene, const std::string& held, double way, bool back) {
  CAPTURE(scene, held);
  const SceneFile file = load_scene(scene, {held, true, {}});
  const auto part =
      std::find_if(file.scene.parts.begin(), file.scene.parts.end(), [](const Part& p) { return p.held; });
  const Vec3& p = part->pose.p;
  const Quat& q = part->pose.q;
  std::ostringstream script;
  script.precision(17);
  script << "t,px,py,pz,qw,qx,qy,qz\n";
  for (const auto& [t, out] : {std::pair(0.0, 0.0), {0.8, way}, {1.6, back ? 0 : way}})
    script << t << ',' << p.x() << ',' << p.y() - out << ',' << p.z() << ',' << q.w() << ',' << q.x() << ',' << q.y()
           << ',' << q.z() << '\n';
  const std::filesystem::path beside = std::filesystem::path(scene).parent_path();
  std::ofstream(beside / "out.csv") << script.str();
  std::ofstream(beside / "run.toml") << read_text(scene) << "\n[device]\nscript = \"out.csv\"\n";
  const Output run = run_program("tegotae", "run --fast --hold " + held + " --record " + (folder / "run.csv") + " " +
                                                (beside / "run.toml").string());
  INFO(run.out << run.err);
  CHECK(run.code == 0);  // it is where the script ends, and no pose intersected
  double farthest = 0;
  for (const RecordedRow& row : read_recording(folder / "run.csv")) farthest = std::max(farthest, p.y() - row.x.p.y());
  CHECK(farthest > 0.95 * way);
}

}  // namespace

TEST_CASE("damaged STEP files end in one line, whatever the reader does with them", "[import]") {
  const TempFolder folder;
  write_step_assembly(folder / "a.step", {}, "MM", "AP214IS");
  const std::string whole = read_text(folder / "a.step");
  std::mt19937 random(5);
  int refused = 0;
  for (int i = 0; i < 12; ++i) {
    std::string bad = whole;
    for (int k = 0; k < 1 + 3 * (i % 3); ++k)
      bad[whole.find("DATA;") + random() % (whole.size() - whole.find("DATA;") - 40)] =
          "0123456789,#()$.AB"[random() % 18];
    folder.write("bad.step", bad);
    const Output o = run_program("tegotae", "import " + (folder / "bad.step") + " -o " + (folder / "out"));
    INFO(i << " " << o.err);
    CHECK((o.code == 0 || o.code == 2));
    if (o.code == 2) {
      ++refused;
      CHECK(std::count(o.err.begin(), o.err.end(), '\n') == 1);
      CHECK(!std::filesystem::exists(folder / "out"));
    }
    std::filesystem::remove_all(folder / "out");
  }
  CHECK(refused > 0);
}

TEST_CASE("a STEP assembly becomes a scene whose shaft can be held", "[import]") {
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
  check_out(folder, folder / "out/scene.toml", "Welle", 0.06, true);
  // The cover lies on the plate, exactly in line, with the dowels in its holes.
  check_out(folder, folder / "out/scene.toml", "Blech", 0.02, false);

  // The same assembly through glTF.
  folder.write("a.glb", glb_of(file.scene));
  const Output gltf = run_program("tegotae", "import " + (folder / "a.glb") + " -o " + (folder / "gltf"));
  INFO(gltf.err);
  REQUIRE(gltf.code == 0);
  CHECK(gltf.out.find("7 parts, 5 meshes") != std::string::npos);
  check_out(folder, folder / "gltf/scene.toml", "Welle", 0.06, true);
  check_out(folder, folder / "gltf/scene.toml", "Blech", 0.02, false);
}
#endif
