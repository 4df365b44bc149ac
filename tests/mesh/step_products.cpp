#include "mesh/step_products.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax2.hxx>
#include <gp_Trsf.hxx>
#include <stdexcept>

#include "mesh/step_location.hpp"

namespace tegotae::test {
namespace {

TopoDS_Shape cylinder(const gp_Pnt& foot, double radius, double height) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(foot, gp_Dir(0, 0, 1)), radius, height).Shape();
}

TopoDS_Compound compound(std::initializer_list<TopoDS_Shape> shapes) {
  TopoDS_Compound all;
  BRep_Builder().MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes) BRep_Builder().Add(all, shape);
  return all;
}

/// A plate with a slot.
TopoDS_Shape slotted() {
  TopoDS_Shape slot = BRepPrimAPI_MakeBox(gp_Pnt(-15, -8, -1), 30, 16, 12).Shape();
  for (const double side : {-1.0, 1.0})
    slot = BRepAlgoAPI_Fuse(slot, cylinder(gp_Pnt(side * 15, 0, -1), 8, 12)).Shape();
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-40, -20, 0), 80, 40, 10).Shape(), slot).Shape();
}

/// A block with two bores that are nearly one: where they cross, their walls run along each other.
TopoDS_Shape crossed() {
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-40, -20, -20), 80, 40, 40).Shape();
  const TopoDS_Shape one = BRepAlgoAPI_Cut(block, cylinder(gp_Pnt(0, 0, -30), 8, 60)).Shape();
  return BRepAlgoAPI_Cut(one, cylinder(gp_Pnt(0.05, 0, -30), 8.02, 60)).Shape();
}

/// A solid that is not closed.
TopoDS_Shape without_top() {
  BRepPrimAPI_MakeBox box(40, 30, 10);
  const TopoDS_Face top = box.TopFace();
  TopoDS_Shell shell;
  BRep_Builder().MakeShell(shell);
  for (TopExp_Explorer e(box.Shape(), TopAbs_FACE); e.More(); e.Next())
    if (!e.Current().IsSame(top)) BRep_Builder().Add(shell, e.Current());
  TopoDS_Solid solid;
  BRep_Builder().MakeSolid(solid);
  BRep_Builder().Add(solid, shell);
  return solid;
}

/// A document that becomes a STEP file.
class Document {
 public:
  explicit Document(const char* schema) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    Interface_Static::SetCVal("write.step.unit", "MM");
    Interface_Static::SetCVal("write.step.schema", schema);
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document_);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  }

  /// A product; without a name OpenCASCADE calls it after the kind of its shape.
  TDF_Label product(const TopoDS_Shape& shape, const char* name = nullptr) {
    return named(shapes_->AddShape(shape, false), name);
  }
  TDF_Label group(const char* name) { return named(shapes_->NewShape(), name); }
  void put(const TDF_Label& into, const TDF_Label& what, const TopLoc_Location& where, const char* name = nullptr) {
    named(shapes_->AddComponent(into, what, where), name);
  }
  /// A product of one shape and an empty compound.
  TDF_Label hollow(const TopoDS_Shape& shape, const char* name) {
    const TDF_Label self = group(name);
    put(self, product(shape), {});
    put(self, product(compound({})), {});
    return self;
  }

  void write(const std::string& path) {
    shapes_->UpdateAssemblies();
    STEPCAFControl_Writer writer;
    writer.SetNameMode(true);
    if (!writer.Transfer(document_, STEPControl_AsIs) || writer.Write(path.c_str()) != IFSelect_RetDone)
      throw std::runtime_error("cannot write " + path);
  }

 private:
  static TDF_Label named(const TDF_Label& label, const char* name) {
    if (name != nullptr) TDataStd_Name::Set(label, TCollection_ExtendedString(name, true));
    return label;
  }

  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
};

}  // namespace

