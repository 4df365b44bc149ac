// The one file that includes OpenCASCADE.
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Quantity_ColorRGBA.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gp_Quaternion.hxx>
#include <map>
#include <numeric>
#include <set>

#include "mesh/read_parts.hpp"
#include "mesh/round_faces.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/load.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae {
namespace {

constexpr double kMillimeter = 1e-3;  // OpenCASCADE hands out millimeters, whatever the file's unit
// Turn between neighboring facets, rad: what small curved faces get besides the chord error.
constexpr double kFacetAngle = 0.35;

Vec3 meters(const gp_XYZ& p) {
  return kMillimeter * Vec3(p.X(), p.Y(), p.Z());
}

Vec3 direction(const gp_Dir& d) {
  return {d.X(), d.Y(), d.Z()};
}

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

/// Whether a name was made by a program for an instance that nobody named.
bool is_made_up(const std::string& name) {
  if (name.empty() || name.rfind("=>", 0) == 0) return true;
  const std::size_t digits = name.rfind("NAUO", 0) == 0 ? 4 : 0;
  return name.find_first_not_of("0123456789", digits) == std::string::npos;
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

/// What stands on the surface of a part.
CadFace describe(const TopoDS_Face& face) {
  CadFace out;
  Bnd_Box box;
  BRepBndLib::Add(face, box);
  if (!box.IsVoid()) {
    double x0, y0, z0, x1, y1, z1;
    box.Get(x0, y0, z0, x1, y1, z1);
    out.box = Eigen::AlignedBox3d(meters({x0, y0, z0}), meters({x1, y1, z1}));
  }
  const BRepAdaptor_Surface surface(face);
  gp_Ax3 axes;
  switch (surface.GetType()) {
    case GeomAbs_Plane:
      axes = surface.Plane().Position();
      out.kind = FaceKind::plane;
      break;
    case GeomAbs_Cylinder:
      axes = surface.Cylinder().Position();
      out.kind = FaceKind::cylinder;
      out.radius = kMillimeter * surface.Cylinder().Radius();
      break;
    case GeomAbs_Cone:
      axes = surface.Cone().Position();
      out.kind = FaceKind::cone;
      out.radius = kMillimeter * surface.Cone().RefRadius();
      break;
    case GeomAbs_Sphere:
      axes = surface.Sphere().Position();
      out.kind = FaceKind::sphere;
      out.radius = kMillimeter * surface.Sphere().Radius();
      break;
    case GeomAbs_Torus:
      axes = surface.Torus().Position();
      out.kind = FaceKind::torus;
      out.radius = kMillimeter * surface.Torus().MajorRadius();
      break;
    default:
      return out;
  }
  out.point = meters(axes.Location().XYZ());
  out.axis = direction(axes.Direction());
  // The normal of these surfaces looks outwards when their axes are right-handed.
  out.hole = axes.Direct() == (face.Orientation() == TopAbs_REVERSED);
  return out;
}

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) faces.push_back(TopoDS::Face(e.Current()));
  return faces;
}

/// Puts the triangulations of the faces of a shape together, joining nodes where the faces share edges.
class Joiner {
 public:
  TessellatedShape join(const std::vector<TopoDS_Face>& faces) {
    for (std::size_t f = 0; f < faces.size(); ++f) add(faces[f], static_cast<std::uint32_t>(f));
    TessellatedShape out;
    std::vector<std::uint32_t> index(nodes_.size(), 0xffffffffu);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      std::array<std::uint32_t, 3> corners;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t node = root(triangles_[t][k]);
        if (index[node] == 0xffffffffu) {
          index[node] = static_cast<std::uint32_t>(out.mesh.vertices.size());
          out.mesh.vertices.push_back(nodes_[node]);
        }
        corners[k] = index[node];
      }
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      out.mesh.triangles.push_back(corners);
      out.face_of.push_back(face_of_[t]);
    }
    return out;
  }

  std::size_t missing() const { return missing_; }

 private:
  void add(const TopoDS_Face& face, std::uint32_t number) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull() || mesh->NbTriangles() == 0) {
      ++missing_;
      return;
    }
    const auto base = static_cast<std::uint32_t>(nodes_.size());
    for (int i = 1; i <= mesh->NbNodes(); ++i) {
      nodes_.push_back(meters(mesh->Node(i).Transformed(location.Transformation()).XYZ()));
      parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    }
    const auto at = [base](int node) { return base + static_cast<std::uint32_t>(node - 1); };
    const bool reversed = face.Orientation() == TopAbs_REVERSED;
    for (int i = 1; i <= mesh->NbTriangles(); ++i) {
      int a, b, c;
      mesh->Triangle(i).Get(a, b, c);
      triangles_.push_back({at(a), at(reversed ? c : b), at(reversed ? b : c)});
      face_of_.push_back(number);
    }
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
      const Handle(Poly_PolygonOnTriangulation)& line = BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
      if (line.IsNull()) continue;
      std::vector<std::uint32_t> along;
      for (int i = 1; i <= line->NbNodes(); ++i) along.push_back(at(line->Node(i)));
      join_edge(edge, along);
    }
  }

  void join_edge(const TopoDS_Edge& edge, const std::vector<std::uint32_t>& along) {
    if (edges_.IsBound(edge)) {
      const std::vector<std::uint32_t>& other = lines_[static_cast<std::size_t>(edges_.Find(edge))];
      if (other.size() == along.size())
        for (std::size_t i = 0; i < along.size(); ++i) unite(along[i], other[i]);
    } else {
      edges_.Bind(edge, static_cast<int>(lines_.size()));
      lines_.push_back(along);
    }
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last);
    join_vertex(first, along.front());
    join_vertex(last, along.back());
  }

  void join_vertex(const TopoDS_Vertex& vertex, std::uint32_t node) {
    if (vertex.IsNull()) return;
    if (vertices_.IsBound(vertex))
      unite(node, static_cast<std::uint32_t>(vertices_.Find(vertex)));
    else
      vertices_.Bind(vertex, static_cast<int>(node));
  }

  std::uint32_t root(std::uint32_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t x = root(a), y = root(b);
    parent_[std::max(x, y)] = std::min(x, y);
  }

  std::vector<Vec3> nodes_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> face_of_;
  TopTools_DataMapOfShapeInteger edges_, vertices_;  // same place in space, whatever the orientation
  std::vector<std::vector<std::uint32_t>> lines_;
  std::size_t missing_ = 0;
};

