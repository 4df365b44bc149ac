// STEP files with tessellated shapes: what is taken out of the text, and the text that is left for OpenCASCADE, which
// is not run here. Before that, lists that are empty.
#include "fuzz/fuzz.hpp"
#include "import/step_lists.hpp"
#include "import/step_triangles.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

std::vector<Seed> seeds() {
  const std::string points = "#1=COORDINATES_LIST('',4,((0.,0.,0.),(1.E1,0.,0.),(0.,+10.,0.),(0.,0.,10.)));\n";
  const std::string shown = "#9=TESSELLATED_SHAPE_REPRESENTATION('it''s',(#3,#4),#8);\n";
  const std::string plain = "#2=TRIANGULATED_FACE('',#1,4,(),$,(1,2,3,4),((1,3,2),(1,2,4),(2,3,4),(3,1,4)));\n";
  const std::string strips = "#2=COMPLEX_TRIANGULATED_SURFACE_SET('',#1,4,$,(),((1,3,2,4,1,3)),((1,3,2,4)));\n";
  const std::string end = "ENDSEC;\nEND-ISO-10303-21;\n";
  const std::string begin = "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n";
  return {
      {"solid", begin + points + plain + "#3=TESSELLATED_SOLID('',(#2),#4);\n" + shown + end},
      {"set", begin + points + strips + "#3 = /* ; */ TESSELLATED_GEOMETRIC_SET ( '' , ( #2 ) ) ;\n" + shown + end},
      {"complex", begin + points +
                      "#3=(REPOSITIONED_TESSELLATED_ITEM(#5)TESSELLATED_GEOMETRIC_SET((#2))TESSELLATED_ITEM());\n" +
                      "#4=TESSELLATED_WIRE('',(),$);\n"
                      "#9=(REPRESENTATION('',(#3,#4),#8)SHAPE_REPRESENTATION()TESSELLATED_SHAPE_REPRESENTATION());\n" +
                      end},
      {"face", begin + points + plain + "#9=SHAPE_REPRESENTATION('',(#2,#2,$,LABEL('x')),\"0F\");\n" + end},
      {"empty", begin + "#5=EDGE_LOOP('()',( ));\n#6=STYLED_ITEM('',(),#5);\n" + end},
      {"knots",
       begin + "#7=(BOUNDED_CURVE()B_SPLINE_CURVE(1,(#1),.UNSPECIFIED.,.F.,.F.)CURVE()RATIONAL_B_SPLINE_CURVE(()));\n" +
           end}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = "input.step", bytes(reinterpret_cast<const char*>(data), size);
  try {
    const std::string renamed = rename_unfilled(path, bytes);
    require(rename_unfilled(path, renamed) == renamed, "what was renamed is left alone");
    const PlainStep plain = take_triangles(path, renamed);
    std::size_t triangles = 0;
    for (const StepTriangles& shape : plain.shapes) {
      triangles += shape.mesh.triangles.size();
      for (const auto& t : shape.mesh.triangles)
        for (const std::uint32_t v : t) require(v < shape.mesh.vertices.size(), "indices are in range");
      for (const Vec3& p : shape.mesh.vertices) require(p.allFinite(), "coordinates are finite");
    }
    require(triangles <= 16 * size, "no more triangles than the file has room for");
    require(take_triangles(path, plain.text).shapes.empty(), "all shapes of triangles are taken out");
  } catch (const Error& e) {
    require_error_of(path + ": ", e.what());
  }
  return 0;
}

}  // namespace tegotae
