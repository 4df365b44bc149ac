// Tessellated shapes in STEP (AP242): a test for each row of docs/formats.md.
#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "mesh/step_blocks.hpp"
#include "mesh/step_text.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const char* const kSchema = "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }";
const char* const kShown = "TESSELLATED_SHAPE_REPRESENTATION";

std::string refusal_of(const std::string& text) {
  return test::refusal([&] { read_step_text(text); });
}

/// The points 0, x, y, z, scaled, of a tetrahedron.
int corners(StepText& s, const std::string& size = "10.", const std::string& before = "") {
  return s.add("COORDINATES_LIST(''," + std::string(before.empty() ? "4" : "5") + ",(" + before + "(0.,0.,0.),(" +
               size + ",0.,0.),(0.," + size + ",0.),(0.,0.," + size + ")))");
}

int face(StepText& s, const std::string& size = "10.") {
  return s.add("TRIANGULATED_FACE(''," + r(corners(s, size)) + ",4,(),$,(),((1,3,2),(1,2,4),(2,3,4),(3,1,4)))");
}

int solid(StepText& s, const std::string& size = "10.", const std::string& exact = "$") {
  return s.add("TESSELLATED_SOLID('',(" + r(face(s, size)) + ")," + exact + ")");
}

/// A file of one product "tip" that is shown by `item`.
StepText with(StepText s, int item) {
  s.shape(s.product("tip"), {s.origin(), item}, kShown);
  return s;
}

void check_tip(const Assembly& a, std::size_t part = 0) {
  check_box(box_of(a, part), Vec3::Zero(), Vec3::Constant(0.01));
  const TriangleMesh& mesh = *a.shapes[a.parts[part].shape];
  CHECK(report(mesh).closed);
  CHECK(mesh.vertices.size() == 4);
  CHECK(mesh.triangles.size() == 4);
  CHECK(volume(mesh) == Approx(1e-6 / 6));
}

}  // namespace

TEST_CASE("STEP: tessellated solids, shells and sets, as triangles, strips and fans", "[step]") {
  const std::string shells[] = {"TESSELLATED_SOLID('',(FACE),$)", "TESSELLATED_SHELL('',(FACE),$)",
                                "TESSELLATED_GEOMETRIC_SET('',(FACE))"};
  // POINTS begin with one that no triangle uses.
  const std::pair<const char*, std::string> faces[] = {
      {"all points", "TRIANGULATED_FACE('',POINTS,5,(),$,(),((2,4,3),(2,3,5),(3,4,5),(4,2,5)))"},
      {"points by number", "TRIANGULATED_FACE('',POINTS,4,((0.,0.,1.)),$,(2,3,4,5),((1,3,2),(1,2,4),(2,3,4),(3,1,4)))"},
      {"other order", "TRIANGULATED_FACE('',POINTS,4,$,$,(5,4,3,2),((4,2,3),(4,3,1),(3,2,1),(2,4,1)))"},
      {"set", "TRIANGULATED_SURFACE_SET('',POINTS,5,(),(),((2,4,3),(2,3,5),(3,4,5),(4,2,5)))"},
      {"a strip", "COMPLEX_TRIANGULATED_FACE('',POINTS,4,(),$,(2,3,4,5),((1,3,2,4,1,3)),())"},
      {"strip and fan", "COMPLEX_TRIANGULATED_FACE('',POINTS,4,(),$,(2,3,4,5),((2,3,4)),((1,3,2,4,3)))"},
      {"set of a strip", "COMPLEX_TRIANGULATED_SURFACE_SET('',POINTS,5,(),(),((2,4,3,5,2,4)),())"}};
  for (const auto& [name, text] : faces) {
    for (const std::string& shell : shells) {
      INFO(name << " in " << shell);
      StepText s(kSchema);
      std::string face = text, all = shell;
      face.replace(face.find("POINTS"), 6, r(corners(s, "10.", "(99.,99.,99.),")));
      all.replace(all.find("FACE"), 4, r(s.add(face)));
      const int item = s.add(all);
      const Assembly a = read_step_text(with(s, item).text());
      REQUIRE(a.parts.size() == 1);
      CHECK(a.parts[0].name == "tip");
      CHECK(a.notes.empty());
      check_tip(a);
    }
  }
}

