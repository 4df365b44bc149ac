// Reads STEP files with OpenCASCADE: products, instances, names, colors.
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Quaternion.hxx>
#include <map>
#include <optional>
#include <sstream>

#include "core/number_text.hpp"
#include "import/made_up_name.hpp"
#include "import/mating_notes.hpp"
#include "import/occt_check.hpp"
#include "import/occt_faces.hpp"
#include "import/occt_shape.hpp"
#include "import/occt_triangles.hpp"
#include "import/part_file.hpp"
#include "import/read_parts.hpp"
#include "import/utf8.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

Pose pose_of(const TopLoc_Location& location) {
  const gp_Trsf& t = location.Transformation();
  const gp_Quaternion q = t.GetRotation();
  Pose X;
  X.q = Quat(q.W(), q.X(), q.Y(), q.Z()).normalized();
  X.p = meters(t.TranslationPart());
  return X;
}

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  const TCollection_ExtendedString& text = name->Get();
  std::string bytes(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  Standard_PCharacter at = bytes.data();
  bytes.resize(static_cast<std::size_t>(text.ToUTF8CString(at)));
  return bytes;
}

/// Keeps OpenCASCADE from printing for as long as it lives.
class Quiet {
 public:
  Quiet() : printers_(Message::DefaultMessenger()->Printers()) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Quiet() { Message::DefaultMessenger()->ChangePrinters() = printers_; }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  const Message_SequenceOfPrinters printers_;
};

/// Half a unit in the last place of a file of floats, wherever in the shape; for the shape's file frame see
/// read_assembly.
double rounding_margin(const std::vector<Vec3>& exact, const std::vector<Vec3>& plain) {
  Eigen::AlignedBox3d box;
  for (const auto* points : {&exact, &plain})
    for (const Vec3& p : *points) box.extend(p);
  const bool far = box.center().norm() > box.diagonal().norm();
  const double largest = far ? 0.5 * box.sizes().maxCoeff() : box.max().cwiseMax(-box.min()).maxCoeff();
  return std::ldexp(largest, -23);
}

// Facets of a part that nothing mates with in its file are so many times smaller than the part: 50 um for 200 mm.
constexpr double kChordsAcross = 4000;

class StepReader {
 public:
  StepReader(const std::string& path, const std::string& bytes, const AssemblyOptions& options)
      : path_(path), bytes_(bytes), options_(options) {}
  // The application lives as long as the program, and keeps the documents that are open.
  ~StepReader() {
    if (!document_.IsNull()) XCAFApp_Application::GetApplication()->Close(document_);
  }
  StepReader(const StepReader&) = delete;
  StepReader& operator=(const StepReader&) = delete;

