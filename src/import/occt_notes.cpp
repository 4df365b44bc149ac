#include "import/occt_notes.hpp"

#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_ConicalSurface.hxx>
#include <StepGeom_Curve.hxx>
#include <StepShape_EdgeBasedWireframeModel.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_GeometricSetSelect.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepVisual_HArray1OfLayeredItem.hxx>
#include <StepVisual_Invisibility.hxx>
#include <StepVisual_InvisibleItem.hxx>
#include <StepVisual_LayeredItem.hxx>
#include <StepVisual_PresentationLayerAssignment.hxx>
#include <StepVisual_PresentationRepresentation.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Shape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>

#include "import/occt_entities.hpp"
#include "import/occt_units.hpp"

namespace tegotae {
namespace {

using Entity = Handle(Standard_Transient);

/// What an item of an INVISIBILITY hides: what a style is of, or all on a layer.
std::vector<Entity> hidden_by(const StepVisual_InvisibleItem& item) {
  std::vector<Entity> hidden;
  const Handle(StepVisual_StyledItem) styled = item.StyledItem();
  if (!styled.IsNull()) hidden.push_back(styled->Item());
  const Handle(StepVisual_PresentationLayerAssignment) layer = item.PresentationLayerAssignment();
  if (layer.IsNull()) return hidden;
  for (int i = 1; i <= layer->NbAssignedItems(); ++i) {
    Entity on = layer->AssignedItemsValue(i).Value();
    const auto style = Handle(StepVisual_StyledItem)::DownCast(on);
    hidden.push_back(style.IsNull() ? on : Entity(style->Item()));
  }
  return hidden;
}

bool is_bare_curve(const Entity& item) {
  if (item.IsNull()) return false;
  const auto set = Handle(StepShape_GeometricSet)::DownCast(item);
  for (int i = 1; !set.IsNull() && i <= set->NbElements(); ++i)
    if (!set->ElementsValue(i).Curve().IsNull()) return true;
  return item->IsKind(STANDARD_TYPE(StepShape_EdgeBasedWireframeModel));
}

/// The representations that shapes of products are made of.
std::vector<Handle(StepShape_ShapeRepresentation)> shapes_of(const Handle(XSControl_WorkSession) & session,
                                                             const std::vector<bool>& reached) {
  const Handle(Interface_InterfaceModel) model = session->Model();
  std::vector<Handle(StepShape_ShapeRepresentation)> shapes;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(model->Value(i));
    if (!shape.IsNull() && reached[static_cast<std::size_t>(i)]) shapes.push_back(shape);
  }
  return shapes;
}

/// Whether an item of the representation is made of a conical surface.
bool has_cone(const Interface_Graph& graph, const StepShape_ShapeRepresentation& shape) {
  std::set<Entity> seen;
  std::vector<Entity> open;
  for (int i = 1; i <= shape.NbItems(); ++i) open.push_back(shape.ItemsValue(i));
  while (!open.empty()) {
    const Entity at = open.back();
    open.pop_back();
    // A representation that an item shows has its own units.
    if (at.IsNull() || at->IsKind(STANDARD_TYPE(StepRepr_Representation)) || !seen.insert(at).second) continue;
    if (at->IsKind(STANDARD_TYPE(StepGeom_ConicalSurface))) return true;
    for (Interface_EntityIterator used = graph.Shareds(at); used.More(); used.Next()) open.push_back(used.Value());
  }
  return false;
}

}  // namespace

std::vector<std::string> hidden_bodies(const Handle(XSControl_WorkSession) & session,
                                       const std::set<std::uint64_t>& tessellated) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::set<int> bodies;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto invisible = Handle(StepVisual_Invisibility)::DownCast(model->Value(i));
    if (invisible.IsNull() || invisible->InvisibleItems().IsNull()) continue;
    for (int k = 1; k <= invisible->NbInvisibleItems(); ++k) {
      for (const Entity& one : hidden_by(invisible->InvisibleItemsValue(k))) {
        if (one.IsNull()) continue;
        const int number = model->IdentLabel(one);
        const TopoDS_Shape shape = TransferBRep::ShapeResult(process, one);
        if ((!shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More()) ||
            tessellated.count(static_cast<std::uint64_t>(number)) > 0)
          bodies.insert(number);
      }
    }
  }
  std::vector<std::string> out;
  for (const int number : bodies) out.push_back("#" + std::to_string(number));
  return out;
}

std::vector<std::string> bare_curves(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& reached) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  std::vector<std::string> out;
  for (const Handle(StepShape_ShapeRepresentation) & shape : shapes_of(session, reached))
    for (int i = 1; i <= shape->NbItems(); ++i)
      if (is_bare_curve(shape->ItemsValue(i))) out.push_back(named(model, shape->ItemsValue(i)));
  return out;
}

std::vector<std::string> without_unit(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& reached) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  std::vector<std::string> out;
  for (const Handle(StepShape_ShapeRepresentation) & shape : shapes_of(session, reached))
    if (!unit_of_length(*shape)) out.push_back("#" + std::to_string(model->IdentLabel(shape)));
  return out;
}

std::vector<std::string> without_angle(const Handle(XSControl_WorkSession) & session,
                                       const std::vector<bool>& reached) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  std::vector<std::string> out;
  for (const Handle(StepShape_ShapeRepresentation) & shape : shapes_of(session, reached))
    if (!has_unit_of_angle(*shape) && has_cone(session->Graph(), *shape))
      out.push_back("#" + std::to_string(model->IdentLabel(shape)));
  return out;
}

}  // namespace tegotae
