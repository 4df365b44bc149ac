// What STEP files say of places, and what they hold beside shapes: a test for each row of docs/formats.md that is of
// what is looked through before OpenCASCADE makes shapes.
#include <array>
#include <regex>

#include "mesh/step_blocks.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

const char* const kAp242 = "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }";

int point_2d(StepText& s, const std::string& x) {
  return s.add("CARTESIAN_POINT('',(" + x + ",0.))");
}

int frame_at(StepText& s, double x) {
  return s.frame(s.point(x, 0, 0), s.direction(0, 0, 1), s.direction(1, 0, 0));
}

using Make = int (*)(StepText&);

struct Kind {
  const char* name;
  Make make;
};

// Each would place a part 5 mm in x if it could.
const Kind kOtherPlaces[] = {
    {"AXIS1_PLACEMENT", [](StepText& s) { return s.add("AXIS1_PLACEMENT(''," + r(s.point(5, 0, 0)) + ",$)"); }},
    {"AXIS2_PLACEMENT_2D", [](StepText& s) { return s.add("AXIS2_PLACEMENT_2D(''," + r(point_2d(s, "5.")) + ",$)"); }},
    {"CARTESIAN_POINT", [](StepText& s) { return s.point(5, 0, 0); }},
    {"CARTESIAN_TRANSFORMATION_OPERATOR_2D",
     [](StepText& s) {
       return s.add("CARTESIAN_TRANSFORMATION_OPERATOR_2D('','','',$,$," + r(point_2d(s, "5.")) + ",1.)");
     }},
    {"CARTESIAN_TRANSFORMATION_OPERATOR", [](StepText& s) {
       return s.add("CARTESIAN_TRANSFORMATION_OPERATOR('','','',$,$," + r(s.point(5, 0, 0)) + ",1.)");
     }}};
const Kind kOperators[] = {{"CARTESIAN_TRANSFORMATION_OPERATOR_3D", [](StepText& s) { return s.placing(1, 1); }},
                           {"CARTESIAN_TRANSFORMATION_OPERATOR_3D", [](StepText& s) { return s.placing(1, 2); }},
                           {"CARTESIAN_TRANSFORMATION_OPERATOR_3D", [](StepText& s) { return s.placing(-1, 1); }}};

