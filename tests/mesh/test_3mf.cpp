// What changes shape or place in 3MF: a test for each row of docs/formats.md.
#include <minizip/zip.h>

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "tegotae/import/load.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const char* const kRelations =
    R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>)";

// Corners 0, x, y, z; edges of 10.
const char* const kMesh = R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="10" y="0" z="0"/>
<vertex x="0" y="10" z="0"/><vertex x="0" y="0" z="10"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="1" v2="2" v3="3"/><triangle v1="2" v2="0" v3="3"/></triangles></mesh>)";

std::string object(const char* id, const std::string& more, const std::string& inside = kMesh) {
  return std::string("<object id=\"") + id + "\" " + more + ">" + inside + "</object>";
}

std::string model(const std::string& resources, const std::string& build,
                  const std::string& more = "unit=\"millimeter\"") {
  return "<?xml version=\"1.0\"?><model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
         "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
         "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" " +
         more + "><resources>" + resources + "</resources><build>" + build + "</build></model>";
}

using Files = std::vector<std::pair<std::string, std::string>>;

std::string write(const TempFolder& folder, const Files& files) {
  const std::string path = folder / "a.3mf";
  zipFile zip = zipOpen(path.c_str(), APPEND_STATUS_CREATE);
  REQUIRE(zip != nullptr);
  for (const auto& [name, bytes] : files) {
    REQUIRE(zipOpenNewFileInZip(zip, name.c_str(), nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 6) == ZIP_OK);
    REQUIRE(zipWriteInFileInZip(zip, bytes.data(), static_cast<unsigned>(bytes.size())) == ZIP_OK);
    zipCloseFileInZip(zip);
  }
  zipClose(zip, nullptr);
  return path;
}

std::string write(const TempFolder& folder, const std::string& text) {
  return write(folder, {{"_rels/.rels", kRelations}, {"3D/3dmodel.model", text}});
}

void check_part(const Assembly& a, std::size_t part, const Vec3& lo, const Vec3& hi) {
  check_box(box_of(a, part), lo, hi);
  CHECK(report(*a.shapes[a.parts[part].shape]).inverted_shells == 0);
}

}  // namespace

