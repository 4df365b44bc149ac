#pragma once

#include <string>
#include <vector>

namespace tegotae::test {

/// Writes small STEP files by hand, entity by entity: what a CAD system may write and OpenCASCADE does not.
class StepText {
 public:
  explicit StepText(std::string schema = "AUTOMOTIVE_DESIGN") : schema_(std::move(schema)) {
    const int application = add("APPLICATION_CONTEXT('mechanical design')");
    add("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000," + ref(application) + ")");
    product_context_ = add("PRODUCT_CONTEXT(''," + ref(application) + ",'mechanical')");
    definition_context_ = add("PRODUCT_DEFINITION_CONTEXT('part definition'," + ref(application) + ",'design')");
    set_unit(".MILLI.");
  }

  /// Of the representations that follow: ".MILLI." or "$" of meters; angles are in radians or in the unit `angle`.
  void set_unit(const std::string& prefix, int angle = 0) {
    const int length = add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(" + prefix + ",.METRE.))");
    if (angle == 0) angle = add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
    const int solid_angle = add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
    context_ = add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((" + ref(length) + "," +
                   ref(angle) + "," + ref(solid_angle) + "))REPRESENTATION_CONTEXT('c','3D'))");
  }

  static std::string ref(int id) { return "#" + std::to_string(id); }

  int add(const std::string& entity) {
    lines_ += ref(++last_) + "=" + entity + ";\n";
    return last_;
  }

  int point(double x, double y, double z) { return add("CARTESIAN_POINT(''," + triple(x, y, z) + ")"); }
  int direction(double x, double y, double z) { return add("DIRECTION(''," + triple(x, y, z) + ")"); }
  int frame(int at, int z, int x) {
    return add("AXIS2_PLACEMENT_3D(''," + ref(at) + "," + ref(z) + "," + ref(x) + ")");
  }
  int origin() { return frame(point(0, 0, 0), direction(0, 0, 1), direction(1, 0, 0)); }

  /// A block from the origin to (40, 30, 10) mm.
  int block() {
    std::vector<int> corners;
    for (int i = 0; i < 8; ++i) corners.push_back(point(i & 1 ? 40 : 0, i & 2 ? 30 : 0, i & 4 ? 10 : 0));
    const int loops[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const double normals[6][3] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    std::string faces;
    for (int f = 0; f < 6; ++f) {
      std::string loop;
      for (const int c : loops[f]) loop += (loop.empty() ? "" : ",") + ref(corners[static_cast<std::size_t>(c)]);
      const int bound = add("FACE_OUTER_BOUND(''," + ref(add("POLY_LOOP('',(" + loop + "))")) + ",.T.)");
      const double* n = normals[f];
      const int axes = frame(corners[static_cast<std::size_t>(loops[f][0])], direction(n[0], n[1], n[2]),
                             n[0] == 0 ? direction(1, 0, 0) : direction(0, 1, 0));
      const int face = add("FACE_SURFACE('',(" + ref(bound) + ")," + ref(add("PLANE(''," + ref(axes) + ")")) + ",.T.)");
      faces += (faces.empty() ? "" : ",") + ref(face);
    }
    return add("FACETED_BREP(''," + ref(add("CLOSED_SHELL('',(" + faces + "))")) + ")");
  }

  int product(const std::string& name) {
    const int product = add("PRODUCT('" + name + "','" + name + "','',(" + ref(product_context_) + "))");
    const int formation = add("PRODUCT_DEFINITION_FORMATION('',''," + ref(product) + ")");
    return add("PRODUCT_DEFINITION('design',''," + ref(formation) + "," + ref(definition_context_) + ")");
  }

  /// The representation of `product` by `items`.
  int shape(int product, const std::vector<int>& items, const std::string& kind = "SHAPE_REPRESENTATION") {
    const int self = add("PRODUCT_DEFINITION_SHAPE('',''," + ref(product) + ")");
    const int shown = representation(items, kind);
    add("SHAPE_DEFINITION_REPRESENTATION(" + ref(self) + "," + ref(shown) + ")");
    return shown;
  }

  int representation(const std::vector<int>& items, const std::string& kind) {
    std::string all;
    for (const int i : items) all += (all.empty() ? "" : ",") + ref(i);
    return add(kind + "('',(" + all + ")," + ref(context_) + ")");
  }

  /// Places `product`, shown by `shown`, in the product `in`, shown by `all`: its frame `from` comes to lie on `to`.
  void instance(int product, int shown, int from, int in, int all, int to, const std::string& name) {
    const int use =
        add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('" + name + "','" + name + "',''," + ref(in) + "," + ref(product) + ",$)");
    const int self = add("PRODUCT_DEFINITION_SHAPE('',''," + ref(use) + ")");
    const int moved = add("ITEM_DEFINED_TRANSFORMATION('',''," + ref(from) + "," + ref(to) + ")");
    const int relation =
        add("(REPRESENTATION_RELATIONSHIP('',''," + ref(shown) + "," + ref(all) +
            ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" + ref(moved) + ")SHAPE_REPRESENTATION_RELATIONSHIP())");
    add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + ref(relation) + "," + ref(self) + ")");
  }

  /// An operator of these axes (0: left out) and nothing else.
  int turning(int x, int y, int z) {
    const auto axis = [](int id) { return id == 0 ? std::string("$") : ref(id); };
    const int at = point(0, 0, 0);
    return add("CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',''," + axis(x) + "," + axis(y) + "," + ref(at) + ",$," +
               axis(z) + ")");
  }

  /// An operator with these axes, moved by 5 mm in x.
  int placing(double x_axis, double scale) {
    const int x = direction(x_axis, 0, 0), y = direction(0, 1, 0), at = point(5, 0, 0), z = direction(0, 0, 1);
    return add("CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',''," + ref(x) + "," + ref(y) + "," + ref(at) + "," +
               std::to_string(scale) + "," + ref(z) + ")");
  }

  std::string text() const {
    return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('x','2024-01-01T00:00:00',(''),(''),'','',"
           "'');\n"
           "FILE_SCHEMA(('" +
           schema_ + "'));\nENDSEC;\nDATA;\n" + lines_ + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

 private:
  static std::string triple(double x, double y, double z) {
    return "(" + std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(z) + ")";
  }

  std::string schema_, lines_;
  int last_ = 0, product_context_ = 0, definition_context_ = 0, context_ = 0;
};

}  // namespace tegotae::test
