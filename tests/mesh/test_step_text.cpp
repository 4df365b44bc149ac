// What CAD systems write into STEP files besides exact shapes: a test for each row of docs/formats.md that test_step
// has not.
#include <array>
#include <filesystem>

#include "mesh/step_blocks.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// A block, placed by a MAPPED_ITEM or by a relationship of representations.
StepText placed(bool mapped, double x_axis, double scale) {
  StepText s;
  if (mapped) {
    const int plate = s.product("plate");
    const int frame = s.origin();
    const int source = s.representation({s.block(), frame}, "FACETED_BREP_SHAPE_REPRESENTATION");
    const int map = s.add("REPRESENTATION_MAP(" + r(frame) + "," + r(source) + ")");
    const int item = s.add("MAPPED_ITEM(''," + r(map) + "," + r(s.placing(x_axis, scale)) + ")");
    s.shape(plate, {s.origin(), item});
    return s;
  }
  const int top = s.product("all"), plate = s.product("plate");
  const int all = s.shape(top, {s.origin()});
  const int one = s.shape(plate, {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int use = s.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('1','plate',''," + r(top) + "," + r(plate) + ",$)");
  const int self = s.add("PRODUCT_DEFINITION_SHAPE('',''," + r(use) + ")");
  const int relation = s.add("(REPRESENTATION_RELATIONSHIP('',''," + r(one) + "," + r(all) +
                             ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" + r(s.placing(x_axis, scale)) +
                             ")SHAPE_REPRESENTATION_RELATIONSHIP())");
  s.add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + r(relation) + "," + r(self) + ")");
  return s;
}

/// A plate with a style of its first point that is `style` of a color.
StepText styled(const std::string& style) {
  StepText s;
  const int plate = s.product("plate"), block = s.block();
  s.shape(plate, {s.origin(), block}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int color = s.add("COLOUR_RGB('',0.6,0.4,0.4)");
  const int marker = s.add("PRE_DEFINED_POINT_MARKER_SYMBOL('plus')");
  std::string entity = style;
  for (const auto& [from, to] : {std::pair<std::string, int>{"COLOR", color}, {"MARKER", marker}, {"BLOCK", block}})
    if (const auto at = entity.find(from); at != std::string::npos) entity.replace(at, from.size(), r(to));
  const int shown = s.add("PRESENTATION_STYLE_ASSIGNMENT((" + r(s.add(entity)) + "))");
  const int item = s.add("STYLED_ITEM('',(" + r(shown) + ")," + r(block) + ")");
  s.representation({item}, "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION");
  return s;
}

/// A block that `more` belongs to.
StepText block_with(const std::string& more) {
  StepText s;
  const int plate = s.product("plate"), block = s.block();
  s.shape(plate, {s.origin(), block}, "FACETED_BREP_SHAPE_REPRESENTATION");
  std::string entity = more;
  if (const auto at = entity.find("BLOCK"); at != std::string::npos) entity.replace(at, 5, r(block));
  s.add(entity);
  return s;
}

/// A block placed by a mapped item whose target is an operator; each axis is none, or a direction along x, y or z.
StepText turned(const std::array<std::array<double, 3>, 3>& axes) {
  StepText s;
  std::array<int, 3> ids{};
  for (std::size_t k = 0; k < 3; ++k)
    if (axes[k] != std::array<double, 3>{}) ids[k] = s.direction(axes[k][0], axes[k][1], axes[k][2]);
  const int plate = s.product("plate"), frame = s.origin();
  const int source = s.representation({s.block(), frame}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int map = s.add("REPRESENTATION_MAP(" + r(frame) + "," + r(source) + ")");
  const int target = s.turning(ids[0], ids[1], ids[2]);
  s.shape(plate, {s.origin(), s.add("MAPPED_ITEM(''," + r(map) + "," + r(target) + ")")});
  return s;
}

}  // namespace

TEST_CASE("STEP: operators that move are read, those that scale or mirror are refused by name", "[step]") {
  for (const bool mapped : {true, false}) {
    INFO((mapped ? "mapped item" : "relationship"));
    const Assembly a = read(placed(mapped, 1, 1));
    REQUIRE(a.parts.size() == 1);
    check_block(a, 0, 5);
    CHECK_THAT(refusal(placed(mapped, 1, 2)),
               Catch::Contains("CARTESIAN_TRANSFORMATION_OPERATOR_3D") && Catch::Contains("scales"));
    CHECK_THAT(refusal(placed(mapped, -1, 1)),
               Catch::Contains("CARTESIAN_TRANSFORMATION_OPERATOR_3D") && Catch::Contains("mirrors"));
  }
}

TEST_CASE("STEP: each product has its own unit of length", "[step]") {
  StepText s;
  s.shape(s.product("small"), {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  s.set_unit("$");
  s.shape(s.product("large"), {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const Assembly a = read(s);
  REQUIRE(a.parts.size() == 2);
  const std::size_t small = a.parts[0].name == "small" ? 0 : 1;
  check_block(a, small);
  check_box(box_of(a, 1 - small), {0, 0, 0}, {40, 30, 10});
}

TEST_CASE("STEP: how something is drawn refuses no file", "[step]") {
  for (const char* style : {"POINT_STYLE('',MARKER,POSITIVE_LENGTH_MEASURE(3.),COLOR)",
                            "CURVE_STYLE('',$,POSITIVE_LENGTH_MEASURE(0.1),COLOR)",
                            "CURVE_STYLE('',BLOCK,POSITIVE_LENGTH_MEASURE(0.1),COLOR)", "SURFACE_STYLE_USAGE(.BOTH.,$)",
                            "SURFACE_STYLE_USAGE(.BOTH.,BLOCK)", "FILL_AREA_STYLE_COLOUR('',BLOCK)"}) {
    INFO(style);
    const Assembly a = read(styled(style));
    REQUIRE(a.parts.size() == 1);
    check_block(a, 0);
    // Points and curves have no color that a part could have.
    const std::string text = style;
    CHECK(has_note(a, "colors") == (text.find("SURFACE") == 0 || text.find("FILL") == 0));
  }
}

TEST_CASE("STEP: missing references in shapes refuse the file", "[step]") {
  StepText s;
  const int plate = s.product("plate");
  s.shape(plate, {s.origin(), s.add("FACETED_BREP(''," + r(s.origin()) + ")")}, "FACETED_BREP_SHAPE_REPRESENTATION");
  CHECK_THAT(refusal(s), Catch::Contains("damaged: OpenCASCADE finds impossible entities"));
}

TEST_CASE("STEP: axes that an operator leaves out are what the standard says, or it is refused", "[step]") {
  const std::array<double, 3> none{}, x{1, 0, 0}, y{0, 1, 0}, minus_x{-1, 0, 0}, minus_y{0, -1, 0}, minus_z{0, 0, -1};
  check_block(read(turned({none, none, none})), 0);
  check_block(read(turned({x, none, none})), 0);
  // A quarter turn about z.
  check_box(box_of(read(turned({y, minus_x, none})), 0), {-0.03, 0, 0}, {0, 0.04, 0.01});
  // z is up where no axis says otherwise, and y where it was: each of these is left-handed.
  for (const auto& axes : {std::array{y, x, none}, std::array{minus_x, none, none}, std::array{none, minus_y, none},
                           std::array{none, none, minus_z}})
    CHECK_THAT(refusal(turned(axes)), Catch::Contains("mirrors"));
  CHECK_THAT(refusal(turned({y, none, none})), Catch::Contains("span no space"));
}

TEST_CASE("STEP: references to nothing refuse a file only where a shape or place is made of them", "[step]") {
  for (const char* more :
       {"DIMENSIONAL_SIZE(#9999,'diameter')", "FLATNESS_TOLERANCE('','',#9999,#9998)", "SHAPE_ASPECT('','',#9999,.T.)",
        "DRAUGHTING_MODEL('',(),#9999)", "CAMERA_MODEL_D3('',#9999,#9998)", "PROPERTY_DEFINITION('','',#9999)",
        "PROPERTY_DEFINITION_REPRESENTATION(#9999,#9998)", "REPRESENTATION('m',(#9999),#9998)", "INVISIBILITY((#9999))",
        "MATERIAL_DESIGNATION('',(#9999))", "PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#9999))", "APPROVAL(#9999,'')",
        "OVER_RIDING_STYLED_ITEM('',(#9999),BLOCK,#9998)", "DIRECTION('',(0.,0.,0.))", "LINE('',#9999,#9998)",
        "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#9999),#9998)"}) {
    INFO(more);
    Assembly a;
    REQUIRE_NOTHROW(a = read(block_with(more)));
    REQUIRE(a.parts.size() == 1);
    check_block(a, 0);
  }
  std::string text = block_with("DIRECTION('',(1.,0.,0.))").text();
  const std::size_t at = text.find("FACE_OUTER_BOUND('',#") + 21;
  text.replace(at, text.find(',', at) - at, "9999");
  CHECK_THAT(test::refusal([&] { read_step_text(text); }), Catch::Contains("wrong or missing references (#"));
}

TEST_CASE("STEP: solids by operations and instances without a place are told, never dropped in silence", "[step]") {
  StepText both;
  const int plate = both.product("plate");
  const int pin = both.add("BLOCK(''," + r(both.origin()) + ",400.,3.,3.)");
  both.shape(plate, {both.origin(), both.block(), pin});
  const Assembly a = read(both);
  check_block(a, 0);
  CHECK(has_note(a, r(pin) + " is a BLOCK: not read, so left out"));

  StepText alone;
  const int sphere = alone.add("SPHERE('',5.," + r(alone.point(0, 0, 0)) + ")");
  alone.shape(alone.product("ball"), {alone.origin(), sphere});
  CHECK_THAT(refusal(alone), Catch::Contains(r(sphere) + " is a SPHERE, which is not read"));
  StepText csg;
  const int tree = csg.add("CSG_SOLID(''," + r(csg.add("BLOCK(''," + r(csg.origin()) + ",4.,3.,3.)")) + ")");
  csg.shape(csg.product("tree"), {csg.origin(), tree}, "CSG_SHAPE_REPRESENTATION");
  CHECK_THAT(refusal(csg), Catch::Contains(r(tree) + " is a CSG_SOLID, which is not read"));

  StepText loose;
  const int top = loose.product("all"), part = loose.product("plate"), frame = loose.origin();
  const int all = loose.shape(top, {frame});
  const int one = loose.shape(part, {frame, loose.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  loose.instance(part, one, frame, top, all, frame, "placed");
  const int use = loose.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('2','loose',''," + r(top) + "," + r(part) + ",$)");
  const Assembly b = read(loose);
  REQUIRE(b.parts.size() == 1);
  CHECK(has_note(b, "the instance " + r(use) + ": without a place"));
}

TEST_CASE("STEP: marks, comments, sections and schemas around the entities", "[step]") {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = block_with("DIRECTION('',(1.,0.,0.))").text();
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
    return text;
  };
  const auto check = [](const std::string& text) {
    INFO(text.substr(0, 300));
    Assembly a;
    REQUIRE_NOTHROW(a = read_step_text(text));
    check_block(a, 0);
  };
  check("\xef\xbb\xbf" + changed("\n", "\r\n"));
  check("/* by hand */\n" + changed("=", "/* ; ' #1=X(); */ = /* **/"));
  check(changed("END-ISO-10303-21;", "END-ISO-10303-21 ;"));
  check(changed("AUTOMOTIVE_DESIGN", "SHAPE_APPEARANCE_LAYERS_MIM','AUTOMOTIVE_DESIGN"));
  check(changed("DATA;", "DATA('one',('AUTOMOTIVE_DESIGN'));"));
  check(changed("#9=", "ENDSEC;\nDATA ('two',('AUTOMOTIVE_DESIGN'));\n#9="));
  check(changed("DATA;", "ANCHOR;\n<plate>=#1;\nENDSEC;\nDATA;"));
  CHECK_THAT(test::refusal([&] { read_step_text(changed("DATA;", "REFERENCE;\n#1=<a.stp#b>;\nENDSEC;\nDATA;")); }),
             Catch::Contains("entities of other files"));
  std::string empty = changed("DATA;", "DATA;");
  empty.erase(empty.find("DATA;") + 6, empty.rfind("ENDSEC;") - empty.find("DATA;") - 6);
  CHECK_THAT(test::refusal([&] { read_step_text(empty); }), Catch::Contains("no entities"));
}

TEST_CASE("STEP: parts in other files are read from the folder, told when missing, refused from elsewhere", "[step]") {
  // A block, and 100 mm beside it the product of a file.
  const auto naming = [](const std::string& file) {
    StepText s;
    const int top = s.product("all"), part = s.product("child"), frame = s.origin();
    const int aside = s.frame(s.point(100, 0, 0), s.direction(0, 0, 1), s.direction(1, 0, 0));
    const int all = s.shape(top, {frame, s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
    const int one = s.shape(part, {frame});
    s.instance(part, one, frame, top, all, aside, "child");
    const int document = s.add("DOCUMENT_FILE('" + file + "','',$," + r(s.add("DOCUMENT_TYPE('')")) + ",'',$)");
    s.add("DOCUMENT_REPRESENTATION_TYPE('digital'," + r(document) + ")");
    const int named = s.add("APPLIED_DOCUMENT_REFERENCE(" + r(document) + ",'',(" + r(part) + "))");
    s.add("ROLE_ASSOCIATION(" + r(s.add("OBJECT_ROLE('mandatory','')")) + "," + r(named) + ")");
    const int role = s.add("IDENTIFICATION_ROLE('external document id and location',$)");
    const int source = s.add("EXTERNAL_SOURCE(IDENTIFIER(''))");
    s.add("APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT('" + file + "'," + r(role) + "," + r(source) + ",(" +
          r(document) + "))");
    return s.text();
  };
  const TempFolder folder, elsewhere;
  folder.write("child.stp", block_with("DIRECTION('',(1.,0.,0.))").text());
  elsewhere.write("child.stp", block_with("DIRECTION('',(1.,0.,0.))").text());
  folder.write("a.step", naming("child.stp"));
  const Assembly both = read_assembly(folder / "a.step");
  REQUIRE(both.parts.size() == 2);
  const std::size_t child = both.parts[0].name == "child" ? 0 : 1;
  check_block(both, child, 100);
  check_block(both, 1 - child);
  // The folder that is named from here counts, not the one that the program runs in.
  const std::string from_here = std::filesystem::relative(folder / "a.step").string();
  for (const std::string& relative : {from_here, "./" + from_here}) {
    INFO(relative);
    CHECK(read_assembly(relative).parts.size() == 2);
  }
  // What is left out of it is told like what is left out of this one.
  StepText child_text;
  const int pin = child_text.add("BLOCK(''," + r(child_text.origin()) + ",400.,3.,3.)");
  const int hose = child_text.add("SWEPT_DISK_SOLID(''," + r(pin) + ",2.,$,0.,1.)");
  child_text.shape(child_text.product("child"), {child_text.origin(), child_text.block(), pin, hose});
  folder.write("child.stp", child_text.text());
  const Assembly less = read_assembly(folder / "a.step");
  CHECK(less.parts.size() == 2);
  CHECK(has_note(less, "child.stp: " + r(pin) + " is a BLOCK"));
  CHECK(has_note(less, "child.stp: " + r(hose) + " is a SWEPT_DISK_SOLID"));
  // OpenCASCADE reads it before anyone can tell its places and units anew.
  StepText thou;
  int unit = thou.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.))");
  for (const char* size : {"2.54", "0.001"}) {
    const int measure = thou.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + std::string(size) + ")," + r(unit) + ")");
    const int exponents = thou.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)");
    unit = thou.add("(CONVERSION_BASED_UNIT('own'," + r(measure) + ")LENGTH_UNIT()NAMED_UNIT(" + r(exponents) + "))");
  }
  thou.shape(thou.product("child"), {thou.origin(), thou.block()});
  folder.write("child.stp", thou.text());
  CHECK_THAT(test::refusal(folder / "a.step"),
             Catch::Contains("child.stp: " + r(unit) + " is a CONVERSION_BASED_UNIT") &&
                 Catch::Contains("in the file that is opened only"));
  folder.write("a.step", naming("other.stp"));
  const Assembly one = read_assembly(folder / "a.step");
  CHECK(one.parts.size() == 1);
  CHECK(has_note(one, "the file \"other.stp\": named in this one and missing"));
  folder.write("a.step", naming(elsewhere / "child.stp"));
  CHECK_THAT(test::refusal(folder / "a.step"), Catch::Contains("not a regular file in its folder or below"));
  const std::string up = "../" + std::filesystem::path(elsewhere / "child.stp").parent_path().filename().string();
  folder.write("a.step", naming(up + "/child.stp"));
  CHECK_THAT(test::refusal(folder / "a.step"), Catch::Contains("not a regular file in its folder or below"));
}

TEST_CASE("STEP: construction lines beside a shape refuse no file, whole or damaged", "[step]") {
  const auto with = [](const std::string& item, const std::string& relation) {
    StepText s;
    const int plate = s.product("plate"), block = s.block();
    const int shape = s.shape(plate, {s.origin(), block}, "FACETED_BREP_SHAPE_REPRESENTATION");
    const int lines =
        s.representation({item.empty() ? s.point(1, 2, 3) : 999999}, "CONSTRUCTIVE_GEOMETRY_REPRESENTATION");
    std::string ends = relation;
    for (const auto& [from, to] : {std::pair{"SHAPE", shape}, {"LINES", lines}, {"BLOCK", block}})
      if (const auto at = ends.find(from); at != std::string::npos) ends.replace(at, 5, r(to));
    s.add("CONSTRUCTIVE_GEOMETRY_REPRESENTATION_RELATIONSHIP('',$," + ends + ")");
    return s;
  };
  for (const char* relation :
       {"SHAPE,LINES", "LINES,SHAPE", "SHAPE,#999999", "#999999,LINES", "SHAPE,$", "$,$", "SHAPE,BLOCK"})
    for (const char* item : {"", "missing"}) {
      INFO(relation << ' ' << item);
      const Assembly a = read(with(item, relation));
      REQUIRE(a.parts.size() == 1);
      check_block(a, 0);
    }
}

TEST_CASE("STEP: products that have one shape between them are named", "[step]") {
  StepText flat;
  const int left = flat.product("left"), right = flat.product("right");
  const auto shown_by = [](StepText& s, int product, int shape) {
    s.add("SHAPE_DEFINITION_REPRESENTATION(" + r(s.add("PRODUCT_DEFINITION_SHAPE('',''," + r(product) + ")")) + "," +
          r(shape) + ")");
  };
  const int shape = flat.shape(left, {flat.origin(), flat.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  CHECK(read(flat).notes.empty());
  shown_by(flat, right, shape);
  const Assembly once = read(flat);
  CHECK(once.parts.size() == 1);
  CHECK(has_note(once, "the products \"left\", \"right\" of " + r(shape) + ", which is read once"));

  // One of them in an assembly, then both.
  StepText s;
  const int top = s.product("all"), a = s.product("left"), b = s.product("right"), o = s.origin();
  const int one = s.shape(a, {o, s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  shown_by(s, b, one);
  const int here = s.origin(), there = s.frame(s.point(100, 0, 0), s.direction(0, 0, 1), s.direction(1, 0, 0));
  const int all = s.shape(top, {here, there});
  s.instance(b, one, o, top, all, there, "R");
  const Assembly placed = read(s);
  REQUIRE(placed.parts.size() == 1);
  check_block(placed, 0, 100);
  CHECK(has_note(placed, "only where an assembly places it"));
  s.instance(a, one, o, top, all, here, "L");
  const Assembly both = read(s);
  REQUIRE(both.parts.size() == 2);
  const std::size_t l = both.parts[0].name == "L" ? 0 : 1;
  check_block(both, l);
  check_block(both, 1 - l, 100);
  CHECK(has_note(both, "which is read at each place"));
}

TEST_CASE("STEP: text in UTF-16 is refused as such", "[step]") {
  std::string wide = "\xff\xfe";
  for (const char c : StepText().text()) (wide += c) += '\0';
  CHECK_THAT(test::refusal([&] { read_step_text(wide); }), Catch::Contains("is in UTF-16"));
}