TEST_CASE("STEP: a tessellated solid of several faces is one closed surface", "[step]") {
  // Each face has its own points, so that they meet by coordinates only.
  StepText s(kSchema);
  std::string faces;
  for (const char* triangle : {"1,3,2", "1,2,4", "2,3,4", "3,1,4"})
    faces += (faces.empty() ? "" : ",") +
             r(s.add("TRIANGULATED_FACE(''," + r(corners(s)) + ",4,(),$,(),((" + triangle + ")))"));
  const int item = s.add("TESSELLATED_SOLID('',(" + faces + "),$)");
  check_tip(read_step_text(with(s, item).text()));
}

TEST_CASE("STEP: tessellated parts have the unit and the places of their products", "[step]") {
  StepText s(kSchema);
  const int top = s.product("all"), plate = s.product("plate"), tip = s.product("tip");
  const int origin = s.origin();
  // z stays, x becomes y.
  const int turned = s.frame(s.point(100, 0, 0), s.direction(0, 0, 1), s.direction(0, 1, 0));
  const int other = s.frame(s.point(0, 0, 50), s.direction(0, 0, 1), s.direction(1, 0, 0));
  const int all = s.shape(top, {origin, turned, other});
  const int own = s.origin();
  s.instance(plate, s.shape(plate, {own, s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION"), own, top, all, origin,
             "plate");
  s.set_unit("$");  // m
  const int here = s.origin();
  const int shown = s.shape(tip, {here, solid(s, "0.01")}, kShown);
  s.instance(tip, shown, here, top, all, turned, "left");
  s.instance(tip, shown, here, top, all, other, "right");
  const Assembly a = read_step_text(s.text());
  CHECK(a.notes.empty());
  REQUIRE(a.parts.size() == 3);
  check_box(box_of(a, 0), Vec3::Zero(), {0.04, 0.03, 0.01});
  CHECK(a.parts[1].name == "left");
  CHECK(a.parts[2].name == "right");
  CHECK(a.parts[1].shape == a.parts[2].shape);
  check_box(box_of(a, 1), {0.09, 0, 0}, {0.1, 0.01, 0.01});
  check_box(box_of(a, 2), {0, 0, 0.05}, {0.01, 0.01, 0.06});
  CHECK(volume(*a.shapes[a.parts[1].shape]) == Approx(1e-6 / 6));
}

TEST_CASE("STEP: a mapped item and a second representation may hold the triangles", "[step]") {
  StepText mapped(kSchema);
  const int frame = mapped.origin();
  const int source = mapped.representation({frame, solid(mapped)}, kShown);
  const int map = mapped.add("REPRESENTATION_MAP(" + r(frame) + "," + r(source) + ")");
  const int at = mapped.frame(mapped.point(0, 7, 0), mapped.direction(0, 0, 1), mapped.direction(1, 0, 0));
  mapped.shape(mapped.product("tip"), {mapped.origin(), mapped.add("MAPPED_ITEM(''," + r(map) + "," + r(at) + ")")});
  const Assembly a = read_step_text(mapped.text());
  REQUIRE(a.parts.size() == 1);
  check_box(box_of(a, 0), {0, 0.007, 0}, {0.01, 0.017, 0.01});

  StepText second(kSchema);
  const int tip = second.product("tip");
  second.shape(tip, {second.origin()});
  second.shape(tip, {solid(second)}, "TESSELLATED_SHAPE_REPRESENTATION_WITH_ACCURACY_PARAMETERS");
  // The fourth value of this kind of representation.
  std::string text = second.text();
  const auto end = text.find(");", text.find("ACCURACY_PARAMETERS("));
  text.insert(end, ",(TESSELLATION_ACCURACY_PARAMETER_ITEM(0.1))");
  const Assembly b = read_step_text(text);
  REQUIRE(b.parts.size() == 1);
  check_tip(b);

  StepText several(kSchema);
  const int product = several.product("tip"), item = solid(several);
  const int shown = several.shape(product, {item});
  text = several.text();
  const std::string plain = r(shown) + "=SHAPE_REPRESENTATION('',(" + r(item) + "),";
  const auto begin = text.find(plain);
  REQUIRE(begin != std::string::npos);
  const auto close = text.find(");", begin);
  const std::string context = text.substr(begin + plain.size(), close - begin - plain.size());
  text.replace(begin, close + 2 - begin,
               r(shown) + "=(REPRESENTATION('',(" + r(item) + ")," + context +
                   ")SHAPE_REPRESENTATION()TESSELLATED_SHAPE_REPRESENTATION());");
  const Assembly c = read_step_text(text);
  REQUIRE(c.parts.size() == 1);
  check_tip(c);
}

TEST_CASE("STEP: a shape that is shown exactly and by triangles is read once, exactly", "[step]") {
  // In one representation and in two.
  for (const bool one : {true, false}) {
    for (const bool linked : {true, false}) {
      INFO((one ? "one, " : "two, ") << (linked ? "linked" : "of its own"));
      StepText s(kSchema);
      const int plate = s.product("plate"), block = s.block(), tip = solid(s, "5.", linked ? r(block) : "$");
      s.shape(plate, one ? std::vector{s.origin(), block, tip} : std::vector{s.origin(), block});
      if (!one) s.shape(plate, {tip}, kShown);
      const Assembly a = read_step_text(s.text());
      CHECK(a.notes.empty());
      REQUIRE(a.parts.size() == (one || linked ? 1u : 2u));
      check_box(box_of(a, 0), Vec3::Zero(), {0.04, 0.03, 0.01});
      double all = 0;
      for (const auto& shape : a.shapes) all += volume(*shape);
      CHECK(all == Approx(12e-6 + (linked ? 0 : 125e-9 / 6)));
    }
  }
  // The exact shape is of no product.
  StepText s(kSchema);
  const int block = s.block();
  const int item = solid(s, "10.", r(block));
  check_tip(read_step_text(with(s, item).text()));
}

TEST_CASE("STEP: a tessellated part has its color", "[step]") {
  StepText s(kSchema);
  const int item = solid(s);
  const int fill = s.add("FILL_AREA_STYLE('',(" +
                         r(s.add("FILL_AREA_STYLE_COLOUR(''," + r(s.add("COLOUR_RGB('',1.,0.,0.)")) + ")")) + "))");
  const int side = s.add("SURFACE_SIDE_STYLE('',(" + r(s.add("SURFACE_STYLE_FILL_AREA(" + r(fill) + ")")) + "))");
  const int style =
      s.add("PRESENTATION_STYLE_ASSIGNMENT((" + r(s.add("SURFACE_STYLE_USAGE(.BOTH.," + r(side) + ")")) + "))");
  s.representation({s.add("STYLED_ITEM('',(" + r(style) + ")," + r(item) + ")")},
                   "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION");
  const Assembly a = read_step_text(with(s, item).text());
  REQUIRE(a.parts.size() == 1);
  check_tip(a);
  REQUIRE(a.parts[0].color);
  for (std::size_t k = 0; k < 4; ++k) CHECK((*a.parts[0].color)[k] == Approx(k % 3 == 0 ? 1 : 0).margin(1e-6));
}

TEST_CASE("STEP: tessellated shapes of other kinds are told or refused by name; lines are left out", "[step]") {
  StepText s(kSchema);
  const int points = corners(s);
  s.add("TESSELLATED_CURVE_SET(''," + r(points) + ",((1,2,3)))");
  const std::pair<const char*, std::string> others[] = {
      {"CUBIC_BEZIER_TRIANGULATED_FACE", "CUBIC_BEZIER_TRIANGULATED_FACE(''," + r(points) + ",4,(),$,(),())"},
      {"REPOSITIONED_TESSELLATED_ITEM", "(GEOMETRIC_REPRESENTATION_ITEM()REPOSITIONED_TESSELLATED_ITEM(" +
                                            r(s.origin()) + ")REPRESENTATION_ITEM('')TESSELLATED_GEOMETRIC_SET((" +
                                            r(points) + "))TESSELLATED_ITEM())"},
      {"TESSELLATED_ITEM of several kinds",
       "(GEOMETRIC_REPRESENTATION_ITEM()REPRESENTATION_ITEM('')TESSELLATED_ANNOTATION_OCCURRENCE()"
       "TESSELLATED_GEOMETRIC_SET((" +
           r(points) + "))TESSELLATED_ITEM())"}};
  for (const auto& [kind, text] : others) {
    INFO(kind);
    StepText one = s;
    const int item = one.add(text);
    CHECK_THAT(refusal_of(with(one, item).text()), Catch::Contains(r(item) + " is a " + kind + ", which is not read"));
    one.shape(one.product("plate"), {one.origin(), one.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
    const Assembly a = read_step_text(with(one, item).text());
    REQUIRE(a.parts.size() == 1);
    CHECK(has_note(a, r(item) + " is a " + kind + ": not read, so left out"));
  }
  for (const char* line :
       {"TESSELLATED_CURVE_SET('',POINTS,((1,2,3)))", "TESSELLATED_POINT_SET('',POINTS,(1,2,3))",
        "TESSELLATED_EDGE('',POINTS,$,(1,2,3))", "TESSELLATED_CONNECTING_EDGE('',POINTS,$,(1,2,3),$,$,.T.,(1),(1),(1))",
        "TESSELLATED_WIRE('',(),$)", "TESSELLATED_VERTEX('',POINTS,$,1)"}) {
    INFO(line);
    StepText lines = s;
    const int tip = solid(lines);
    std::string text = line;
    if (const auto at = text.find("POINTS"); at != std::string::npos) text.replace(at, 6, r(points));
    lines.shape(lines.product("tip"), {lines.add(text), tip}, kShown);
    const Assembly a = read_step_text(lines.text());
    REQUIRE(a.parts.size() == 1);
    CHECK(a.notes.empty());
    check_tip(a);
  }
  // Named by no product at all.
  StepText lost = s;
  lost.shape(lost.product("plate"), {lost.origin(), lost.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int item = solid(lost);
  lost.representation({item}, kShown);
  CHECK(has_note(read_step_text(lost.text()), "the triangles of " + r(item) + ": of no product"));
  // Alone, and named by a property, which is not the shape.
  StepText alone = s;
  const int product = alone.product("plate"), bare = solid(alone);
  alone.shape(product, {alone.origin()});
  const int shown = alone.representation({bare}, kShown);
  const int property = alone.add("PROPERTY_DEFINITION('tessellated',''," + r(product) + ")");
  alone.add("PROPERTY_DEFINITION_REPRESENTATION(" + r(property) + "," + r(shown) + ")");
  CHECK_THAT(refusal_of(alone.text()), Catch::Contains("the triangles of " + r(bare) + " are of no product"));
}

TEST_CASE("STEP: texts and comments with signs of the language in them change nothing", "[step]") {
  StepText s(kSchema);
  const int item = solid(s);
  s.shape(s.product("a;#1=TESSELLATED_SOLID(''x"), {s.origin(), item}, kShown);
  std::string text = s.text();
  const auto at = text.find("TESSELLATED_SOLID('',(#");
  REQUIRE(at != std::string::npos);
  text.insert(at + 18, "/* ;'( */");
  text.insert(text.find(r(item) + "=T") + r(item).size(), " /* = */ ");
  const Assembly a = read_step_text(text);
  REQUIRE(a.parts.size() == 1);
  check_tip(a);
}

TEST_CASE("STEP: damaged triangles refuse the file with the entity's number", "[step]") {
  StepText whole(kSchema);
  const int item = solid(whole);
  const std::string text = with(whole, item).text();
  const std::pair<const char*, const char*> damages[] = {{"((1,3,2)", "((1,3,5)"},
                                                         {"((1,3,2)", "((0,3,2)"},
                                                         {"((1,3,2)", "((1,3)"},
                                                         {"((1,3,2)", "((1,3,x)"},
                                                         {"(10.,0.,0.)", "(nan,0.,0.)"},
                                                         {"(10.,0.,0.)", "(1E999,0.,0.)"},
                                                         {"(10.,0.,0.)", "(10.,0.)"},
                                                         {"(10.,0.,0.)", "(10.,0.,0.,0.)"},
                                                         {"COORDINATES_LIST(", "CARTESIAN_POINT("},
                                                         {"TRIANGULATED_FACE(", "CARTESIAN_POINT("}};
  for (const auto& [from, to] : damages) {
    INFO(from << " becomes " << to);
    std::string bad = text;
    bad.replace(bad.find(from), std::string(from).size(), to);
    CHECK_THAT(refusal_of(bad), Catch::Contains("a.step: damaged: ") && Catch::Contains("#"));
  }
}
