// What CAD systems write into STEP files besides exact shapes: a test for each row of docs/formats.md that test_step
// has not.
#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "mesh/step_text.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

Assembly read(const StepText& step) {
  const TempFolder folder;
  folder.write("a.step", step.text());
  return read_assembly(folder / "a.step");
}

std::string refusal(const StepText& step) {
  return test::refusal([&] { read(step); });
}

void check_block(const Assembly& a, std::size_t part, double x_mm = 0) {
  check_box(box_of(a, part), {1e-3 * x_mm, 0, 0}, {0.04 + 1e-3 * x_mm, 0.03, 0.01});
  CHECK(report(*a.shapes[a.parts[part].shape]).inverted_shells == 0);
}

std::string r(int id) {
  return StepText::ref(id);
}

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
  }
}

TEST_CASE("STEP: missing references in shapes refuse the file", "[step]") {
  StepText s;
  const int plate = s.product("plate");
  s.shape(plate, {s.origin(), s.add("FACETED_BREP(''," + r(s.origin()) + ")")}, "FACETED_BREP_SHAPE_REPRESENTATION");
  CHECK_THAT(refusal(s), Catch::Contains("damaged: OpenCASCADE finds entities that cannot be"));
}
