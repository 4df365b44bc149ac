// What people get of STEP files as CAD programs write them: names, what is left out, and few notes that say what to do.
#include <algorithm>
#include <filesystem>
#include <regex>

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "mesh/step_products.hpp"
#include "mesh/step_text.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

using Path = std::vector<std::string>;

/// The only note with `what` in it.
std::string note(const Assembly& a, const std::string& what) {
  std::vector<std::string> found;
  for (const std::string& note : a.notes)
    if (note.find(what) != std::string::npos) found.push_back(note);
  INFO(what);
  REQUIRE(found.size() == 1);
  return found[0];
}

/// The value in um that a note ends its first half with.
double micrometers(const std::string& note) {
  std::smatch match;
  REQUIRE(std::regex_search(note, match, std::regex("([0-9.e+-]+) um")));
  return std::stod(match[1]);
}

Assembly read_products(const StepText& step) {
  const TempFolder folder;
  folder.write("of a file.step", step.text());
  return read_assembly(folder / "of a file.step");
}

/// The name of the one part, a block, of a product that is called so in the file.
std::string read_name(const std::string& in_file) {
  StepText s;
  s.shape(s.product(in_file), {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const Assembly a = read_products(s);
  REQUIRE(a.parts.size() == 1);
  return a.parts[0].name;
}

}  // namespace

TEST_CASE("STEP: a product of a solid and an empty compound is one part, called like the product", "[step]") {
  const TempFolder folder;
  write_step_hollow_products(folder / "as1.step");
  const Assembly a = read_assembly(folder / "as1.step");
  for (const std::string& note : a.notes) UNSCOPED_INFO(note);
  CHECK(a.notes.empty());
  CHECK(a.shapes.size() == 3);
  std::vector<std::string> names;
  for (const AssemblyPart& p : a.parts) names.push_back(p.name);
  CHECK(names == Path{"PLATE", "BOLT", "NUT", "BOLT_2", "NUT_2", "BOLT_3", "NUT_3", "BOLT_4", "NUT_4"});
  CHECK(part(a, "PLATE").path == Path{"AS1"});
  CHECK(part(a, "NUT_3").path == Path{"AS1", "PAIR"});
  CHECK(a.shapes[part(a, "NUT_3").shape]->name == "NUT");
  // Its file has a mesh for each, and no other.
  const Output o = run_program("tegotae", "import " + (folder / "as1.step") + " -o " + (folder / "out"));
  CHECK(o.code == 0);
  CHECK(o.err.empty());
  std::vector<std::string> files;
  for (const auto& file : std::filesystem::directory_iterator(folder / "out/meshes"))
    files.push_back(file.path().filename().string());
  std::sort(files.begin(), files.end());
  CHECK(files == Path{"BOLT.ply", "NUT.ply", "PLATE.ply"});
}

TEST_CASE("STEP: an empty compound beside a part leaves it alone in its file", "[step]") {
  const TempFolder folder;
  write_step_flange(folder / "hollow.step", true);
  write_step_flange(folder / "plain.step", false);
  const Assembly hollow = read_assembly(folder / "hollow.step"), plain = read_assembly(folder / "plain.step");
  REQUIRE(hollow.parts.size() == 1);
  REQUIRE(hollow.shapes.size() == 1);
  CHECK(hollow.parts[0].name == "FLANGE");
  CHECK(hollow.parts[0].path.empty());
  CHECK(hollow.notes.empty());
  CHECK(hollow.shapes[0]->triangles == plain.shapes[0]->triangles);
  CHECK(hollow.shapes[0]->vertices == plain.shapes[0]->vertices);
}

TEST_CASE("STEP: names that OpenCASCADE made up give way to the product's, or to the file's", "[step]") {
  for (const char* made_up : {"SOLID", "COMPOUND_3", "Shell 2", "Open CASCADE STEP translator 7.6 1", ""})
    CHECK(read_name(made_up) == "of a file");
  for (const char* given : {"SOLIDUS", "4711-02", "Shaft 2", "Edge plate"}) CHECK(read_name(given) == given);
  // Two of them in a product that has a name, and one product with a name of its own beside an empty one with a name.
  StepText s;
  const int top = s.product("top"), box = s.product("BOX"), frame = s.origin();
  const int all = s.shape(top, {frame}), group = s.shape(box, {frame});
  s.instance(box, group, frame, top, all, frame, "=>[0:1:1:2]");
  for (const char* name : {"SOLID", "SOLID", "lid"}) {
    const int one = s.product(name);
    const int shape = s.shape(one, {frame, s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
    s.instance(one, shape, frame, box, group, frame, "NAUO1");
  }
  const int seal = s.product("seal");
  const int nothing = s.shape(seal, {frame});
  for (int i = 0; i < 3; ++i) s.instance(seal, nothing, frame, box, group, frame, "NAUO2");
  const Assembly a = read_products(s);
  REQUIRE(a.parts.size() == 3);
  for (const char* name : {"BOX", "BOX_2", "lid"}) CHECK(part(a, name).path == Path{"top", "BOX"});
  REQUIRE(a.notes.size() == 1);
  CHECK_THAT(a.notes[0], Catch::StartsWith("\"seal\": no faces, so left out; ") && Catch::Contains("export it"));
}

TEST_CASE("STEP: names in every writing of letters", "[step]") {
  const std::string over =
      "\xc3\x9c"
      "berwurf";
  CHECK(read_name("\\X2\\00DC\\X0\\berwurf") == over);
  CHECK(read_name("\\X\\DCberwurf") == over);
  CHECK(read_name("\\S\\\\berwurf") == over);
  CHECK(read_name(over) == over);
  CHECK(read_name("\xdc"
                  "berwurf") == over);  // Latin-1, which the format does not allow
  CHECK(read_name("\\X2\\4E2D6587\\X0\\ 1") == "\xe4\xb8\xad\xe6\x96\x87 1");
  CHECK(read_name("it''s \\\\ mine") == "it's \\ mine");
  // In notes too.
  StepText s;
  const int shape = s.shape(s.product("left"), {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int self = s.add("PRODUCT_DEFINITION_SHAPE('',''," + StepText::ref(s.product("\\X2\\00DC\\X0\\ber")) + ")");
  s.add("SHAPE_DEFINITION_REPRESENTATION(" + StepText::ref(self) + "," + StepText::ref(shape) + ")");
  CHECK(has_note(read_products(s),
                 "\"left\", \"\xc3\x9c"
                 "ber\" of "));
}

TEST_CASE("STEP: groups of groups, two solids in a product, and a solid beside a shell want no note", "[step]") {
  const TempFolder folder;
  write_step_nested(folder / "a.step");
  const Assembly a = read_assembly(folder / "a.step");
  for (const std::string& note : a.notes) UNSCOPED_INFO(note);
  CHECK(a.notes.empty());
  REQUIRE(a.parts.size() == 4);
  CHECK(part(a, "pin").path == Path{"all", "left", "inner"});
  CHECK(part(a, "pin_2").path == Path{"all", "right", "inner"});
  CHECK((part(a, "pin_2").pose.p - Vec3(0.1, 0.005, 0.007)).norm() < 1e-12);
  CHECK(part(a, "pin").shape != part(a, "pin_2").shape);
  for (const char* name : {"two", "shelled"}) {
    const MeshReport r = report(*a.shapes[part(a, name).shape]);
    CHECK(r.closed);
    CHECK(r.components == 2);
    CHECK(volume(*a.shapes[part(a, name).shape]) == Approx(8e-6 + 1e-6));
  }
  AssemblyOptions options;
  options.split = true;
  CHECK(read_assembly(folder / "a.step", options).parts.size() == 6);
}

TEST_CASE("STEP: each kind of thing is told once, with how many, some names, and what to do", "[step]") {
  const TempFolder folder;
  constexpr int copies = 4;
  write_step_flaws(folder / "a.step", copies);
  const Assembly a = read_assembly(folder / "a.step");
  for (const std::string& note : a.notes) UNSCOPED_INFO(note);
  CHECK(a.parts.size() == 6 * copies);
  struct Kind {
    const char *what, *who, *to_do;
  };
  const Kind kinds[] = {{"no faces", "8 parts (\"empty 1\", \"point 1\", \"empty 2\", ...): ", "export it as a solid"},
                        {"curves and points", "4 parts (\"line 1\", ", "has to be a solid or a surface"},
                        {"may mate", "4 pairs of parts (\"socket 1\" and \"ball 1\" in spheres, ", "smaller --chord"},
                        {"is bent by", "4 parts (\"slot 1\", ", "smaller --coarse-chord"},
                        {"into a clearance", "4 parts (\"cross 1\", ", "smaller --coarse-chord"},
                        {"turned over", "4 parts (\"cross 1\", ", "smaller --coarse-chord"},
                        {"not closed", "4 parts (\"open 1\" at face #", "sew it"}};
  CHECK(a.notes.size() == std::size(kinds));
  for (const Kind& kind : kinds) {
    const std::string said = note(a, kind.what);
    INFO(said);
    CHECK(said.rfind(kind.who, 0) == 0);
    CHECK(said.find("...)") != std::string::npos);
    const auto advice = said.find("; ", said.find(kind.what));
    REQUIRE(advice != std::string::npos);
    CHECK(said.find(kind.to_do, advice) != std::string::npos);
  }
  // What they say to do helps.
  AssemblyOptions finer;
  finer.coarse_chord = 5e-6;
  const Assembly b = read_assembly(folder / "a.step", finer);
  CHECK(b.notes.size() == std::size(kinds) - 1);
  CHECK(!has_note(b, "turned over"));
  for (const char* what : {"is bent by", "into a clearance"})
    CHECK(micrometers(note(b, what)) < 0.3 * micrometers(note(a, what)));
  finer.chord = 2e-6;
  CHECK(micrometers(note(read_assembly(folder / "a.step", finer), "may mate")) == Approx(2));
  // Of one nothing is counted.
  write_step_flaws(folder / "one.step", 1);
  CHECK(note(read_assembly(folder / "one.step"), "is bent by").rfind("\"slot 1\": a plane ", 0) == 0);
}

TEST_CASE("STEP: entities that are left out are told in one note of each kind", "[step]") {
  StepText s;
  const int top = s.product("all"), plate = s.product("plate"), frame = s.origin();
  const int all = s.shape(top, {frame});
  std::vector<int> items = {frame, s.block()};
  for (int i = 0; i < 5; ++i) items.push_back(s.add("BLOCK(''," + StepText::ref(frame) + ",4.,3.,3.)"));
  const int one = s.shape(plate, items);
  s.instance(plate, one, frame, top, all, frame, "placed");
  for (int i = 0; i < 2; ++i)
    s.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('2','loose',''," + StepText::ref(top) + "," + StepText::ref(plate) + ",$)");
  const Assembly a = read_products(s);
  for (const std::string& note : a.notes) UNSCOPED_INFO(note);
  REQUIRE(a.notes.size() == 2);
  CHECK_THAT(note(a, "not read"), Catch::StartsWith("5 shapes (" + StepText::ref(items[2]) + " is a BLOCK, ") &&
                                      Catch::Contains("export the part as a boundary representation"));
  CHECK_THAT(note(a, "without a place"), Catch::StartsWith("2 instances (#") && Catch::Contains("place it in the CAD"));
}
