#include "import/occt_reach.hpp"

#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_ConstructiveGeometryRepresentation.hxx>
#include <StepRepr_ConstructiveGeometryRepresentationRelationship.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_ShapeAspect.hxx>
#include <StepRepr_ShapeRepresentationRelationship.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <StepShape_EdgeBasedWireframeModel.hxx>
#include <StepShape_FaceBasedSurfaceModel.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepShape_SolidModel.hxx>

namespace tegotae {
namespace {

using Entity = Handle(Standard_Transient);

bool has_shape_item(const Handle(StepRepr_Representation) & shown) {
  if (shown.IsNull()) return false;
  for (int i = 1; i <= shown->NbItems(); ++i)
    if (is_shape_item(shown->ItemsValue(i))) return true;
  return false;
}

/// Whether shapes or places of products begin with `entity`. A SHAPE_ASPECT's own representation (a datum target, a
/// point that is measured) is none; but some systems of before 1998 give the shape of a product so.
bool is_root(const Entity& entity) {
  if (entity->IsKind(STANDARD_TYPE(StepShape_ContextDependentShapeRepresentation)) ||
      entity->IsKind(STANDARD_TYPE(StepRepr_NextAssemblyUsageOccurrence)))
    return true;
  const auto shown = Handle(StepShape_ShapeDefinitionRepresentation)::DownCast(entity);
  if (shown.IsNull()) return false;
  const Handle(StepRepr_PropertyDefinition) property = shown->Definition().PropertyDefinition();
  const bool of_aspect = !property.IsNull() && !property->Definition().ShapeAspect().IsNull();
  return !of_aspect || has_shape_item(shown->UsedRepresentation());
}

class Reach {
 public:
  explicit Reach(const Handle(XSControl_WorkSession) & session)
      : model_(Handle(StepData_StepModel)::DownCast(session->Model())),
        graph_(session->Graph()),
        reached_(static_cast<std::size_t>(model_->NbEntities()) + 1, false) {}

  std::vector<bool> all() {
    for (int i = 1; i <= model_->NbEntities(); ++i)
      if (is_root(model_->Value(i))) reach(model_->Value(i));
    while (!open_.empty()) {
      const Entity at = model_->Value(open_.back());
      open_.pop_back();
      for (Interface_EntityIterator used = graph_.Shareds(at); used.More(); used.Next()) reach(used.Value());
      if (at->IsKind(STANDARD_TYPE(StepShape_ShapeRepresentation))) reach_related(at);
    }
    return std::move(reached_);
  }

 private:
  void reach(const Entity& entity) {
    if (entity.IsNull() || is_supplement(entity)) return;
    const int i = model_->Number(entity);
    if (i <= 0 || reached_[static_cast<std::size_t>(i)]) return;
    reached_[static_cast<std::size_t>(i)] = true;
    open_.push_back(i);
  }

  /// A shape goes on in another representation that a relationship names beside this one. OpenCASCADE's class of
  /// relationships with a transformation is one of these, also of views and drawings.
  void reach_related(const Entity& representation) {
    const Handle(Standard_Type) other = STANDARD_TYPE(StepRepr_RepresentationRelationshipWithTransformation);
    for (Interface_EntityIterator user = graph_.Sharings(representation); user.More(); user.Next())
      if (user.Value()->IsKind(STANDARD_TYPE(StepRepr_ShapeRepresentationRelationship)) &&
          user.Value()->DynamicType() != other)
        reach(user.Value());
  }

  const Handle(StepData_StepModel) model_;
  const Interface_Graph& graph_;
  std::vector<bool> reached_;
  std::vector<int> open_;
};

}  // namespace

bool is_shape_item(const Entity& entity) {
  if (entity.IsNull()) return false;
  return entity->IsKind(STANDARD_TYPE(StepShape_SolidModel)) || entity->IsKind(STANDARD_TYPE(StepRepr_MappedItem)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_ShellBasedSurfaceModel)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_FaceBasedSurfaceModel)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_EdgeBasedWireframeModel)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)) || entity->IsKind(STANDARD_TYPE(StepShape_GeometricSet));
}

bool is_supplement(const Entity& entity) {
  return entity->IsKind(STANDARD_TYPE(StepRepr_ConstructiveGeometryRepresentation)) ||
         entity->IsKind(STANDARD_TYPE(StepRepr_ConstructiveGeometryRepresentationRelationship));
}

std::vector<bool> of_shape(const Handle(XSControl_WorkSession) & session) {
  return Reach(session).all();
}

}  // namespace tegotae