/// An assembly of a block whose frame `from` comes to lie on `to`.
StepText assembly(Make from, Make to) {
  StepText s;
  const int top = s.product("all"), plate = s.product("plate"), first = from(s), second = to(s);
  const int all = s.shape(top, {s.origin()});
  const int one = s.shape(plate, {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  s.instance(plate, one, first, top, all, second, "plate");
  return s;
}

/// A block in a representation whose frame `from` a mapped item brings to lie on `to`.
StepText mapped(Make from, Make to) {
  StepText s;
  const int plate = s.product("plate"), frame = from(s);
  const int source = s.representation({s.block(), frame}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int map = s.add("REPRESENTATION_MAP(" + r(frame) + "," + r(source) + ")");
  s.shape(plate, {s.origin(), s.add("MAPPED_ITEM(''," + r(map) + "," + r(to(s)) + ")")});
  return s;
}

int origin(StepText& s) {
  return s.origin();
}

/// A block as the shape of a product, and what `more` adds to its file.
struct Plate {
  StepText s;
  int product, block, shape;
  explicit Plate(const std::string& schema = kAp242, const std::vector<Make>& items = {}) : s(schema) {
    product = s.product("plate");
    block = s.block();
    std::vector<int> all = {s.origin(), block};
    for (const Make item : items) all.push_back(item(s));
    shape = s.shape(product, all);
  }
  /// Adds entities; the last one's number.
  int add(const std::vector<std::string>& entities) {
    int last = 0;
    for (const std::string& e : entities)
      last = s.add(with_ids(e, {{"PLATE", product}, {"BLOCK", block}, {"SHAPE!", shape}, {"LAST", last}}));
    return last;
  }
};

void check_read(const StepText& s, std::size_t notes = 0) {
  Assembly a;
  REQUIRE_NOTHROW(a = read(s));
  REQUIRE(a.parts.size() == 1);
  check_block(a, 0);
  for (const std::string& note : a.notes) UNSCOPED_INFO(note);
  CHECK(a.notes.size() == notes);
}

/// Adds a frustum of the radii 10 and 5 mm, 5 mm high; `half`, the cone's angle, is 45 degrees in the file's unit.
void add_frustum(StepText& s, const std::string& half) {
  const int product = s.product("cone");
  const auto up = [&](double z, double axis) {
    return s.frame(s.point(0, 0, z), s.direction(0, 0, axis), s.direction(1, 0, 0));
  };
  const auto circle = [&](double z, double radius, int vertex) {
    const int c = s.add("CIRCLE(''," + r(up(z, 1)) + "," + std::to_string(radius) + ")");
    return s.add("EDGE_CURVE(''," + r(vertex) + "," + r(vertex) + "," + r(c) + ",.T.)");
  };
  const auto face = [&](const std::vector<std::pair<int, const char*>>& edges, const std::string& surface) {
    std::string loop;
    for (const auto& [edge, sense] : edges)
      loop += (loop.empty() ? "" : ",") + r(s.add("ORIENTED_EDGE('',*,*," + r(edge) + "," + sense + ")"));
    const int bound = s.add("FACE_OUTER_BOUND(''," + r(s.add("EDGE_LOOP('',(" + loop + "))")) + ",.T.)");
    return s.add("ADVANCED_FACE('',(" + r(bound) + ")," + r(s.add(surface)) + ",.T.)");
  };
  const int low = s.add("VERTEX_POINT(''," + r(s.point(10, 0, 0)) + ")"),
            high = s.add("VERTEX_POINT(''," + r(s.point(5, 0, 5)) + ")");
  const int wide = circle(0, 10, low), narrow = circle(5, 5, high);
  const int along = s.add("VECTOR(''," + r(s.direction(-1, 0, 1)) + ",1.)");
  const int line = s.add("LINE(''," + r(s.point(10, 0, 0)) + "," + r(along) + ")");
  const int seam = s.add("EDGE_CURVE(''," + r(low) + "," + r(high) + "," + r(line) + ",.T.)");
  const int side = face({{wide, ".T."}, {seam, ".T."}, {narrow, ".F."}, {seam, ".F."}},
                        "CONICAL_SURFACE(''," + r(up(5, -1)) + ",5.," + half + ")");
  const int bottom = face({{wide, ".F."}}, "PLANE(''," + r(up(0, -1)) + ")");
  const int top = face({{narrow, ".T."}}, "PLANE(''," + r(up(5, 1)) + ")");
  const int shell = s.add("CLOSED_SHELL('',(" + r(side) + "," + r(bottom) + "," + r(top) + "))");
  s.shape(product, {s.origin(), s.add("MANIFOLD_SOLID_BREP(''," + r(shell) + ")")},
          "ADVANCED_BREP_SHAPE_REPRESENTATION");
}

void check_frustum(const Assembly& a) {
  REQUIRE(a.parts.size() == 1);
  CHECK(report(*a.shapes[0]).closed);
  CHECK(volume(*a.shapes[0]) == Approx(1e-9 * M_PI * 5 / 3 * (100 + 50 + 25)).epsilon(2e-3));
}

}  // namespace

TEST_CASE("STEP: what is not a frame places no part", "[step]") {
  const Make at_5 = [](StepText& s) { return frame_at(s, 5); };
  const Make at_10 = [](StepText& s) { return frame_at(s, 10); };
  for (const auto& placed : {assembly, mapped}) {
    check_block(read(placed(origin, at_5)), 0, 5);
    check_block(read(placed(at_10, at_5)), 0, -5);
    for (const Kind& kind : kOtherPlaces) {
      INFO(kind.name);
      CHECK_THAT(refusal(placed(origin, kind.make)), Catch::Contains(std::string(" ") + kind.name + ", and a part is"));
    }
  }
  for (const Kind& kind : kOtherPlaces) CHECK_THAT(refusal(assembly(kind.make, at_5)), Catch::Contains(kind.name));
  // Operators do not belong into an ITEM_DEFINED_TRANSFORMATION; in a mapped item they move what has no frame of its
  // own.
  for (const Kind& kind : kOperators) {
    CHECK_THAT(refusal(assembly(origin, kind.make)), Catch::Contains(kind.name));
    CHECK_THAT(refusal(assembly(kind.make, origin)), Catch::Contains(kind.name));
  }
  check_block(read(mapped(origin, kOperators[0].make)), 0, 5);
  CHECK_THAT(refusal(mapped(at_10, kOperators[0].make)), Catch::Contains("whose frame #") && Catch::Contains("origin"));
}

TEST_CASE("STEP: a place without a transformation is refused, since its part would be read twice", "[step]") {
  StepText s;
  const int top = s.product("all"), plate = s.product("plate");
  const int all = s.shape(top, {s.origin()});
  const int one = s.shape(plate, {s.origin(), s.block()}, "FACETED_BREP_SHAPE_REPRESENTATION");
  const int use = s.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('1','plate',''," + r(top) + "," + r(plate) + ",$)");
  const int self = s.add("PRODUCT_DEFINITION_SHAPE('',''," + r(use) + ")");
  const int relation = s.add("SHAPE_REPRESENTATION_RELATIONSHIP('',''," + r(one) + "," + r(all) + ")");
  const int place = s.add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + r(relation) + "," + r(self) + ")");
  CHECK_THAT(refusal(s), Catch::Contains(r(place) + " is a CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") &&
                             Catch::Contains("no transformation"));
}

TEST_CASE("STEP: dimensions, datum targets, kinematics and products without shapes refuse no file", "[step]") {
  const std::string self = "PRODUCT_DEFINITION_SHAPE('','',PLATE)", aspect = "SHAPE_ASPECT('','',LAST,.T.)";
  for (const char* value :
       {"REAL_REPRESENTATION_ITEM('x',5.)", "BOOLEAN_REPRESENTATION_ITEM('',.T.)", "STRING_REPRESENTATION_ITEM('','x')",
        "RATIONAL_REPRESENTATION_ITEM('',1,2)", "COMPOUND_REPRESENTATION_ITEM('',LIST_REPRESENTATION_ITEM((BLOCK)))",
        "SOME_NEW_VALUE('x',5.)", "VALUE_RANGE('',(#99999))"}) {
    INFO(value);
    Plate plate;
    const int item = plate.add({value});
    const int shown = plate.s.representation({item, 99998}, "SHAPE_DIMENSION_REPRESENTATION");
    plate.add({self, aspect, "DIMENSIONAL_SIZE(LAST,'diameter')",
               "DIMENSIONAL_CHARACTERISTIC_REPRESENTATION(LAST," + r(shown) + ")"});
    check_read(plate.s);
  }
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"KINEMATIC_LINK_REPRESENTATION('',(#99999),#99998,$)",
            "KINEMATIC_LINK_REPRESENTATION_ASSOCIATION('','',LAST,SHAPE!)"},
           {"MAKE_FROM_USAGE_OPTION('','','',PLATE,#99999,1,'',#99998)"},
           {"SPECIFIED_HIGHER_USAGE_OCCURRENCE('','','',PLATE,PLATE,$,#99998,#99997)"},
           {"PRODUCT_DEFINITION('other','',#99999,#99998)"},
           {"PRODUCT_DEFINITION_RELATIONSHIP('','','',PLATE,#99999)"},
           {"PRODUCT_DEFINITION_SHAPE('','',#99999)"},
           {"REPRESENTATION_RELATIONSHIP('','',#99998,#99999)"},
           {"MECHANICAL_DESIGN_AND_DRAUGHTING_RELATIONSHIP('','',SHAPE!,#99999)"},
           {"SHAPE_REPRESENTATION('of no product',(#99999),#99998)"},
           {"SWEPT_DISK_SOLID('',BLOCK,2.,$,0.,1.)", "SHAPE_REPRESENTATION('of no product',(LAST),#99998)"},
           {self, "PLACED_DATUM_TARGET_FEATURE('','point',LAST,.T.,'1')", "PROPERTY_DEFINITION('','',LAST)",
            "SHAPE_DEFINITION_REPRESENTATION(LAST,#99998)"}}) {
    INFO(more.back());
    Plate plate;
    plate.add(more);
    check_read(plate.s);
  }
  Plate target;
  const int shown = target.s.representation({target.s.origin(), 99999}, "SHAPE_REPRESENTATION_WITH_PARAMETERS");
  target.add({self, "PLACED_DATUM_TARGET_FEATURE('','point',LAST,.T.,'1')", "PROPERTY_DEFINITION('','',LAST)",
              "SHAPE_DEFINITION_REPRESENTATION(LAST," + r(shown) + ")"});
  check_read(target.s);
}

