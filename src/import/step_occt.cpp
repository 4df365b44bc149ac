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
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gp_Quaternion.hxx>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "core/number_text.hpp"
#include "import/made_up_name.hpp"
#include "import/mating_notes.hpp"
#include "import/note_texts.hpp"
#include "import/occt_check.hpp"
#include "import/occt_content.hpp"
#include "import/occt_faces.hpp"
#include "import/occt_names.hpp"
#include "import/occt_notes.hpp"
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

// Facets of a part that nothing mates with in its file are so many times smaller than the part: 50 um for 200 mm; those
// of its cylinders and cones, of which a mate may be in another file, 5 um for 200 mm.
constexpr double kChordsAcross = 4000, kFineChordsAcross = 40000;

std::string in_quotes(const std::string& name) {
  return '"' + name + '"';
}

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
    for (const TDF_Label& root : roots) {
      if (contents_.of(root).faces)
        add(root, root, TopLoc_Location(), {}, std::nullopt);
      else
        leave_out(root, name_of(root), "");
    }
    pair_faces();
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      if (options_.progress) options_.progress(("tessellating " + described(leaves_[i])).c_str(), i, leaves_.size());
      make_shape(i);
    }
    note_unread();
    drop_empty();
    notes_.write_to(assembly_.notes);
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
    double chord = 0, coarse = 0;  // m, of the faces that are fine, and of the others
  };

  void open() {
    if (options_.progress) options_.progress("reading the file", 0, 0);
    STEPCAFControl_Controller::Init();
    Interface_Static::SetCVal("xstep.cascade.unit", "MM");
    // Else a frame among the items of a shape moves the mapped items beside it.
    Interface_Static::SetCVal("read.step.root.transformation", "OFF");
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
    // Of a relative path with a folder OpenCASCADE looks for the other files of parts in a wrong one.
    const std::string whole = std::filesystem::absolute(path_).string();
    if (reader.ChangeReader().ReadStream(whole.c_str(), text) != IFSelect_RetDone)
      throw Error(path_ + ": damaged: not a readable STEP file");
    const Handle(XSControl_WorkSession) session = reader.ChangeReader().WS();
    face_names_.emplace(session);
    const CheckedEntities checked = check_entities(path_, session);
    unread_.insert(unread_.end(), checked.unread.begin(), checked.unread.end());
    reader.SetColorMode(checked.has_colors);
    if (!checked.has_colors) notes_.add(note_texts::kNoColors, "the file");
    for (const std::string& file : named_files(path_, session)) notes_.add(note_texts::kMissingFile, in_quotes(file));
    if (!reader.Transfer(document_)) throw Error(path_ + ": no shapes can be read from it");
    note_shapes(session, checked.of_shape, plain.shapes);
    triangles_ = TransferredTriangles(std::move(plain.shapes), session);
    for (const std::string& solid : unread_solids(session, checked.of_shape)) unread_.push_back(solid);
    unplaced_ = unplaced(session);
    for (const std::string& shared : shared_shapes(session)) notes_.add(note_texts::kSharedShape, shared);
    check_named_files(reader);
    shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
    colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
  }

  void note_shapes(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& of_shape,
                   const std::vector<StepTriangles>& shapes) {
    std::set<std::uint64_t> tessellated;
    for (const StepTriangles& shape : shapes) tessellated.insert(shape.id);
    curves_ = bare_curves(session, of_shape);
    for (const std::string& body : hidden_bodies(session, tessellated)) notes_.add(note_texts::kHidden, body);
    for (const std::string& shape : without_unit(session, of_shape)) notes_.add(note_texts::kNoUnit, shape);
    for (const std::string& shape : without_angle(session, of_shape)) notes_.add(note_texts::kNoAngle, shape);
  }

  /// Other files are read with this one, and looked through after that only.
  void check_named_files(STEPCAFControl_Reader& reader) {
    NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator file(
        reader.ExternFiles());
    for (; file.More(); file.Next())
      if (file.Value()->GetLoadStatus() == IFSelect_RetDone) check_named_file(file.Key().ToCString(), *file.Value());
  }

  void check_named_file(const std::string& name, const STEPCAFControl_ExternFile& file) {
    const CheckedEntities checked = check_entities(path_ + ": " + name, file.GetWS());
    if (!checked.changed.empty())
      throw Error(path_ + ": " + name + ": " + checked.changed.front() +
                  ", which is read in the file that is opened only: export all parts into one file");
    for (const std::string& item : checked.unread) unread_.push_back(name + ": " + item);
    for (const std::string& solid : unread_solids(file.GetWS(), checked.of_shape))
      unread_.push_back(name + ": " + solid);
  }

  /// `use` is the instance, `what` the product it shows (the same for a root), which has faces; `groups` are the
  /// products that it is in.
  void add(const TDF_Label& use, const TDF_Label& what, const TopLoc_Location& where, std::vector<std::string> groups,
           std::optional<Color> color) {
    if (const auto own = color_of(use)) color = own;
    const std::string name = name_of_use(use, what);
    if (!XCAFDoc_ShapeTool::IsAssembly(what)) {
      add_leaf(what, name, where, groups, color);
      return;
    }
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(what, components);
    std::vector<std::pair<TDF_Label, TDF_Label>> filled;  // instance, product
    for (const TDF_Label& component : components) {
      TDF_Label product;
      if (!XCAFDoc_ShapeTool::GetReferredShape(component, product)) continue;
      if (contents_.of(product).faces)
        filled.emplace_back(component, product);
      else
        leave_out(product, name_of_use(component, product), name);
    }
    // A product of one nameless solid is that solid.
    const bool is_part = filled.size() == 1 && !XCAFDoc_ShapeTool::IsAssembly(filled[0].second) &&
                         is_default_name(name_of_use(filled[0].first, filled[0].second)) && !is_default_name(name);
    if (is_part) {
      const auto& [component, product] = filled[0];
      if (const auto own = color_of(component)) color = own;
      add_leaf(product, name, where * XCAFDoc_ShapeTool::GetLocation(component), groups, color);
      return;
    }
    groups.push_back(name);
    for (const auto& [component, product] : filled)
      add(component, product, where * XCAFDoc_ShapeTool::GetLocation(component), groups, color);
  }

  /// The instance's name, or the product's where it has none.
  static std::string name_of_use(const TDF_Label& use, const TDF_Label& what) {
    const std::string name = name_of(use);
    return is_default_name(name) || is_made_up(name, {"nauo"}) ? name_of(what) : name;
  }

  /// What is without faces becomes no part. `what`, called `name`, is a component of the product `of`, if of any.
  void leave_out(const TDF_Label& what, const std::string& name, const std::string& of) {
    const Content content = contents_.of(what);
    // Triangles were told by their number, or are curves of a drawing; instances are told once.
    if (content.taken || !left_out_.insert(entry_of(what)).second) return;
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(what, components);
    if (of.empty() || !is_default_name(name))
      notes_.add(note_texts::kNoFaces, in_quotes(name));
    else if (content.lines && components.IsEmpty())
      notes_.add(note_texts::kLines, in_quotes(of));
    else
      for (const TDF_Label& component : components) {
        TDF_Label product;
        if (XCAFDoc_ShapeTool::GetReferredShape(component, product))
          leave_out(product, name_of_use(component, product), of);
      }
  }

  void add_leaf(const TDF_Label& what, std::string name, const TopLoc_Location& where,
                const std::vector<std::string>& groups, std::optional<Color> color) {
    TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(what);
    const TopLoc_Location own = shape.Location();
    shape.Location(TopLoc_Location());
    if (is_default_name(name)) {
      const auto product = std::find_if_not(groups.rbegin(), groups.rend(), is_default_name);
      name = product != groups.rend() ? *product : std::filesystem::path(path_).stem().string();
    }
    const auto [known, fresh] = leaf_of_.emplace(entry_of(what), leaves_.size());
    if (fresh) {
      const std::string self = name_of(what);
      leaves_.push_back(
          {shape, is_default_name(self) ? name : self, faces_of(shape), {}, {}, color_of_product(what, shape)});
      if (contents_.of(what).lines) notes_.add(note_texts::kLines, in_quotes(leaves_.back().name));
    }
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
  /// will meet: fits are round as a rule, and facets of cylinders and cones are cheap, if they grow with the part.
  /// Pieces that are split may mate with each other.
  void pair_faces() {
    std::vector<std::vector<CadFace>> faces;
    const bool alone = assembly_.parts.size() == 1;
    for (Leaf& leaf : leaves_) {
      for (const TopoDS_Face& face : leaf.faces) leaf.cad.push_back(describe(face));
      for (const CadFace& face : leaf.cad)
        leaf.fine.push_back(alone && (face.kind == FaceKind::cylinder || face.kind == FaceKind::cone));
      leaf.chord = options_.chord;
      leaf.coarse = std::max(options_.chord, options_.coarse_chord);
      if (alone && !options_.split)
        leaf.chord = std::clamp(size_of(leaf) / kFineChordsAcross, options_.chord, leaf.coarse);
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
    mating.report(options_.chord, notes_);
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
      if (leaf.fine[f]) tessellate(leaf.faces[f], leaf.chord);
    tessellate(leaf.shape, leaf.coarse);
    std::vector<std::size_t> missing;
    TessellatedShape shape = joined(leaf.faces, missing);
    const std::string self = in_quotes(leaf.name);
    const auto at = [&](const std::vector<std::size_t>& which) {
      return self + " at " + face_names_->text(which, leaf.faces, leaf.cad);
    };
    if (!missing.empty()) notes_.add(note_texts::kNoTriangles, at(missing));
    const std::vector<std::size_t> open = faces_with_free_edges(shape);
    const TriangleMesh plain = triangles_.in(leaf.shape);
    const double margin = rounding_margin(shape.mesh.vertices, plain.vertices);
    if (!shape.mesh.triangles.empty()) note(self, keep_clearance(shape, leaf.cad, margin), margin);
    append(plain, Matrix34::Identity(), 1, shape.mesh);
    if (!shape.mesh.triangles.empty()) {
      shape.mesh.name = leaf.name;
      if (!open.empty())
        notes_.add(note_texts::kNotClosed, at(open));
      else if (!report(shape.mesh).closed)
        notes_.add(note_texts::kTrianglesNotClosed, self);
    }
    assembly_.shapes.push_back(std::make_shared<const TriangleMesh>(std::move(shape.mesh)));
    leaf.shape.Nullify();
  }

  /// Of a few rounding steps of the file nothing is told: no chord helps against them.
  void note(const std::string& self, const ClearanceReport& kept, double margin) {
    const double least_noted = std::max(1e-8, 4 * margin);
    if (kept.into_clearance > least_noted) notes_.add(note_texts::kReachesIn, self, kept.into_clearance);
    if (kept.bent > least_noted) notes_.add(note_texts::kBent, self, kept.bent);
    if (kept.turned > 0) notes_.add(note_texts::kTurned, self);
  }

  void note_unread() {
    for (const std::string& what : unplaced_) notes_.add(note_texts::kUnplaced, what);
    for (const std::string& what : unread_) notes_.add(note_texts::kUnread, what);
    for (const std::uint64_t id : triangles_.unused()) notes_.add(note_texts::kNoProduct, '#' + std::to_string(id));
  }

  /// Parts of which no triangles could be made, which was told.
  void drop_empty() {
    auto& parts = assembly_.parts;
    const auto empty = [&](const AssemblyPart& part) { return assembly_.shapes[part.shape]->triangles.empty(); };
    parts.erase(std::remove_if(parts.begin(), parts.end(), empty), parts.end());
    if (parts.empty() && !unplaced_.empty())
      throw Error(path_ + ": " + note_texts::kUnplaced.one + unplaced_.front() + " has no place: nothing can be read");
    if (parts.empty() && !unread_.empty()) throw Error(path_ + ": " + unread_.front() + ", which is not read");
    if (parts.empty() && !triangles_.unused().empty())
      throw Error(path_ + ": the triangles of #" + std::to_string(triangles_.unused().front()) +
                  " are of no product: nothing else can be read");
    if (parts.empty() && !curves_.empty())
      throw Error(path_ + ": " + curves_.front() + ": curves without faces are not a part");
  }

  const std::string &path_, &bytes_;
  const AssemblyOptions& options_;
  Handle(TDocStd_Document) document_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  std::vector<Leaf> leaves_;
  std::map<std::string, std::size_t> leaf_of_;
  std::set<std::string> left_out_;  // products
  TransferredTriangles triangles_;
  ProductContents contents_{triangles_};
  std::optional<FaceNames> face_names_;  // since the file is open
  std::vector<std::string> unplaced_;    // instances, each "#17"
  std::vector<std::string> unread_;      // shapes, each "#17 is a ..."
  std::vector<std::string> curves_;      // the same, without faces
  ImportNotes notes_;
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
