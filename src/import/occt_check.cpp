#include "import/occt_check.hpp"

#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_CartesianTransformationOperator3d.hxx>
#include <StepGeom_Direction.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_Transformation.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_Vec.hxx>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

using Entity = Handle(Standard_Transient);

bool begins(const std::string& text, const char* start) {
  return text.rfind(start, 0) == 0;
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// Whether an entity of this class tells how something is drawn, measured or managed, and nothing of shape or place.
bool is_beside_shape(const std::string& type) {
  for (const char* start : {"StepVisual_", "StepDimTol_", "StepAP203_", "StepAP214_", "StepFEA_", "StepElement_"})
    if (begins(type, start)) return true;
  static constexpr std::array kManaged = {"Approval",     "Date",     "Time",     "Person",
                                          "Organization", "Address",  "Security", "Certification",
                                          "Contract",     "Document", "Action",   "Group"};
  return begins(type, "StepBasic_") &&
         std::any_of(kManaged.begin(), kManaged.end(), [&](auto m) { return has(type, m); });
}

/// Whether reading colors does not go through entities of this class, or looks before it does.
bool is_beside_color(const std::string& type) {
  static constexpr std::array kOthers = {"Point",      "Curve",      "Text",        "Camera",       "View",
                                         "Annotation", "Draughting", "Tessellated", "Triangulated", "CoordinatesList"};
  return !begins(type, "StepVisual_") ||
         std::any_of(kOthers.begin(), kOthers.end(), [&](auto o) { return has(type, o); });
}

gp_Vec vector_of(const Handle(StepGeom_Direction) & direction) {
  if (direction.IsNull() || direction->NbDirectionRatios() < 3) return {};
  return {direction->DirectionRatiosValue(1), direction->DirectionRatiosValue(2), direction->DirectionRatiosValue(3)};
}

/// What an operator does besides turning and shifting; empty when nothing. Axes that it leaves out are made
/// right-handed.
std::string scale_or_mirror(const StepGeom_CartesianTransformationOperator3d& map) {
  if (map.HasScale() && std::abs(map.Scale() - 1) > 1e-9) return "scales";
  if (!map.HasAxis1() || !map.HasAxis2() || !map.HasAxis3()) return "";
  const gp_Vec x = vector_of(map.Axis1()), y = vector_of(map.Axis2()), z = vector_of(map.Axis3());
  return x.Crossed(y).Dot(z) < 0 ? "mirrors" : "";
}

/// The operator that places something by `entity`; null when it is none of these.
Handle(StepGeom_CartesianTransformationOperator3d) operator_of(const Entity& entity) {
  using Operator = StepGeom_CartesianTransformationOperator3d;
  const auto item = Handle(StepRepr_MappedItem)::DownCast(entity);
  if (!item.IsNull()) return Handle(Operator)::DownCast(item->MappingTarget());
  const auto relation = Handle(StepRepr_RepresentationRelationshipWithTransformation)::DownCast(entity);
  if (!relation.IsNull()) return Handle(Operator)::DownCast(relation->TransformationOperator().Value());
  return {};
}

void require_rigid(const std::string& path, const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto map = operator_of(model->Value(i));
    const std::string fault = map.IsNull() ? "" : scale_or_mirror(*map);
    if (!fault.empty())
      throw Error(path + ": the CARTESIAN_TRANSFORMATION_OPERATOR_3D #" + std::to_string(model->IdentLabel(map)) + " " +
                  fault + " a part, which is not read: export such parts as shapes of their own");
  }
}

}  // namespace

bool check_entities(const std::string& path, const Handle(XSControl_WorkSession) & session) {
  bool has_colors = true;
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  // Of entities that do not fit together OpenCASCADE makes null handles, which its own transfer then follows.
  Interface_CheckIterator checks = session->ModelCheckList(true);
  for (checks.Start(); checks.More(); checks.Next()) {
    if (!checks.Value()->HasFailed()) continue;
    const Entity entity = checks.Number() > 0 ? model->Value(checks.Number()) : Entity();
    const std::string type = entity.IsNull() ? "" : entity->DynamicType()->Name();
    if (is_beside_shape(type)) {
      has_colors = has_colors && is_beside_color(type);
    } else {
      const std::string which = entity.IsNull() ? "" : " (#" + std::to_string(model->IdentLabel(entity)) + ")";
      throw Error(path + ": damaged: OpenCASCADE finds impossible entities: wrong or missing references" + which);
    }
  }
  require_rigid(path, model);
  return has_colors;
}

}  // namespace tegotae