TEST_CASE("STEP: a symbol of a drawing may be scaled and mirrored", "[step]") {
  for (const char* kind : {"DRAUGHTING_MODEL", "REPRESENTATION", "CONSTRUCTIVE_GEOMETRY_REPRESENTATION"}) {
    INFO(kind);
    Plate plate;
    StepText& s = plate.s;
    const int line = s.add("POLYLINE('',(" + r(s.point(0, 0, 0)) + "," + r(s.point(1, 1, 1)) + "))");
    const int frame = s.origin(), symbol = s.add("GEOMETRIC_CURVE_SET('',(" + r(line) + "))");
    const int map =
        s.add("REPRESENTATION_MAP(" + r(frame) + "," + r(s.representation({frame, symbol}, "REPRESENTATION")) + ")");
    s.representation({s.add("MAPPED_ITEM(''," + r(map) + "," + r(s.placing(-1, 2)) + ")")}, kind);
    check_read(s);
  }
  Plate plate;
  StepText& s = plate.s;
  const int a = s.representation({s.origin()}, "DRAUGHTING_MODEL"),
            b = s.representation({s.origin()}, "DRAUGHTING_MODEL");
  s.add("(REPRESENTATION_RELATIONSHIP('',''," + r(a) + "," + r(b) +
        ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" + r(s.placing(1, 2)) + "))");
  check_read(s);
}

