#include "mesh/step_assembly.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <StepData_StepModel.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>
#include <gp_Trsf.hxx>
#include <stdexcept>

#include "mesh/step_location.hpp"

namespace tegotae::test {
namespace {

TopoDS_Shape cylinder(double x, double z, double diameter, double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, 0, z), gp_Dir(0, 0, 1)), diameter / 2, height).Shape();
}

TopoDS_Shape cut(const TopoDS_Shape& from, const TopoDS_Shape& what) {
  return BRepAlgoAPI_Cut(from, what).Shape();
}

/// Stands at z = 0, its upper end chamfered.
TopoDS_Shape dowel(const StepSizes& s) {
  const double straight = s.dowel_length - s.chamfer_length;
  const gp_Ax2 end(gp_Pnt(0, 0, straight), gp_Dir(0, 0, 1));
  const TopoDS_Shape tip =
      BRepPrimAPI_MakeCone(end, s.dowel / 2, s.dowel / 2 - s.chamfer_depth, s.chamfer_length).Shape();
  return BRepAlgoAPI_Fuse(cylinder(0, 0, s.dowel, straight), tip).Shape();
}

/// Top face at z = 0.
TopoDS_Shape plate(const StepSizes& s) {
  TopoDS_Shape body =
      BRepPrimAPI_MakeBox(gp_Pnt(-s.plate_x / 2, -s.plate_y / 2, -s.plate_z), s.plate_x, s.plate_y, s.plate_z).Shape();
  for (const double side : {-1.0, 1.0}) {
    body = cut(body, cylinder(side * s.bore_at, -s.plate_z - 1, s.bore, s.plate_z + 2));
    body = cut(body, cylinder(side * s.dowel_at, -s.plate_z - 1, s.dowel_hole, s.plate_z + 2));
  }
  return body;
}

TopoDS_Shape bushing(const StepSizes& s) {
  return cut(cylinder(0, 0, s.bushing_outer, s.bushing_length), cylinder(0, -1, s.bushing_inner, s.bushing_length + 2));
}

/// Lies on the plate; with two wide windows for the shafts and holes for the dowels.
TopoDS_Shape cover(const StepSizes& s) {
  TopoDS_Shape body =
      BRepPrimAPI_MakeBox(gp_Pnt(-s.plate_x / 2, -s.plate_y / 2, 0), s.plate_x, s.plate_y, s.cover_z).Shape();
  for (const double side : {-1.0, 1.0}) {
    body = cut(body, cylinder(side * s.bore_at, -1, s.window, s.cover_z + 2));
    body = cut(body, cylinder(side * s.dowel_at, -1, s.dowel_hole, s.cover_z + 2));
  }
  return body;
}

double millimeters(const std::string& unit) {
  if (unit == "MM") return 1;
  if (unit == "INCH") return 25.4;
  if (unit == "M") return 1000;
  throw std::runtime_error("unknown unit " + unit);
}

Handle(TDocStd_Document) new_document(const std::string& unit, const std::string& schema) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  Interface_Static::SetCVal("write.step.schema", schema.c_str());
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  return document;
}

void write(const Handle(TDocStd_Document) & document, const std::string& path, const std::string& unit) {
  STEPCAFControl_Writer writer;
  writer.SetColorMode(true);
  writer.SetNameMode(true);
  // OpenCASCADE 7.8 takes the unit's name from "write.step.unit" and the lengths from here.
  writer.ChangeWriter().Model()->SetWriteLengthUnit(millimeters(unit));
  if (!writer.Transfer(document, STEPControl_AsIs) || writer.Write(path.c_str()) != IFSelect_RetDone)
    throw std::runtime_error("cannot write " + path);
}

}  // namespace

