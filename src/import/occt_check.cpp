#include "import/occt_check.hpp"

#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepBasic_ProductDefinitionRelationship.hxx>
#include <StepData_StepModel.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_CartesianTransformationOperator3d.hxx>
#include <StepGeom_Direction.hxx>
#include <StepRepr_ConstructiveGeometryRepresentation.hxx>
#include <StepRepr_ConstructiveGeometryRepresentationRelationship.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepRepr_RepresentationRelationshipWithTransformation.hxx>
#include <StepRepr_Transformation.hxx>
#include <StepShape_Block.hxx>
#include <StepShape_BooleanResult.hxx>
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
#include <cctype>
#include <cmath>
#include <filesystem>
#include <gp_Vec.hxx>
#include <map>
#include <set>
#include <vector>

#include "import/load_files.hpp"
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

/// The direction as a unit vector; `fallback` without one. A zero vector stands for none that can be.
gp_Vec vector_of(const Handle(StepGeom_Direction) & direction, const gp_Vec& fallback) {
  if (direction.IsNull() || direction->NbDirectionRatios() < 3) return fallback;
  const gp_Vec v(direction->DirectionRatiosValue(1), direction->DirectionRatiosValue(2),
                 direction->DirectionRatiosValue(3));
  return v.Magnitude() > 0 ? v.Normalized() : gp_Vec();
}

/// `v` without its share along the unit vectors `x` and `y`, as a unit vector; zero when nothing is left.
gp_Vec beside(const gp_Vec& v, const gp_Vec& x, const gp_Vec& y) {
  const gp_Vec rest = v - x * v.Dot(x) - y * v.Dot(y);
  return rest.Magnitude() > 1e-9 ? rest.Normalized() : gp_Vec();
}

/// What an operator does besides turning and shifting, or does to axes that it leaves out; empty when OpenCASCADE reads
/// it as ISO 10303-42 (base_axis) means it. OpenCASCADE makes every frame right-handed.
std::string not_rigid(const StepGeom_CartesianTransformationOperator3d& map) {
  if (map.HasScale() && std::abs(map.Scale() - 1) > 1e-9) return "scales";
  const gp_Vec ex(1, 0, 0), ey(0, 1, 0), ez(0, 0, 1);
  const gp_Vec z = vector_of(map.Axis3(), ez);
  const gp_Vec x = beside(vector_of(map.Axis1(), std::abs(z.X()) < 1 ? ex : ey), z, gp_Vec());
  const gp_Vec y = beside(vector_of(map.Axis2(), ey), z, x);
  if (z.Magnitude() == 0 || x.Magnitude() == 0 || y.Magnitude() == 0) return "has axes that span no space for";
  if (x.Crossed(y).Dot(z) < 0) return "mirrors";
  const gp_Vec first = vector_of(map.Axis1(), ex);
  const gp_Vec read_z = map.HasAxis3() ? z : first.Crossed(vector_of(map.Axis2(), ey));
  if (read_z.Magnitude() < 1e-9 || (read_z.Normalized() - z).Magnitude() > 1e-9 ||
      (beside(first, z, gp_Vec()) - x).Magnitude() > 1e-9)
    return "leaves out axes that place";
  return "";
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
    const std::string fault = map.IsNull() ? "" : not_rigid(*map);
    if (!fault.empty())
      throw Error(path + ": the CARTESIAN_TRANSFORMATION_OPERATOR_3D #" + std::to_string(model->IdentLabel(map)) + " " +
                  fault + " a part, which is not read: export such parts as shapes of their own");
  }
}

/// Construction lines and planes beside a shape, and what ties them to it: no part of the shape (ISO 10303-42).
bool is_supplement(const Entity& entity) {
  return entity->IsKind(STANDARD_TYPE(StepRepr_ConstructiveGeometryRepresentation)) ||
         entity->IsKind(STANDARD_TYPE(StepRepr_ConstructiveGeometryRepresentationRelationship));
}

/// Whether shapes or places may be made of `entity`: what they are made of is reached from here.
bool leads_to_shape(const Entity& entity) {
  if (is_supplement(entity)) return false;
  return entity->IsKind(STANDARD_TYPE(StepBasic_ProductDefinition)) ||
         entity->IsKind(STANDARD_TYPE(StepBasic_ProductDefinitionRelationship)) ||
         entity->IsKind(STANDARD_TYPE(StepRepr_ProductDefinitionShape)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_ShapeRepresentation)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_ShapeDefinitionRepresentation)) ||
         entity->IsKind(STANDARD_TYPE(StepShape_ContextDependentShapeRepresentation)) ||
         entity->IsKind(STANDARD_TYPE(StepRepr_RepresentationRelationship)) ||
         entity->IsKind(STANDARD_TYPE(StepRepr_MappedItem));
}