TEST_CASE("STEP: a shape of a kind that is not known is told by number and kind", "[step]") {
  const Make disk = [](StepText& s) {
    const int line = s.add("POLYLINE('',(" + r(s.point(0, 0, 0)) + "," + r(s.point(0, 0, 30)) + "))");
    return s.add("SWEPT_DISK_SOLID(''," + r(line) + ",2.,$,0.,1.)");
  };
  const Assembly a = read(Plate(kAp242, {disk}).s);
  REQUIRE(a.parts.size() == 1);
  check_block(a, 0);
  CHECK(has_note(a, "is a SWEPT_DISK_SOLID"));

  StepText alone(kAp242);
  const int one = disk(alone);
  alone.shape(alone.product("hose"), {alone.origin(), one});
  CHECK_THAT(refusal(alone), Catch::Contains(r(one) + " is a SWEPT_DISK_SOLID, which is not read"));

  Plate cloud;
  const int points = cloud.add({"POINT_CLOUD_DATASET('',$,((0.,0.,0.)))"});
  const int scan = cloud.s.representation({points}, "SHAPE_REPRESENTATION");
  cloud.add({"SHAPE_REPRESENTATION_RELATIONSHIP('','',SHAPE!," + r(scan) + ")"});
  const Assembly b = read(cloud.s);
  REQUIRE(b.parts.size() == 1);
  check_block(b, 0);
  CHECK(has_note(b, r(points) + " is a POINT_CLOUD_DATASET"));

  // Of a drawing, as some programs write it among the items of a shape.
  check_read(Plate(kAp242, {[](StepText& t) {
                     return t.add(
                         "(ANNOTATION_CURVE_OCCURRENCE()ANNOTATION_OCCURRENCE()DRAUGHTING_ANNOTATION_OCCURRENCE()"
                         "GEOMETRIC_REPRESENTATION_ITEM()LEADER_CURVE()REPRESENTATION_ITEM('')STYLED_ITEM((),#1))");
                   }})
                 .s);

  // In the middle of a shape nothing can be left out.
  std::string text = Plate().s.text();
  const std::size_t plane = text.find("=PLANE(") + 1;
  text.replace(plane, text.find(';', plane) - plane, "NEW_SURFACE('')");
  CHECK_THAT(test::refusal([&] { read_step_text(text); }), Catch::Contains(" is a NEW_SURFACE, which is not read"));
  CHECK_THAT(refusal(Plate(kAp242, {[](StepText&) { return 99999; }}).s), Catch::Contains("missing references"));
}