  Assembly read() {
    assembly_.unit = "mm";
    open();
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    std::vector<std::string> groups;
    for (const TDF_Label& root : roots) add(root, root, TopLoc_Location(), groups, std::nullopt);
    pair_faces();
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      if (options_.progress) options_.progress(("tessellating " + described(leaves_[i])).c_str(), i, leaves_.size());
      make_shape(i);
    }
    tell_unread();
    drop_empty();
    return std::move(assembly_);
  }

 private:
  struct Leaf {
    TopoDS_Shape shape;
    std::string name;
    std::vector<TopoDS_Face> faces;
    std::vector<CadFace> cad;
    std::vector<bool> fine;
    std::optional<Color> color;
    bool tessellated = false;
    double coarse = 0;  // m, chord of the faces that are not fine
  };

  void open() {
    if (options_.progress) options_.progress("reading the file", 0, 0);
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
    application->NewDocument("MDTV-XCAF", document_);
    STEPCAFControl_Reader reader;
    reader.SetNameMode(true);
    // Beside colors nothing else is looked at.
    reader.SetLayerMode(false);
    reader.SetPropsMode(false);
    reader.SetGDTMode(false);
    reader.SetMatMode(false);
    reader.SetViewMode(false);
    PlainStep plain;
    if (mentions_triangles(bytes_)) plain = take_triangles(path_, bytes_);
    unread_ = plain.unread;
    std::istringstream text(plain.text.empty() ? bytes_ : plain.text);
    if (reader.ChangeReader().ReadStream(path_.c_str(), text) != IFSelect_RetDone)
      throw Error(path_ + ": damaged: not a readable STEP file");
    const Handle(XSControl_WorkSession) session = reader.ChangeReader().WS();
    face_names_.emplace(session);
    const bool has_colors = check_entities(path_, session);
    reader.SetColorMode(has_colors);
    if (!has_colors) assembly_.notes.push_back("colors are not read: their entities are damaged");
    for (const std::string& file : named_files(path_, session))
      assembly_.notes.push_back("the file \"" + file + "\" that it names is missing: its part is left out");
    if (!reader.Transfer(document_)) throw Error(path_ + ": no shapes can be read from it");
    triangles_ = TransferredTriangles(std::move(plain.shapes), session);
    for (const std::string& solid : unread_solids(session)) unread_.push_back(solid);
    unplaced_ = unplaced(session);
    for (const std::string& note : shared_shapes(session)) assembly_.notes.push_back(note);
    check_named_files(reader);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
  }

  /// Other files are read with this one, and looked through after that only.
  void check_named_files(STEPCAFControl_Reader& reader) {
    NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator file(
        reader.ExternFiles());
    for (; file.More(); file.Next())
      if (file.Value()->GetLoadStatus() == IFSelect_RetDone)
        check_entities(path_ + ": " + file.Key().ToCString(), file.Value()->GetWS());
  }

  /// `use` is the instance, `what` the product it shows (the same for a root).
  void add(const TDF_Label& use, const TDF_Label& what, const TopLoc_Location& where, std::vector<std::string>& groups,
           std::optional<Color> color) {
    if (const auto own = color_of(use)) color = own;
    std::string name = name_of(use);
    if (name.rfind("=>", 0) == 0 || is_made_up(name, {"nauo"})) name = name_of(what);
    if (!XCAFDoc_ShapeTool::IsAssembly(what)) {
      add_leaf(what, name, where, groups, color);
      return;
    }
    groups.push_back(name);
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(what, components);
    for (const TDF_Label& component : components) {
      TDF_Label product;
      if (XCAFDoc_ShapeTool::GetReferredShape(component, product))
        add(component, product, where * XCAFDoc_ShapeTool::GetLocation(component), groups, color);
    }
    groups.pop_back();
  }

  void add_leaf(const TDF_Label& what, const std::string& name, const TopLoc_Location& where,
                const std::vector<std::string>& groups, std::optional<Color> color) {
    TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(what);
    if (shape.IsNull()) return;
    const TopLoc_Location own = shape.Location();
    shape.Location(TopLoc_Location());
    TCollection_AsciiString entry;
    TDF_Tool::Entry(what, entry);
    const auto [known, fresh] = leaf_of_.emplace(entry.ToCString(), leaves_.size());
    if (fresh) leaves_.push_back({shape, name_of(what), faces_of(shape), {}, {}, color_of_product(what, shape)});
    AssemblyPart part;
    part.name = name;
    part.path = groups;
    part.shape = known->second;
    part.pose = pose_of(where * own);
    part.color = color ? color : leaves_[part.shape].color;
    assembly_.parts.push_back(std::move(part));
  }

  std::optional<Color> color_of(const TDF_Label& label) const {
    Quantity_ColorRGBA c;
    if (!colors_->GetColor(label, XCAFDoc_ColorSurf, c) && !colors_->GetColor(label, XCAFDoc_ColorGen, c))
      return std::nullopt;
    double r, g, b;
    c.GetRGB().Values(r, g, b, Quantity_TOC_sRGB);
    return Color{r, g, b, double{c.Alpha()}};
  }

  /// The product's color; of one colored piece by piece, the color of the largest area.
  std::optional<Color> color_of_product(const TDF_Label& what, const TopoDS_Shape& shape) {
    if (const auto own = color_of(what)) return own;
    std::map<Color, double> areas;
    TDF_LabelSequence pieces;
    XCAFDoc_ShapeTool::GetSubShapes(what, pieces);
    for (const TDF_Label& piece : pieces) {
      const auto color = color_of(piece);
      const TopoDS_Shape sub = XCAFDoc_ShapeTool::GetShape(piece);
      if (!color || sub.IsNull() || sub.ShapeType() > TopAbs_FACE) continue;
      GProp_GProps area;  // mm^2
      BRepGProp::SurfaceProperties(sub, area);
      areas[*color] += area.Mass() + 1e6 * triangles_.area_in(sub);
    }
    const auto largest =
        std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return largest == areas.end() || shape.IsNull() ? std::nullopt : std::optional<Color>(largest->first);
  }

  /// Finds the faces that get the fine tessellation: those that mate. Of a part alone in its file nobody knows what it
  /// will meet: fits are round as a rule, and facets of cylinders and cones are cheap.
  void pair_faces() {
    std::vector<std::vector<CadFace>> faces;
    const bool alone = assembly_.parts.size() == 1;
    for (Leaf& leaf : leaves_) {
      for (const TopoDS_Face& face : leaf.faces) leaf.cad.push_back(describe(face));
      for (const CadFace& face : leaf.cad)
        leaf.fine.push_back(alone && (face.kind == FaceKind::cylinder || face.kind == FaceKind::cone));
      leaf.coarse = std::max(options_.chord, options_.coarse_chord);
      if (alone) leaf.coarse = std::clamp(size_of(leaf) / kChordsAcross, options_.chord, leaf.coarse);
      faces.push_back(leaf.cad);
    }
    MatingNotes mating;
    for (const FacePairing& pair : mating_faces(faces, assembly_.parts)) {
      const AssemblyPart &a = assembly_.parts[pair.part_a], &b = assembly_.parts[pair.part_b];
      leaves_[a.shape].fine[pair.face_a] = true;
      leaves_[b.shape].fine[pair.face_b] = true;
      mating.add(a, b, leaves_[a.shape].cad[pair.face_a].kind);
    }
    mating.tell(options_.chord, assembly_.notes);
  }

  /// Name and size: facets by the million come from a unit that is not the part's.
  static std::string described(const Leaf& leaf) {
    return '"' + printable(leaf.name) + "\" (" + number_text(size_of(leaf), 3) + " m across)";
  }

  /// m, diagonal of the box around its faces.
  static double size_of(const Leaf& leaf) {
    Eigen::AlignedBox3d box;
    for (const CadFace& face : leaf.cad)
      if (!face.box.isEmpty()) box.extend(face.box);
    return box.isEmpty() ? 0.0 : box.diagonal().norm();
  }

  void make_shape(std::size_t i) {
    Leaf& leaf = leaves_[i];
    // Fine faces first: what is finer than asked for is kept, and its edges with it.
    for (std::size_t f = 0; f < leaf.faces.size(); ++f)
      if (leaf.fine[f]) tessellate(leaf.faces[f], options_.chord);
    tessellate(leaf.shape, leaf.coarse);
    std::vector<std::size_t> missing;
    TessellatedShape shape = joined(leaf.faces, missing);
    const std::string self = '"' + leaf.name + '"';
    if (!missing.empty())
      assembly_.notes.push_back(self + ": no triangles could be made of " +
                                face_names_->text(missing, leaf.faces, leaf.cad) +
                                ": the part has a hole there; export it anew, or as a mesh");
    const std::vector<std::size_t> open = faces_with_free_edges(shape);
    const TriangleMesh plain = triangles_.in(leaf.shape);
    leaf.tessellated = triangles_.any_in(leaf.shape);
    if (!shape.mesh.triangles.empty())
      note(self, keep_clearance(shape, leaf.cad, rounding_margin(shape.mesh.vertices, plain.vertices)));
    append(plain, Matrix34::Identity(), 1, shape.mesh);
    if (!shape.mesh.triangles.empty()) {
      shape.mesh.name = leaf.name;
      if (!open.empty())
        assembly_.notes.push_back(self + ": not closed at " + face_names_->text(open, leaf.faces, leaf.cad) +
                                  ": its inside is not known; if it is to be a solid, sew it in the CAD program");
      else if (!report(shape.mesh).closed)
        assembly_.notes.push_back(self + ": its triangles are not closed: its inside is not known");
    }
    assembly_.shapes.push_back(std::make_shared<const TriangleMesh>(std::move(shape.mesh)));
    leaf.shape.Nullify();
  }

  void note(const std::string& self, const ClearanceReport& kept) {
    const auto micrometers = [](double m) { return number_text(1e6 * m, 3) + " um"; };
    if (kept.into_clearance > 0)
      assembly_.notes.push_back(self + ": facets of a cylinder reach " + micrometers(kept.into_clearance) +
                                " into a clearance");
    if (kept.bent > 1e-9)
      assembly_.notes.push_back(self + ": a plane that runs into a hole tangentially is bent by " +
                                micrometers(kept.bent));
    if (kept.turned > 0)
      assembly_.notes.push_back(self + ": " + std::to_string(kept.turned) + " facets beside holes were turned over");
  }

  void tell_unread() {
    for (const std::string& what : unplaced_) assembly_.notes.push_back(what);
    for (const std::string& what : unread_) assembly_.notes.push_back(what + ", which is not read: left out");
    for (const std::uint64_t id : triangles_.unused())
      assembly_.notes.push_back("the triangles of #" + std::to_string(id) + " are of no product: left out");
  }

  void drop_empty() {
    auto& parts = assembly_.parts;
    const auto empty = [&](const AssemblyPart& part) { return assembly_.shapes[part.shape]->triangles.empty(); };
    for (const AssemblyPart& part : parts)
      if (empty(part) && !leaves_[part.shape].tessellated)
        assembly_.notes.push_back('"' + part.name + "\" has no faces: left out");
    parts.erase(std::remove_if(parts.begin(), parts.end(), empty), parts.end());
    if (parts.empty() && !unplaced_.empty()) throw Error(path_ + ": " + unplaced_.front());
    if (parts.empty() && !unread_.empty()) throw Error(path_ + ": " + unread_.front() + ", which is not read");
  }

  const std::string &path_, &bytes_;
  const AssemblyOptions& options_;
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  std::vector<Leaf> leaves_;
  std::map<std::string, std::size_t> leaf_of_;
  TransferredTriangles triangles_;
  std::optional<FaceNames> face_names_;  // since the file is open
  std::vector<std::string> unplaced_;    // instances, a note each
  std::vector<std::string> unread_;      // shapes, each "#17 is a ..."
  Assembly assembly_;
};

}  // namespace

bool reads_step() {
  return true;
}

Assembly read_step(const std::string& path, const AssemblyOptions& options) {
  const std::string bytes = check_step(path);
  const Quiet quiet;
  try {
    return StepReader(path, bytes, options).read();
  } catch (const Standard_Failure& e) {
    throw Error(path + ": damaged: OpenCASCADE: " + e.GetMessageString());
  }
}

}  // namespace tegotae