void tessellate(const TopoDS_Shape& shape, double chord) {
  IMeshTools_Parameters settings;
  settings.Deflection = chord / kMillimeter;
  settings.Angle = kFacetAngle;
  settings.MinSize = 0.1 * settings.Deflection;
  BRepMesh_IncrementalMesh(shape, settings);
}

/// Half a unit in the last place of a file of floats, wherever in the shape; for the shape's file frame see
/// read_assembly.
double rounding_margin(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.vertices) box.extend(p);
  const bool far = box.center().norm() > box.diagonal().norm();
  const double largest = far ? 0.5 * box.sizes().maxCoeff() : box.max().cwiseMax(-box.min()).maxCoeff();
  return std::ldexp(largest, -23);
}

class StepReader {
 public:
  StepReader(const std::string& path, const AssemblyOptions& options) : path_(path), options_(options) {}
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
      if (options_.progress) options_.progress("tessellating", i, leaves_.size());
      make_shape(i);
    }
    drop_empty();
    return std::move(assembly_);
  }

 private:
  void open() {
    if (options_.progress) options_.progress("reading the file", 0, 0);
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
    application->NewDocument("MDTV-XCAF", document_);
    STEPCAFControl_Reader reader;
    reader.SetNameMode(true);
    reader.SetColorMode(true);
    if (reader.ReadFile(path_.c_str()) != IFSelect_RetDone) throw Error(path_ + ": damaged: not a readable STEP file");
    // Of entities that do not fit together OpenCASCADE makes null handles, which its own transfer then follows.
    const Interface_CheckIterator checks = reader.ChangeReader().WS()->ModelCheckList(true);
    if (!checks.IsEmpty(true))
      throw Error(path_ + ": damaged: OpenCASCADE finds entities that cannot be (wrong or missing references)");
    if (!reader.Transfer(document_)) throw Error(path_ + ": no shapes can be read from it");
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
  }

  /// `use` is the instance, `what` the product it shows (the same for a root).
  void add(const TDF_Label& use, const TDF_Label& what, const TopLoc_Location& where, std::vector<std::string>& groups,
           std::optional<Color> color) {
    if (const auto own = color_of(use)) color = own;
    std::string name = name_of(use);
    if (is_made_up(name)) name = name_of(what);
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
  std::optional<Color> color_of_product(const TDF_Label& what, const TopoDS_Shape& shape) const {
    if (const auto own = color_of(what)) return own;
    std::map<Color, double> areas;
    TDF_LabelSequence pieces;
    XCAFDoc_ShapeTool::GetSubShapes(what, pieces);
    for (const TDF_Label& piece : pieces) {
      const auto color = color_of(piece);
      const TopoDS_Shape sub = XCAFDoc_ShapeTool::GetShape(piece);
      if (!color || sub.IsNull() || sub.ShapeType() > TopAbs_FACE) continue;
      GProp_GProps area;
      BRepGProp::SurfaceProperties(sub, area);
      areas[*color] += area.Mass();
    }
    const auto largest =
        std::max_element(areas.begin(), areas.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return largest == areas.end() || shape.IsNull() ? std::nullopt : std::optional<Color>(largest->first);
  }

  /// Finds the faces that get the fine tessellation: those that mate, or all of a part alone in its file.
  void pair_faces() {
    std::vector<std::vector<CadFace>> faces;
    for (Leaf& leaf : leaves_) {
      for (const TopoDS_Face& face : leaf.faces) leaf.cad.push_back(describe(face));
      leaf.fine.assign(leaf.faces.size(), assembly_.parts.size() == 1);
      faces.push_back(leaf.cad);
    }
    std::set<std::string> told;
    for (const FacePairing& pair : mating_faces(faces, assembly_.parts)) {
      const AssemblyPart &a = assembly_.parts[pair.part_a], &b = assembly_.parts[pair.part_b];
      leaves_[a.shape].fine[pair.face_a] = true;
      leaves_[b.shape].fine[pair.face_b] = true;
      const FaceKind kind = leaves_[a.shape].cad[pair.face_a].kind;
      if (kind != FaceKind::cylinder) told.insert('"' + a.name + "\" and \"" + b.name + "\": " + names(kind));
    }
    for (const std::string& pair : told)
      assembly_.notes.push_back(pair + " that may mate; facets reach up to the chord error into a clearance");
  }

  static std::string names(FaceKind kind) {
    switch (kind) {
      case FaceKind::cone:
        return "cones";
      case FaceKind::sphere:
        return "spheres";
      case FaceKind::torus:
        return "tori";
      default:
        return "free-form faces";
    }
  }

  void make_shape(std::size_t i) {
    Leaf& leaf = leaves_[i];
    // Fine faces first: what is finer than asked for is kept, and its edges with it.
    for (std::size_t f = 0; f < leaf.faces.size(); ++f)
      if (leaf.fine[f]) tessellate(leaf.faces[f], options_.chord);
    tessellate(leaf.shape, std::max(options_.chord, options_.coarse_chord));
    Joiner joiner;
    TessellatedShape shape = joiner.join(leaf.faces);
    const std::string self = '"' + leaf.name + '"';
    if (joiner.missing() > 0)
      assembly_.notes.push_back(self + ": " + std::to_string(joiner.missing()) + " faces could not be tessellated");
    if (!shape.mesh.triangles.empty()) {
      const ClearanceReport kept = keep_clearance(shape, leaf.cad, rounding_margin(shape.mesh));
      note(self, kept);
      shape.mesh.name = leaf.name;
      if (!report(shape.mesh).closed) assembly_.notes.push_back(self + ": its surface is not closed");
    }
    assembly_.shapes.push_back(std::make_shared<const TriangleMesh>(std::move(shape.mesh)));
    leaf.shape.Nullify();
  }

  void note(const std::string& self, const ClearanceReport& kept) {
    const auto micrometers = [](double m) {
      char text[32];
      std::snprintf(text, sizeof text, "%.3g um", 1e6 * m);
      return std::string(text);
    };
    if (kept.into_clearance > 0)
      assembly_.notes.push_back(self + ": facets of a cylinder reach " + micrometers(kept.into_clearance) +
                                " into a clearance");
    if (kept.bent > 1e-9)
      assembly_.notes.push_back(self + ": a plane that runs into a hole tangentially is bent by " +
                                micrometers(kept.bent));
    if (kept.turned > 0)
      assembly_.notes.push_back(self + ": " + std::to_string(kept.turned) + " facets beside holes were turned over");
  }

  void drop_empty() {
    auto& parts = assembly_.parts;
    for (const AssemblyPart& part : parts) {
      if (assembly_.shapes[part.shape]->triangles.empty())
        assembly_.notes.push_back('"' + part.name + "\" has no faces: left out");
    }
    const auto empty = [&](const AssemblyPart& part) { return assembly_.shapes[part.shape]->triangles.empty(); };
    parts.erase(std::remove_if(parts.begin(), parts.end(), empty), parts.end());
  }

  struct Leaf {
    TopoDS_Shape shape;
    std::string name;
    std::vector<TopoDS_Face> faces;
    std::vector<CadFace> cad;
    std::vector<bool> fine;
    std::optional<Color> color;
  };

  const std::string& path_;
  const AssemblyOptions& options_;
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  std::vector<Leaf> leaves_;
  std::map<std::string, std::size_t> leaf_of_;
  Assembly assembly_;
};

}  // namespace

bool reads_step() {
  return true;
}

Assembly read_step(const std::string& path, const AssemblyOptions& options) {
  check_step(path);
  const Quiet quiet;
  try {
    return StepReader(path, options).read();
  } catch (const Standard_Failure& e) {
    throw Error(path + ": damaged: OpenCASCADE: " + e.GetMessageString());
  }
}

}  // namespace tegotae