TEST_CASE("STEP: shells and surfaces that are items by themselves are told", "[step]") {
  // The shell of a block of its own.
  const auto shell = [](StepText& s, const std::string& kind) {
    const std::string before = s.text();
    s.block();
    const std::string text = s.text();
    const std::size_t at = text.rfind("CLOSED_SHELL('',(") + 16;
    return s.add(kind + "(''," + text.substr(at, text.find(')', at) + 1 - at) + ")");
  };
  static const auto plane = [](StepText& s) { return s.add("PLANE(''," + r(s.origin()) + ")"); };
  for (const char* kind : {"CLOSED_SHELL", "OPEN_SHELL", "CONNECTED_FACE_SET", "RECTANGULAR_TRIMMED_SURFACE"}) {
    INFO(kind);
    const bool is_shell = std::string(kind) != "RECTANGULAR_TRIMMED_SURFACE";
    for (const bool beside : {true, false}) {
      StepText s;
      const int product = s.product("plate");
      const int item =
          is_shell ? shell(s, kind) : s.add(std::string(kind) + "(''," + r(plane(s)) + ",0.,40.,0.,30.,.T.,.T.)");
      std::vector<int> items = {s.origin(), item};
      if (beside) items.push_back(s.block());
      s.shape(product, items);
      if (!beside) {
        CHECK_THAT(refusal(s), Catch::Contains(r(item) + " is ") && Catch::Contains(kind));
        continue;
      }
      const Assembly a = read(s);
      REQUIRE(a.parts.size() == 1);
      check_block(a, 0);
      CHECK(has_note(a, kind));
    }
  }
}

TEST_CASE("STEP: bodies that the file hides are read and told, hidden curves not", "[step]") {
  const auto hide = [](StepText& s, int item, bool by_layer) {
    const int style = s.add("PRESENTATION_STYLE_ASSIGNMENT((NULL_STYLE(.NULL.)))");
    const int styled = s.add("STYLED_ITEM('',(" + r(style) + ")," + r(item) + ")");
    const int layer = s.add("PRESENTATION_LAYER_ASSIGNMENT('1',''," + std::string("(") + r(item) + "))");
    s.add("INVISIBILITY((" + r(by_layer ? layer : styled) + "))");
  };
  for (const bool by_layer : {true, false}) {
    Plate plate;
    hide(plate.s, plate.block, by_layer);
    check_read(plate.s, 1);
    CHECK(has_note(read(plate.s), r(plate.block) + ": hidden in the file"));
    Plate curve;
    const int points =
        curve.s.add("POLYLINE('',(" + r(curve.s.point(0, 0, 0)) + "," + r(curve.s.point(1, 1, 1)) + "))");
    hide(curve.s, points, by_layer);
    check_read(curve.s);
  }
}