void write_step_perforated(const std::string& path, int rows) {
  constexpr double pitch = 10, radius = 2.5, thickness = 2;
  const Handle(TDocStd_Document) document = new_document("MM", "AP214IS");
  const double side = pitch * rows;
  BRepBuilderAPI_MakePolygon outline(gp_Pnt(0, 0, 0), gp_Pnt(side, 0, 0), gp_Pnt(side, side, 0), gp_Pnt(0, side, 0),
                                     true);
  BRepBuilderAPI_MakeFace face(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), outline);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < rows; ++j) {
      const gp_Ax2 center(gp_Pnt((i + 0.5) * pitch, (j + 0.5) * pitch, 0), gp_Dir(0, 0, -1));
      face.Add(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(center, radius))));
    }
  XCAFDoc_DocumentTool::ShapeTool(document->Main())
      ->AddShape(BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, thickness)).Shape(), false);
  write(document, path, "MM");
}

void write_step_assembly(const std::string& path, const StepSizes& s, const std::string& unit,
                         const std::string& schema) {
  const Handle(TDocStd_Document) document = new_document(unit, schema);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colors = XCAFDoc_DocumentTool::ColorTool(document->Main());

  const auto named = [](const TDF_Label& label, const char* name) {
    TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
    return label;
  };
  const auto product = [&](const TopoDS_Shape& shape, const char* name) {
    return named(shapes->AddShape(shape, false), name);
  };
  const auto colored = [&](const TDF_Label& label, double r, double g, double b) {
    colors->SetColor(label, Quantity_Color(r, g, b, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
    return label;
  };
  const auto group = [&](const char* name) { return named(shapes->NewShape(), name); };
  const auto put = [&](const TDF_Label& into, const TDF_Label& what, const TopLoc_Location& where, const char* name) {
    named(shapes->AddComponent(into, what, where), name);
  };

  const TDF_Label bushings = colored(product(bushing(s), "Buchse"), 0.8, 0.1, 0.1);
  const TDF_Label dowels = product(dowel(s), "Stift");
  const TDF_Label carrier = group("Träger");
  put(carrier, colored(product(plate(s), "Grundplatte"), 0.1, 0.2, 0.9), TopLoc_Location(), "Grundplatte");
  put(carrier, bushings, at(-s.bore_at, 0, -s.bushing_length), "Buchse links");
  put(carrier, bushings, at(s.bore_at, 0, -s.bushing_length), "Buchse rechts");
  const TDF_Label lid = group("Deckel");
  put(lid, colored(product(cover(s), "Blech"), 0.2, 0.7, 0.3), TopLoc_Location(), "Blech");
  put(lid, dowels, at(-s.dowel_at, 0, s.cover_z - s.dowel_length), "Stift");
  put(lid, dowels, at(s.dowel_at, 0, s.cover_z - s.dowel_length), "Stift");
  const TDF_Label all = group("Baugruppe");
  gp_Trsf turned;  // by 90 degrees about x, then moved: the same for all three, so that they fit together
  turned.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), M_PI / 2);
  turned.SetTranslationPart(gp_Vec(100, 200, 300));
  put(all, carrier, turned, "Träger");
  put(all, lid, turned, "Deckel");
  put(all, product(cylinder(0, 0, s.shaft, s.shaft_length), "Welle"),
      TopLoc_Location(turned) * at(-s.bore_at, 0, -s.shaft_length / 2), "Welle");
  shapes->UpdateAssemblies();

  write(document, path, unit);
}

void write_step_housing(const std::string& path, double size) {
  const Handle(TDocStd_Document) document = new_document("MM", "AP214IS");
  const gp_Pnt corner(-size / 2, -size / 2, -size / 2);
  TopoDS_Shape body = BRepPrimAPI_MakeBox(corner, size, size, size).Shape();
  body = cut(body, BRepPrimAPI_MakeSphere(0.4 * size).Shape());
  body = cut(body, cylinder(0, -size, 0.1 * size, 2 * size));
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(body, false);
  write(document, path, "MM");
}

void write_step_open_solid(const std::string& path) {
  const Handle(TDocStd_Document) document = new_document("MM", "AP214IS");
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  BRepPrimAPI_MakeBox box(40, 30, 10);
  const TopoDS_Face top = box.TopFace();
  for (TopExp_Explorer e(box.Shape(), TopAbs_FACE); e.More(); e.Next())
    if (!e.Current().IsSame(top)) builder.Add(shell, e.Current());
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->AddShape(solid, false);
  write(document, path, "MM");
}

}  // namespace tegotae::test