void write_step_hollow_products(const std::string& path) {
  Document d("AP203");
  const TDF_Label plate = d.hollow(BRepPrimAPI_MakeBox(gp_Pnt(-40, -20, 0), 80, 40, 10).Shape(), "PLATE");
  const TDF_Label bolt = d.hollow(cylinder(gp_Pnt(0, 0, 20), 4, 30), "BOLT");
  const TDF_Label nut =
      d.hollow(BRepAlgoAPI_Cut(cylinder(gp_Pnt(0, 0, 0), 8, 6), cylinder(gp_Pnt(0, 0, -1), 4.1, 8)).Shape(), "NUT");
  const TDF_Label pair = d.group("PAIR");
  for (const double side : {-1.0, 1.0}) {
    d.put(pair, bolt, at(side * 10, 0, 0));
    d.put(pair, nut, at(side * 10, 0, 40));
  }
  const TDF_Label all = d.group("AS1");
  d.put(all, plate, {});
  d.put(all, pair, at(-25, 0, 0));
  d.put(all, pair, at(25, 0, 0));
  d.write(path);
}

void write_step_flange(const std::string& path, bool hollow) {
  Document d("AP203");
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-30, -30, -10), 60, 60, 20).Shape();
  const TopoDS_Shape body = BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 10), 9).Shape()).Shape();
  if (hollow)
    d.hollow(body, "FLANGE");
  else
    d.product(body, "FLANGE");
  d.write(path);
}

void write_step_beam(const std::string& path, double size) {
  Document d("AP214IS");
  const double pitch = size / 20, radius = 0.3 * pitch;
  TopoDS_Shape body = BRepPrimAPI_MakeBox(gp_Pnt(0, -pitch / 2, 0), size, pitch, pitch).Shape();
  for (int i = 0; i < 20; ++i) {
    const gp_Pnt foot((i + 0.5) * pitch, 0, 0), top((i + 0.5) * pitch, 0, pitch);
    const TopoDS_Shape sink = BRepPrimAPI_MakeCone(gp_Ax2(foot, gp_Dir(0, 0, 1)), radius, radius / 2, radius).Shape();
    body = BRepAlgoAPI_Cut(body, sink).Shape();
    if (i % 2 == 0)
      body = BRepAlgoAPI_Cut(body, cylinder(foot, radius / 2, 2 * pitch)).Shape();
    else
      body = BRepAlgoAPI_Fuse(body, cylinder(top, radius, pitch / 2)).Shape();
  }
  d.product(body, "beam");
  d.write(path);
}

void write_step_flaws(const std::string& path, int copies) {
  Document d("AP214IS");
  const TDF_Label all = d.group("all");
  for (int i = 0; i < copies; ++i) {
    int kinds = 0;
    const auto put = [&](const TopoDS_Shape& shape, const std::string& name, bool at_last = false) {
      kinds += !at_last;
      d.put(all, d.product(shape, (name + ' ' + std::to_string(i + 1)).c_str()), at(200 * kinds, 200 * i, 0));
    };
    const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 8).Shape();
    put(slotted(), "slot");
    put(crossed(), "cross");
    put(without_top(), "open");
    put(compound({BRepPrimAPI_MakeBox(20, 20, 20).Shape(),
                  BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 30), gp_Pnt(20, 0, 30)).Shape()}),
        "line");
    put(compound({}), "empty");
    put(compound({BRepBuilderAPI_MakeVertex(gp_Pnt(0, 0, 40)).Shape()}), "point");
    put(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-20, -20, -20), 40, 40, 20).Shape(), ball).Shape(), "socket");
    put(BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 7.9).Shape(), "ball", true);
  }
  d.write(path);
}

void write_step_nested(const std::string& path) {
  Document d("AP214IS");
  const TDF_Label all = d.group("all");
  const TopoDS_Shape other = BRepPrimAPI_MakeBox(gp_Pnt(30, 0, 0), 10, 10, 10).Shape();
  const auto block = [] { return BRepPrimAPI_MakeBox(20, 20, 20).Shape(); };
  d.put(all, d.product(compound({block(), other}), "two"), {});
  d.put(all, d.product(compound({block(), TopExp_Explorer(other, TopAbs_SHELL).Current()}), "shelled"), at(0, 50, 0));
  for (const char* side : {"left", "right"}) {
    const TDF_Label outer = d.group(side), inner = d.group("inner");
    d.put(inner, d.product(cylinder(gp_Pnt(0, 0, 0), *side == 'l' ? 5 : 6, 30), "pin"), at(0, 0, 7));
    d.put(outer, inner, at(0, 5, 0));
    d.put(all, outer, at(*side == 'l' ? -100 : 100, 0, 0));
  }
  d.write(path);
}

}  // namespace tegotae::test