TEST_CASE("STEP: curves without faces are not a part", "[step]") {
  const Make wire = [](StepText& s) {
    const int line = s.add("POLYLINE('',(" + r(s.point(0, 0, 0)) + "," + r(s.point(1, 1, 1)) + "))");
    return s.add("GEOMETRIC_CURVE_SET('',(" + r(line) + "))");
  };
  const Assembly a = read(Plate(kAp242, {wire}).s);
  REQUIRE(a.parts.size() == 1);
  check_block(a, 0);
  CHECK(has_note(a, "curves and points beside the faces"));
  StepText s;
  const int item = wire(s);
  s.shape(s.product("wire"), {s.origin(), item}, "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION");
  CHECK_THAT(refusal(s), Catch::Contains(r(item) + " is a GEOMETRIC_CURVE_SET"));
}

TEST_CASE("STEP: a shape without a unit of length is taken for millimeters, and told", "[step]") {
  const auto with_units = [](const std::string& units) {
    std::string text = Plate().s.text();
    const std::size_t at = text.find("GLOBAL_UNIT_ASSIGNED_CONTEXT("), end = text.find("))", at) + 2;
    const std::string all = text.substr(at, end - at);  // of length, angle, solid angle
    return text.replace(at, end - at,
                        units == "angle" ? "GLOBAL_UNIT_ASSIGNED_CONTEXT((" + all.substr(all.find(',') + 1) : units);
  };
  for (const std::string& units : {std::string("GLOBAL_UNIT_ASSIGNED_CONTEXT(())"), std::string("angle")}) {
    INFO(units);
    const Assembly a = read_step_text(with_units(units));
    REQUIRE(a.parts.size() == 1);
    check_block(a, 0);
    CHECK(has_note(a, "no unit of length"));
  }
  CHECK(!has_note(read(Plate().s), "no unit of length"));
  CHECK_THAT(test::refusal([&] { read_step_text(with_units("")); }),
             Catch::Contains("is a GEOMETRIC_REPRESENTATION_CONTEXT+REPRESENTATION_CONTEXT, which states no unit of "
                             "length: export the file with its unit"));
}

