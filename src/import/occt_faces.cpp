#include "import/occt_faces.hpp"

#include <StepData_StepModel.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/number_text.hpp"

namespace tegotae {
namespace {

const char* kind_of(FaceKind kind) {
  switch (kind) {
    case FaceKind::plane:
      return "a plane";
    case FaceKind::cylinder:
      return "a cylinder";
    case FaceKind::cone:
      return "a cone";
    case FaceKind::sphere:
      return "a sphere";
    case FaceKind::torus:
      return "a torus";
    default:
      return "a free-form face";
  }
}

std::string place_of(const CadFace& face) {
  if (face.box.isEmpty()) return "";
  const Vec3 at = face.box.center();
  const auto mm = [](double m) { return number_text(std::round(1e5 * m) / 100, 6); };
  return " around (" + mm(at.x()) + ", " + mm(at.y()) + ", " + mm(at.z()) + ") mm";
}

}  // namespace

std::vector<std::size_t> faces_with_free_edges(const TessellatedShape& shape) {
  struct Edge {
    int triangles = 0;
    std::uint32_t face = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
  for (std::size_t t = 0; t < shape.mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(shape.mesh.triangles[t][k], shape.mesh.triangles[t][(k + 1) % 3]);
      Edge& edge = edges[{a, b}];
      ++edge.triangles;
      edge.face = shape.face_of[t];
    }
  std::set<std::size_t> faces;
  for (const auto& [ends, edge] : edges)
    if (edge.triangles == 1) faces.insert(edge.face);
  return {faces.begin(), faces.end()};
}

std::string FaceNames::text(const std::vector<std::size_t>& which, const std::vector<TopoDS_Face>& faces,
                            const std::vector<CadFace>& known) {
  if (number_.empty()) find_numbers();
  const auto number = number_.find(faces[which.front()].TShape().get());
  const CadFace& first = known[which.front()];
  std::string out = "face ";
  if (number != number_.end()) out += '#' + std::to_string(number->second) + ' ';
  out += '(' + (kind_of(first.kind) + place_of(first)) + ')';
  if (which.size() > 1) out += " and " + std::to_string(which.size() - 1) + " more";
  return out;
}

void FaceNames::find_numbers() {
  const auto model = Handle(StepData_StepModel)::DownCast(session_->Model());
  const Handle(Transfer_TransientProcess) process = session_->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (!model->Value(i)->IsKind(STANDARD_TYPE(StepShape_FaceSurface))) continue;
    const TopoDS_Shape face = TransferBRep::ShapeResult(process, model->Value(i));
    if (!face.IsNull()) number_[face.TShape().get()] = model->IdentLabel(model->Value(i));
  }
}

}  // namespace tegotae
