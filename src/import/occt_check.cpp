#include "import/occt_check.hpp"

#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_ReportEntity.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_BoundedSurface.hxx>
#include <StepRepr_HArray1OfRepresentationItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepShape_Block.hxx>
#include <StepShape_BooleanResult.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <StepShape_CsgSolid.hxx>
#include <StepShape_HalfSpaceSolid.hxx>
#include <StepShape_RightAngularWedge.hxx>
#include <StepShape_RightCircularCone.hxx>
#include <StepShape_RightCircularCylinder.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_Sphere.hxx>
#include <StepShape_Torus.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "import/load_files.hpp"
#include "import/occt_entities.hpp"
#include "import/occt_frames.hpp"
#include "import/occt_places.hpp"
#include "import/occt_reach.hpp"
#include "import/occt_units.hpp"
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

/// A shape by operations on solids: OpenCASCADE knows its name and makes nothing of it.
bool is_constructive(const Entity& entity) {
  return entity->IsKind(STANDARD_TYPE(StepShape_CsgSolid)) || entity->IsKind(STANDARD_TYPE(StepShape_BooleanResult)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_HalfSpaceSolid)) || entity->IsKind(STANDARD_TYPE(StepShape_Block)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_Sphere)) || entity->IsKind(STANDARD_TYPE(StepShape_Torus)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_RightCircularCone)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_RightCircularCylinder)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_RightAngularWedge));
}

/// A solid, or where `bare` a surface that is not part of one: something that can be touched should become of it.
bool is_touchable(const Entity& entity, bool bare) {
  return is_constructive(entity) || entity->IsKind(STANDARD_TYPE(StepShape_SolidModel)) ||
         (bare && (entity->IsKind(STANDARD_TYPE(StepShape_ConnectedFaceSet)) ||
                   entity->IsKind(STANDARD_TYPE(StepGeom_BoundedSurface))));
}

std::string product_name(const StepBasic_ProductDefinition& definition) {
  const Handle(StepBasic_ProductDefinitionFormation) version = definition.Formation();
  if (version.IsNull() || version->OfProduct().IsNull() || version->OfProduct()->Name().IsNull()) return "";
  return version->OfProduct()->Name()->ToCString();
}

/// Faults of the file as a whole. A reference to nothing is also a fault of the entity that has it; that there is
/// nothing to check is not a fault.
void require_readable(const std::string& path, const Handle(Interface_Check) & whole) {
  for (int i = 1; i <= whole->NbFails(); ++i)
    if (!begins(whole->CFail(i), "Unresolved Reference") && !has(whole->CFail(i), "DATA NOT AVAILABLE"))
      throw Error(path + ": damaged: OpenCASCADE cannot read its entities: " + whole->CFail(i));
}

/// The entities of kinds that OpenCASCADE does not know which the file names in `entity`, found to be faulty.
std::vector<Entity> unknown_in(const Handle(StepData_StepModel) & model, const Entity& entity) {
  std::vector<Entity> unknown;
  const Handle(Interface_ReportEntity) report = model->ReportEntity(model->Number(entity));
  if (report.IsNull()) return unknown;
  const auto content = Handle(StepData_UndefinedEntity)::DownCast(report->Content());
  if (content.IsNull()) return unknown;
  Interface_EntityIterator used;
  content->FillShared(used);
  for (used.Start(); used.More(); used.Next())
    if (!used.Value().IsNull() && used.Value()->IsKind(STANDARD_TYPE(StepData_UndefinedEntity)))
      unknown.push_back(used.Value());
  return unknown;
}

/// Whether an entity of unknown kinds is a leader line, a symbol or a text of a drawing: of these one kind is
/// STYLED_ITEM.
bool is_drawn(const Entity& entity) {
  for (auto kind = Handle(StepData_UndefinedEntity)::DownCast(entity); !kind.IsNull(); kind = kind->Next())
    if (std::string(kind->StepType()) == "STYLED_ITEM") return true;
  return false;
}

/// Takes items of kinds that OpenCASCADE does not know out of a representation, if nothing else is wrong with it.
bool leave_out_unknown(const Handle(StepData_StepModel) & model, const Entity& entity,
                       std::vector<std::string>& unread) {
  const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(entity);
  if (shape.IsNull() || shape->ContextOfItems().IsNull()) return false;
  const std::vector<Entity> unknown = unknown_in(model, entity);
  std::vector<Handle(StepRepr_RepresentationItem)> known;
  for (int i = 1; i <= shape->NbItems(); ++i)
    if (!shape->ItemsValue(i).IsNull()) known.push_back(shape->ItemsValue(i));
  if (unknown.empty() || static_cast<std::size_t>(shape->NbItems()) != known.size() + unknown.size()) return false;
  Handle(StepRepr_HArray1OfRepresentationItem) items;
  if (!known.empty()) items = new StepRepr_HArray1OfRepresentationItem(1, static_cast<int>(known.size()));
  for (std::size_t i = 0; i < known.size(); ++i) items->SetValue(static_cast<int>(i) + 1, known[i]);
  shape->SetItems(items);
  for (const Entity& one : unknown)
    if (!is_drawn(one)) unread.push_back(named(model, one));
  return true;
}