TEST_CASE("STEP: angles of cones are in the unit of the file", "[step]") {
  for (const std::string unit : {"radian", "degree", "minute of degrees"}) {
    INFO(unit);
    StepText s;
    if (unit != "radian") {
      const int none = s.add("DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.)");
      const auto so_many = [&](const std::string& size, int of) {
        const int measure = s.add("PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(" + size + ")," + r(of) + ")");
        return s.add("(CONVERSION_BASED_UNIT('own'," + r(measure) + ")NAMED_UNIT(" + r(none) + ")PLANE_ANGLE_UNIT())");
      };
      int angle = so_many("0.0174532925199433", s.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"));
      if (unit != "degree") angle = so_many("0.0166666666666667", angle);
      s.set_unit(".MILLI.", angle);
    }
    add_frustum(s, unit == "radian" ? std::to_string(M_PI / 4) : unit == "degree" ? "45." : "2700.");
    const Assembly a = read(s);
    check_frustum(a);
    CHECK(!has_note(a, "no unit of angle"));
  }
}

TEST_CASE("STEP: cones without a unit of angle are taken for degrees, and told", "[step]") {
  StepText s;
  add_frustum(s, "45.");
  std::string text = s.text();
  const std::size_t at = text.find("GLOBAL_UNIT_ASSIGNED_CONTEXT((");
  const std::size_t comma = text.find(',', at), end = text.find("))", at);
  text.erase(comma, end - comma);  // leaves the unit of length
  const Assembly a = read_step_text(text);
  check_frustum(a);
  CHECK(has_note(a, "no unit of angle"));
  CHECK(!has_note(a, "no unit of length"));
  // Nothing depends on the unit where there is no cone.
  text = Plate().s.text();
  const std::size_t plate = text.find("GLOBAL_UNIT_ASSIGNED_CONTEXT((");
  const std::size_t next = text.find(',', plate);
  text.erase(next, text.find("))", plate) - next);
  CHECK(!has_note(read_step_text(text), "no unit of angle"));
}

TEST_CASE("STEP: empty lists that no kind may have do no harm where no shape is made of them", "[step]") {
  for (const char* entity :
       {"EDGE_LOOP('',())", "POLY_LOOP('',())", "DIRECTION('',( ))", "CARTESIAN_POINT('',())",
        "SHELL_BASED_SURFACE_MODEL('',())", "FACE_BASED_SURFACE_MODEL('',\n( ))",
        "CURVE_BOUNDED_SURFACE('',#99,(),.T.)", "SURFACE_CURVE('',#99,(),.CURVE_3D.)",
        "B_SPLINE_CURVE_WITH_KNOTS('',3,(#99),.UNSPECIFIED.,.F.,.F.,(),(0.,1.),.UNSPECIFIED.)",
        "B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#99),()),.UNSPECIFIED.,.F.,.F.,.F.,(2),(2),(0.),(0.),.UNSPECIFIED.)",
        "(BOUNDED_CURVE()B_SPLINE_CURVE(1,(#99),.UNSPECIFIED.,.F.,.F.)B_SPLINE_CURVE_WITH_KNOTS((2),(0.),.UNSPECIFIED.)"
        "CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE(())REPRESENTATION_ITEM(''))",
        "INVISIBILITY(())", "APPLIED_APPROVAL_ASSIGNMENT(#99,())", "DERIVED_UNIT(())"}) {
    INFO(entity);
    Plate plate;
    plate.s.add(entity);
    Assembly a;
    REQUIRE_NOTHROW(a = read(plate.s));
    check_block(a, 0);
  }
  // Kinds that may have one, or in which one does no harm; a text that looks like one; a name before it.
  for (const char* entity :
       {"STYLED_ITEM('()',(),#99)", "PRESENTATION_LAYER_ASSIGNMENT('','(,())',())", "DIRECTION('(())',(0.,0.,1.))",
        "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))", "DRAUGHTING_MODEL('',(),#99)"}) {
    INFO(entity);
    Plate plate;
    plate.s.add(entity);
    Assembly a;
    REQUIRE_NOTHROW(a = read(plate.s));
    check_block(a, 0);
  }
}

TEST_CASE("STEP: an empty list of what a shape is made of is refused by number", "[step]") {
  const std::string whole = Plate().s.text();
  // Each list of coordinates and corners in turn.
  const std::regex line("#(\\d+)=(CARTESIAN_POINT|DIRECTION|POLY_LOOP)\\(''(,\\([^()]*\\))\\);");
  int emptied = 0;
  for (std::sregex_iterator at(whole.begin(), whole.end(), line), end; at != end; ++at, ++emptied) {
    const std::smatch& found = *at;
    std::string text = whole;
    text.replace(static_cast<std::size_t>(found.position(3)), static_cast<std::size_t>(found.length(3)), ",()");
    INFO(found.str());
    const std::string kind = found[2].str();
    CHECK_THAT(refusal([&] { read_step_text(text); }),
               Catch::Contains("#" + found[1].str() + " is a " + kind + " with an empty list, which is not read"));
  }
  CHECK(emptied == 29);  // 8 corners and the origin; 2 directions of it, 12 of faces; 6 loops

  // One that would be the whole shape.
  StepText s;
  const int product = s.product("shell"), empty = s.add("SHELL_BASED_SURFACE_MODEL('',())");
  s.shape(product, {s.origin(), empty});
  CHECK_THAT(refusal(s),
             Catch::Contains(r(empty) + " is a SHELL_BASED_SURFACE_MODEL with an empty list, which is not read"));
}