TEST_CASE("3MF: lengths are in the unit of the file", "[3mf]") {
  const TempFolder folder;
  const std::pair<const char*, double> units[] = {{"", 1e-3},
                                                  {"unit=\"micron\"", 1e-6},
                                                  {"unit=\"millimeter\"", 1e-3},
                                                  {"unit=\"centimeter\"", 1e-2},
                                                  {"unit=\"inch\"", 0.0254},
                                                  {"unit=\"foot\"", 0.3048},
                                                  {"unit=\"meter\"", 1}};
  for (const auto& [unit, meters] : units) {
    INFO(unit);
    const Assembly a =
        read_assembly(write(folder, model(object("1", "name=\"tip\""),
                                          R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/>)", unit)));
    REQUIRE(a.parts.size() == 1);
    CHECK(a.parts[0].name == "tip");
    const auto box = box_of(a, 0);
    CHECK(box.min().x() == Approx(5 * meters));
    CHECK(box.max().x() == Approx(15 * meters));
  }
  CHECK_THAT(refusal(write(folder, model(object("1", ""), R"(<item objectid="1"/>)", "unit=\"yard\""))),
             Catch::Contains("yard"));
}

TEST_CASE("3MF: items and components are placed, turned, scaled and mirrored", "[3mf]") {
  const TempFolder folder;
  const std::string group = object(
      "2", "name=\"pair\"",
      R"(<components><component objectid="1"/><component objectid="1" transform="1 0 0 0 1 0 0 0 1 20 0 0"/></components>)");
  // A quarter turn about z: rows are where x, y, z go.
  const std::string file = write(folder, model(object("1", "name=\"tip\"") + group,
                                               R"(<item objectid="2" transform="0 1 0 -1 0 0 0 0 1 100 0 0"/>)"
                                               R"(<item objectid="1" transform="-1 0 0 0 1 0 0 0 2 0 0 0"/>)"));
  const Assembly a = read_assembly(file);
  REQUIRE(a.parts.size() == 3);
  check_part(a, 0, {0.09, 0, 0}, {0.1, 0.01, 0.01});
  check_part(a, 1, {0.09, 0.02, 0}, {0.1, 0.03, 0.01});
  check_part(a, 2, {-0.01, 0, 0}, {0, 0.01, 0.02});
  CHECK(a.parts[0].shape == a.parts[1].shape);
  CHECK(a.parts[0].path == std::vector<std::string>{"pair"});
  // As one surface, in units of the file.
  const MeshReport whole = report(load_mesh(file));
  CHECK((whole.box_min - Vec3(-10, 0, 0)).norm() < 1e-9);
  CHECK((whole.box_max - Vec3(100, 30, 20)).norm() < 1e-9);
  CHECK(whole.inverted_shells == 0);
}

TEST_CASE("3MF: objects in other files of the archive (production)", "[3mf]") {
  const TempFolder folder;
  const std::string other = model(object("7", "name=\"inner\""), "");
  const std::string group =
      object("1", "", R"(<components><component p:path="/3D/Objects/o.model" objectid="7"/></components>)");
  const Assembly a = read_assembly(write(
      folder,
      {{"_rels/.rels", kRelations},
       {"3D/3dmodel.model", model(group, R"(<item objectid="1"/>)", "unit=\"millimeter\" requiredextensions=\"p\"")},
       {"3D/Objects/o.model", other}}));
  REQUIRE(a.parts.size() == 1);
  CHECK(a.parts[0].name == "inner");
  check_part(a, 0, Vec3::Zero(), Vec3::Constant(0.01));
}

TEST_CASE("3MF: what is not built is left out, supports with a note; lattices are told", "[3mf]") {
  const TempFolder folder;
  const std::string lattice = std::string(kMesh).insert(6, "<b:beamlattice minlength=\"1\" radius=\"1\"/>");
  const Assembly a =
      read_assembly(write(folder, model(object("1", "name=\"tip\"", lattice) + object("2", "name=\"spare\"") +
                                            object("3", "name=\"prop\" type=\"support\""),
                                        R"(<item objectid="1"/><item objectid="3"/>)")));
  REQUIRE(a.parts.size() == 1);
  REQUIRE(a.notes.size() == 2);
  CHECK_THAT(a.notes[0] + a.notes[1],
             Catch::Contains("\"tip\": its beam lattice is not read") && Catch::Contains("\"prop\": a support"));
}

TEST_CASE("3MF: shapes that extensions have in place of a mesh are told by their element", "[3mf]") {
  const TempFolder folder;
  const std::string
      boolean = object("2", "name=\"cut\"",
                       R"(<metadatagroup/><bo:booleanshape objectid="1"><bo:boolean objectid="1"/></bo:booleanshape>)"),
      displaced = object("3", "name=\"rough\"", "<d:displacementmesh/>"), nothing = object("4", "", "");
  const std::string spaces =
      "xmlns:bo=\"http://schemas.3mf.io/3dmanufacturing/booleans/2023/07\" "
      "xmlns:d=\"http://schemas.microsoft.com/3dmanufacturing/displacement/2022/07\"";
  const Assembly a = read_assembly(write(
      folder, model(object("1", "") + boolean + displaced + nothing,
                    R"(<item objectid="1"/><item objectid="2"/><item objectid="3"/><item objectid="4"/>)", spaces)));
  REQUIRE(a.parts.size() == 1);
  REQUIRE(a.notes.size() == 1);
  CHECK_THAT(
      a.notes[0],
      Catch::Contains("3 objects (\"cut\" (bo:booleanshape), \"rough\" (d:displacementmesh), \"object 4\" (empty))") &&
          Catch::Contains("left out; export it as a mesh"));
  // Where there is nothing else, the refusal says why.
  const std::string alone = write(folder, model(displaced, R"(<item objectid="3"/>)", spaces));
  CHECK_THAT(refusal(alone), Catch::Contains("no parts with triangles: \"rough\" (d:displacementmesh): "));
  CHECK_THAT(refusal([&] { load_mesh(alone); }), Catch::Contains("no triangles: \"rough\" (d:displacementmesh): "));
}

TEST_CASE("3MF: transforms that leave an object no volume are told", "[3mf]") {
  const TempFolder folder;
  const Assembly a = read_assembly(
      write(folder, model(object("1", "name=\"tip\""), R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 0 0 0 0"/>)"
                                                       R"(<item objectid="1" transform="0 0 0 0 0 0 0 0 0 5 0 0"/>)"
                                                       R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 2 0 0 0"/>)")));
  CHECK(a.parts.size() == 2);
  REQUIRE(a.notes.size() == 2);
  CHECK(has_note(a, "\"tip\": scaled to nothing in some direction, so a sheet"));
  CHECK(has_note(a, "\"tip\": scaled to nothing, so left out"));
}

TEST_CASE("3MF: objects of the type other, and meshes that stand in for slices, are told", "[3mf]") {
  const TempFolder folder;
  const Assembly a =
      read_assembly(write(folder, model(object("1", "name=\"tip\" s:meshresolution=\"lowres\"") +
                                            object("2", "type=\"other\" name=\"aid\""),
                                        R"(<item objectid="1"/><item objectid="2"/>)",
                                        "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\"")));
  REQUIRE(a.parts.size() == 1);
  CHECK(has_note(a, "\"aid\": of the type other"));
  CHECK(has_note(a, "\"tip\": printed from slices"));
}

TEST_CASE("3MF: elements of extensions in a mesh are skipped, triangle sets may be required", "[3mf]") {
  const TempFolder folder;
  std::string mesh = kMesh;
  mesh.insert(mesh.find("<vertices>") + 10, "<t:more/><!-- corners -->");
  mesh.insert(mesh.find("<triangles>") + 11, "<t:more/>");
  const Assembly a = read_assembly(
      write(folder, model(object("1", "", mesh), R"(<item objectid="1"/>)",
                          "requiredextensions=\"t\" "
                          "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07\"")));
  check_part(a, 0, Vec3::Zero(), Vec3::Constant(0.01));
  mesh.replace(mesh.find("v1=\"0\""), 6, "v1=\".5\"");
  CHECK_THAT(refusal(write(folder, model(object("1", "", mesh), R"(<item objectid="1"/>)"))),
             Catch::Contains("not a whole number"));
}

TEST_CASE("3MF: a required extension that is not read refuses the file", "[3mf]") {
  const TempFolder folder;
  CHECK_THAT(refusal(write(folder, model(object("1", ""), R"(<item objectid="1"/>)", "requiredextensions=\"p b\""))),
             Catch::Contains("requires the 3MF extension http://schemas.microsoft.com/3dmanufacturing/beamlattice"));
}

TEST_CASE("3MF: colors of base materials", "[3mf]") {
  const TempFolder folder;
  const std::string materials =
      R"(<basematerials id="5"><base name="a" displaycolor="#FFFFFF"/><base name="b" displaycolor="#3300FF80"/></basematerials>)";
  const Assembly a =
      read_assembly(write(folder, model(materials + object("1", "pid=\"5\" pindex=\"1\"") + object("2", ""),
                                        R"(<item objectid="1"/><item objectid="2"/>)")));
  REQUIRE(a.parts.size() == 2);
  REQUIRE(a.parts[0].color);
  CHECK((*a.parts[0].color)[0] == Approx(0.2));
  CHECK((*a.parts[0].color)[2] == 1);
  CHECK((*a.parts[0].color)[3] == Approx(128 / 255.0));
  CHECK(!a.parts[1].color);
}

TEST_CASE("3MF: damaged files are refused in one line", "[3mf]") {
  const TempFolder folder;
  const std::string whole = read_text(write(folder, model(object("1", "name=\"tip\""), R"(<item objectid="1"/>)")));
  for (std::size_t n = 1; n + 22 < whole.size(); n += 5) {  // 22: the record at the end, of which the last two may miss
    folder.write("cut.3mf", whole.substr(0, n));
    const std::string error = refusal(folder / "cut.3mf");
    INFO(n << ": " << error);
    CHECK(error.find("cut.3mf: ") != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
  }
  std::string loop = object("1", "", R"(<components><component objectid="1"/></components>)");
  CHECK_THAT(refusal(write(folder, model(loop, R"(<item objectid="1"/>)"))), Catch::Contains("nested"));
  // Each of forty levels names the next twice.
  std::string levels = object("0", "");
  for (int i = 1; i <= 40; ++i) {
    const std::string next = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    levels += object(std::to_string(i).c_str(), "", "<components>" + next + next + "</components>");
  }
  CHECK_THAT(refusal(write(folder, model(levels, R"(<item objectid="40"/>)"))), Catch::Contains("more than a million"));
  const std::pair<const char*, const char*> bad[] = {
      {R"(<item objectid="9"/>)", "object 9, which is missing"},
      {R"(<item objectid="1" transform="1 0 0"/>)", "fewer than 12"},
      {R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 x"/>)", "number"},
      {R"(<item objectid="1" transform="nan 0 0 0 1 0 0 0 1 0 0 0"/>)", ""},
      {R"(<item objectid="1" p:path="/3D/none.model"/>)", "none.model in it is missing"}};
  for (const auto& [item, why] : bad)
    CHECK_THAT(refusal(write(folder, model(object("1", ""), item))),
               Catch::Contains(std::string("a.3mf: ")) && Catch::Contains(why));
  CHECK_THAT(refusal(write(folder, model(object("1", "") + object("1", ""), R"(<item objectid="1"/>)"))),
             Catch::Contains("two objects of the id \"1\""));
  // What is wrong is named: the number, and of which vertex, triangle or transform it is.
  const auto with = [&](const std::string& old, const std::string& text) {
    const std::string mesh = std::string(kMesh).replace(std::string(kMesh).find(old), old.size(), text);
    return refusal(write(folder, model(object("1", "name=\"tip\"", mesh), R"(<item objectid="1"/>)")));
  };
  CHECK_THAT(with("x=\"10\"", "x=\"1,5\""), Catch::Contains("vertex 1 of \"tip\" has \"1,5\" for a number"));
  CHECK_THAT(with("x=\"10\"", ""), Catch::Contains("vertex 1 of \"tip\""));
  CHECK_THAT(with("v2=\"1\"", "v2=\"0.5\""), Catch::Contains("triangle 1 of \"tip\""));
  CHECK_THAT(with("v2=\"1\"", "v2=\"9\""), Catch::Contains("index out of range: triangle 1 of \"tip\""));
  // Levels of many supports: as much work as parts.
  std::string supports = object("0", "type=\"support\"");
  for (int i = 1; i <= 4; ++i) {
    std::string many;
    for (int k = 0; k < 100; ++k) many += "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    supports += object(std::to_string(i).c_str(), "", "<components>" + many + "</components>");
  }
  CHECK_THAT(refusal(write(folder, model(supports, R"(<item objectid="4"/>)"))),
             Catch::Contains("more than a million"));
  const std::string range = std::string(kMesh).replace(std::string(kMesh).find("v3=\"1\""), 6, "v3=\"4\"");
  CHECK_THAT(refusal(write(folder, model(object("1", "", range), R"(<item objectid="1"/>)"))),
             Catch::Contains("index out of range"));
  CHECK_THAT(refusal(write(folder, Files{{"x", "y"}})), Catch::Contains("_rels/.rels in it is missing"));
}