[[noreturn]] void refuse_damaged(const std::string& path, const Handle(StepData_StepModel) & model,
                                 const Entity& entity) {
  const std::vector<Entity> unknown = unknown_in(model, entity);
  if (is_constructive(entity)) throw Error(path + ": " + named(model, entity) + ", which is not read");
  if (!unknown.empty()) {
    const std::string what = named(model, unknown.front());
    // Of the contexts that are known without units only those of one kind are read.
    const bool unitless = has(what, "REPRESENTATION_CONTEXT") && !has(what, "GLOBAL_UNIT_ASSIGNED_CONTEXT");
    throw Error(path + ": " + what +
                (unitless ? ", which states no unit of length: export the file with its unit" : ", which is not read"));
  }
  throw Error(path + ": damaged: OpenCASCADE finds impossible entities: wrong or missing references (#" +
              std::to_string(model->IdentLabel(entity)) + ")");
}

}  // namespace

std::vector<std::string> named_files(const std::string& path, const Handle(XSControl_WorkSession) & session) {
  STEPConstruct_ExternRefs references(session);
  references.LoadExternRefs();
  std::vector<std::string> missing;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (int i = 1; i <= references.NbExternRefs(); ++i) {
    const char* name = references.FileName(i);
    if (name == nullptr || *name == '\0') continue;
    const std::filesystem::path file = folder / name;
    std::error_code error;
    if (!std::filesystem::exists(file, error))
      missing.emplace_back(name);
    else if (!MeshFolder(path).Exists(file.c_str()))
      throw Error(path + ": the file \"" + name + "\" that it names is not a regular file in its folder or below");
  }
  return missing;
}

CheckedEntities check_entities(const std::string& path, const Handle(XSControl_WorkSession) & session) {
  CheckedEntities out;
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  // Of entities that do not fit together OpenCASCADE makes null handles, which its own transfer then follows.
  Interface_CheckIterator checks = session->ModelCheckList(true);
  for (checks.Start(); checks.More(); checks.Next())
    if (checks.Number() <= 0) require_readable(path, checks.Value());
  if (model->NbEntities() == 0) throw Error(path + ": no entities in its data");
  out.of_shape = of_shape(session);
  for (checks.Start(); checks.More(); checks.Next()) {
    if (checks.Number() <= 0 || !checks.Value()->HasFailed()) continue;
    const Entity entity = model->Value(checks.Number());
    const std::string type = entity->DynamicType()->Name();
    if (!out.of_shape[static_cast<std::size_t>(checks.Number())] || (is_beside_shape(type) && !is_shape_item(entity)))
      out.has_colors = out.has_colors && is_beside_color(type);
    else if (!leave_out_unknown(model, entity, out.unread))
      refuse_damaged(path, model, entity);
  }
  require_places(path, model, out.of_shape);
  for (const Entity& unit : flatten_units(model)) out.changed.push_back(named(model, unit));
  for (const Entity& place : plain_places(model, out.of_shape)) out.changed.push_back(named(model, place));
  return out;
}

std::vector<std::string> unread_solids(const Handle(XSControl_WorkSession) & session,
                                       const std::vector<bool>& reached) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::vector<std::string> unread;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(model->Value(i));
    if (shape.IsNull()) continue;
    for (int k = 1; k <= shape->NbItems(); ++k) {
      const Entity item = shape->ItemsValue(k);
      const bool bare = reached[static_cast<std::size_t>(i)];
      if (!item.IsNull() && is_touchable(item, bare) && TransferBRep::ShapeResult(process, item).IsNull())
        unread.push_back(named(model, item));
    }
  }
  return unread;
}

std::vector<std::string> shared_shapes(const Handle(XSControl_WorkSession) & session) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  using Definition = StepBasic_ProductDefinition;
  std::set<const Standard_Transient*> placed;               // products, in others
  std::map<int, std::vector<Handle(Definition)>> products;  // of each representation
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto use = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model->Value(i));
    if (!use.IsNull()) placed.insert(use->RelatedProductDefinition().get());
    const auto shown = Handle(StepShape_ShapeDefinitionRepresentation)::DownCast(model->Value(i));
    if (shown.IsNull() || shown->UsedRepresentation().IsNull()) continue;
    const Handle(StepRepr_PropertyDefinition) property = shown->Definition().PropertyDefinition();
    if (property.IsNull()) continue;
    const Handle(Definition) product = property->Definition().ProductDefinition();
    auto& others = products[model->IdentLabel(shown->UsedRepresentation())];
    if (!product.IsNull() && std::find(others.begin(), others.end(), product) == others.end())
      others.push_back(product);
  }
  std::vector<std::string> notes;
  for (const auto& [shape, group] : products) {
    if (group.size() < 2) continue;
    std::string names;
    for (const Handle(Definition) & product : group)
      names += (names.empty() ? "\"" : ", \"") + product_name(*product) + '"';
    const auto is_placed = [&](const Handle(Definition) & product) { return placed.count(product.get()) > 0; };
    const auto alone = std::count_if(group.begin(), group.end(), [&](const auto& p) { return !is_placed(p); });
    notes.push_back(names + " of #" + std::to_string(shape) + ", which is read " +
                    (alone == 0                                           ? "at each place, called after one of them"
                     : alone == static_cast<std::ptrdiff_t>(group.size()) ? "once, not for each"
                                                                          : "only where an assembly places it"));
  }
  return notes;
}

std::vector<std::string> unplaced(const Handle(XSControl_WorkSession) & session) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  std::set<Standard_Transient*> placed;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shown = Handle(StepShape_ContextDependentShapeRepresentation)::DownCast(model->Value(i));
    if (!shown.IsNull() && !shown->RepresentedProductRelation().IsNull())
      placed.insert(shown->RepresentedProductRelation()->Definition().Value().get());
  }
  std::vector<std::string> instances;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto use = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model->Value(i));
    if (!use.IsNull() && placed.count(use.get()) == 0)
      instances.push_back("#" + std::to_string(model->IdentLabel(use)));
  }
  return instances;
}

}  // namespace tegotae
