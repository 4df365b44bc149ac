#include "import/occt_triangles.hpp"

#include <BRep_Tool.hxx>
#include <StepData_StepModel.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <optional>

#include "import/occt_shape.hpp"
#include "import/part_file.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae {
namespace {

/// The map that the points 0, x, y, z were moved by; none when `shape` is not these.
std::optional<Matrix34> map_of(const TopoDS_Shape& shape) {
  std::vector<Vec3> points;
  for (TopoDS_Iterator i(shape); i.More(); i.Next())
    if (i.Value().ShapeType() == TopAbs_VERTEX)
      points.push_back(meters(BRep_Tool::Pnt(TopoDS::Vertex(i.Value())).XYZ()));
  if (points.size() != 4) return std::nullopt;
  Matrix34 map;
  for (int k = 0; k < 3; ++k) map.col(k) = points[static_cast<std::size_t>(k) + 1] - points[0];
  map.col(3) = points[0];
  return map;
}

}  // namespace

TransferredTriangles::TransferredTriangles(std::vector<StepTriangles> shapes,
                                           const Handle(XSControl_WorkSession) & session) {
  if (shapes.empty()) return;
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::map<std::uint64_t, TopoDS_Shape> result;
  for (const StepTriangles& s : shapes) {
    result[s.id];
    if (s.exact != 0) result[s.exact];
  }
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto wanted = result.find(static_cast<std::uint64_t>(model->IdentLabel(model->Value(i))));
    if (wanted != result.end()) wanted->second = TransferBRep::ShapeResult(process, model->Value(i));
  }
  for (StepTriangles& s : shapes) {
    const TopoDS_Shape &exact = result[s.exact], &points = result[s.id];
    if (!exact.IsNull() && TopExp_Explorer(exact, TopAbs_FACE).More()) s.mesh = {};
    if (!s.mesh.triangles.empty()) unused_.insert(s.id);
    if (!points.IsNull()) shapes_[points.TShape().get()] = std::move(s);
  }
}

TriangleMesh TransferredTriangles::in(const TopoDS_Shape& shape) {
  TriangleMesh all;
  if (!shapes_.empty()) collect(shape, all);
  return all.triangles.empty() ? all : weld(all);
}

double TransferredTriangles::area_in(const TopoDS_Shape& shape) {
  const TriangleMesh mesh = in(shape);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    area += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return area;
}

bool TransferredTriangles::are_in(const TopoDS_Shape& shape) const {
  const auto found = shapes_.find(shape.TShape().get());
  if (found != shapes_.end()) return !found->second.mesh.triangles.empty();
  if (shape.ShapeType() == TopAbs_COMPOUND)
    for (TopoDS_Iterator i(shape); i.More(); i.Next())
      if (are_in(i.Value())) return true;
  return false;
}

bool TransferredTriangles::any_in(const TopoDS_Shape& shape) const {
  if (stands_for_some(shape)) return true;
  if (shape.ShapeType() == TopAbs_COMPOUND)
    for (TopoDS_Iterator i(shape); i.More(); i.Next())
      if (any_in(i.Value())) return true;
  return false;
}

std::vector<std::uint64_t> TransferredTriangles::unused() const {
  return {unused_.begin(), unused_.end()};
}

void TransferredTriangles::collect(const TopoDS_Shape& shape, TriangleMesh& to) {
  const auto found = shapes_.find(shape.TShape().get());
  if (found != shapes_.end()) {
    if (const auto map = map_of(shape)) {
      append(found->second.mesh, *map, 1, to);
      unused_.erase(found->second.id);
    }
    return;
  }
  if (shape.ShapeType() != TopAbs_COMPOUND) return;
  for (TopoDS_Iterator i(shape); i.More(); i.Next()) collect(i.Value(), to);
}

}  // namespace tegotae
