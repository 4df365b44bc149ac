#include "import/occt_shape.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <array>

namespace tegotae {
namespace {

constexpr double kMillimeter = 1e-3;
// Turn between neighboring facets, rad: what small curved faces get besides the chord error.
constexpr double kFacetAngle = 0.35;

// Corners of a plane face from which on OpenCASCADE's default algorithm, whose time grows with their square, takes more
// than 0.1 s.
constexpr int kManyCorners = 2000;

Vec3 direction(const gp_Dir& d) {
  return {d.X(), d.Y(), d.Z()};
}

/// How many corners the bounds of a face get; those that nobody can follow count nothing.
int corners_of(const TopoDS_Face& face, const IMeshTools_Parameters& settings) {
  int corners = 0;
  for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
    if (BRep_Tool::Degenerated(edge) || !BRep_Tool::IsGeometric(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    if (Precision::IsInfinite(curve.FirstParameter()) || Precision::IsInfinite(curve.LastParameter())) continue;
    corners += GCPnts_TangentialDeflection(curve, settings.Angle, settings.Deflection).NbPoints() - 1;
  }
  return corners;
}

/// Whether a face has the triangles of a disk with holes whose corners are all on its bounds, by Euler's formula.
bool is_whole(const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation)& mesh = BRep_Tool::Triangulation(face, location);
  int bounds = 0;
  for (TopExp_Explorer w(face, TopAbs_WIRE); w.More(); w.Next()) ++bounds;
  return !mesh.IsNull() && mesh->NbTriangles() == mesh->NbNodes() + 2 * (bounds - 1) - 2;
}

/// Triangulates a plane face of many corners by the faster algorithm. That leaves some faces out; what is not whole is
/// left to the default one.
void triangulate_large_plane(const TopoDS_Face& face, IMeshTools_Parameters settings) {
  if (BRepAdaptor_Surface(face).GetType() != GeomAbs_Plane || corners_of(face, settings) < kManyCorners) return;
  settings.MeshAlgo = IMeshTools_MeshAlgoType_Delabella;
  BRepMesh_IncrementalMesh(face, settings);
  if (!is_whole(face)) BRepTools::Clean(face);
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

  std::vector<std::size_t> missing() const { return missing_; }

 private:
  void add(const TopoDS_Face& face, std::uint32_t number) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull() || mesh->NbTriangles() == 0) {
      missing_.push_back(number);
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
  std::vector<std::size_t> missing_;
};

}  // namespace

Vec3 meters(const gp_XYZ& p) {
  return kMillimeter * Vec3(p.X(), p.Y(), p.Z());
}

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next()) faces.push_back(TopoDS::Face(e.Current()));
  return faces;
}

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

void tessellate(const TopoDS_Shape& shape, double chord) {
  IMeshTools_Parameters settings;
  settings.Deflection = chord / kMillimeter;
  settings.Angle = kFacetAngle;
  settings.MinSize = 0.1 * settings.Deflection;
  for (const TopoDS_Face& face : faces_of(shape)) triangulate_large_plane(face, settings);
  BRepMesh_IncrementalMesh(shape, settings);
}

TessellatedShape joined(const std::vector<TopoDS_Face>& faces, std::vector<std::size_t>& missing) {
  Joiner joiner;
  TessellatedShape out = joiner.join(faces);
  missing = joiner.missing();
  return out;
}

}  // namespace tegotae