/// Of each entity of the model, by its number from 1 on, whether a shape or place may be made of it.
std::vector<bool> of_shape(const Handle(StepData_StepModel) & model, const Interface_Graph& graph) {
  std::vector<bool> reached(static_cast<std::size_t>(model->NbEntities()) + 1, false);
  std::vector<int> open;
  const auto reach = [&](int i) {
    if (i <= 0 || reached[static_cast<std::size_t>(i)]) return;
    reached[static_cast<std::size_t>(i)] = true;
    open.push_back(i);
  };
  for (int i = 1; i <= model->NbEntities(); ++i)
    if (leads_to_shape(model->Value(i))) reach(i);
  while (!open.empty()) {
    const int at = open.back();
    open.pop_back();
    for (Interface_EntityIterator used = graph.Shareds(model->Value(at)); used.More(); used.Next())
      if (!used.Value().IsNull()) reach(model->Number(used.Value()));
  }
  return reached;
}

/// `RIGHT_CIRCULAR_CYLINDER` of "StepShape_RightCircularCylinder".
std::string step_name(const std::string& type) {
  std::string name;
  for (std::size_t i = type.find('_') + 1; i < type.size(); ++i) {
    const auto c = static_cast<unsigned char>(type[i]);
    if (std::isupper(c) != 0 && !name.empty()) name += '_';
    name += static_cast<char>(std::toupper(c));
  }
  return name;
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

std::string product_name(const StepBasic_ProductDefinition& definition) {
  const Handle(StepBasic_ProductDefinitionFormation) version = definition.Formation();
  if (version.IsNull() || version->OfProduct().IsNull() || version->OfProduct()->Name().IsNull()) return "";
  return version->OfProduct()->Name()->ToCString();
}

std::string named(const Handle(StepData_StepModel) & model, const Entity& entity) {
  return "#" + std::to_string(model->IdentLabel(entity)) + " is a " + step_name(entity->DynamicType()->Name());
}

/// Faults of the file as a whole. A reference to nothing is also a fault of the entity that has it; that there is
/// nothing to check is no fault.
void require_readable(const std::string& path, const Handle(Interface_Check) & whole) {
  for (int i = 1; i <= whole->NbFails(); ++i)
    if (!begins(whole->CFail(i), "Unresolved Reference") && !has(whole->CFail(i), "DATA NOT AVAILABLE"))
      throw Error(path + ": damaged: OpenCASCADE cannot read its entities: " + whole->CFail(i));
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
      throw Error(path + ": the file \"" + name + "\" that it names is no regular file in its folder or below");
  }
  return missing;
}

bool check_entities(const std::string& path, const Handle(XSControl_WorkSession) & session) {
  bool has_colors = true;
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  // Of entities that do not fit together OpenCASCADE makes null handles, which its own transfer then follows.
  Interface_CheckIterator checks = session->ModelCheckList(true);
  for (checks.Start(); checks.More(); checks.Next())
    if (checks.Number() <= 0) require_readable(path, checks.Value());
  if (model->NbEntities() == 0) throw Error(path + ": no entities in its data");
  const std::vector<bool> matters = of_shape(model, session->Graph());
  for (checks.Start(); checks.More(); checks.Next()) {
    if (checks.Number() <= 0 || !checks.Value()->HasFailed()) continue;
    const Entity entity = model->Value(checks.Number());
    const std::string type = entity->DynamicType()->Name();
    const bool beside = is_supplement(entity) || (is_beside_shape(type) && !leads_to_shape(entity));
    if (beside || !matters[static_cast<std::size_t>(checks.Number())]) {
      has_colors = has_colors && is_beside_color(type);
    } else if (is_constructive(entity)) {
      throw Error(path + ": " + named(model, entity) + ", which is not read");
    } else {
      throw Error(path + ": damaged: OpenCASCADE finds impossible entities: wrong or missing references (#" +
                  std::to_string(model->IdentLabel(entity)) + ")");
    }
  }
  require_rigid(path, model);
  return has_colors;
}

std::vector<std::string> unread_solids(const Handle(XSControl_WorkSession) & session) {
  const auto model = Handle(StepData_StepModel)::DownCast(session->Model());
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  std::vector<std::string> unread;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(model->Value(i));
    if (shape.IsNull()) continue;
    for (int k = 1; k <= shape->NbItems(); ++k) {
      const Entity item = shape->ItemsValue(k);
      const bool solid = !item.IsNull() && (is_constructive(item) || item->IsKind(STANDARD_TYPE(StepShape_SolidModel)));
      if (solid && TransferBRep::ShapeResult(process, item).IsNull()) unread.push_back(named(model, item));
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
