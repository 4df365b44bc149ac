#include "import/occt_units.hpp"

#include <STEPConstruct_UnitContext.hxx>
#include <StepBasic_ConversionBasedUnit.hxx>
#include <StepBasic_ConversionBasedUnitAndLengthUnit.hxx>
#include <StepBasic_ConversionBasedUnitAndPlaneAngleUnit.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_SiUnit.hxx>
#include <StepBasic_SiUnitAndLengthUnit.hxx>
#include <StepBasic_SiUnitAndPlaneAngleUnit.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>

namespace tegotae {
namespace {

using Conversion = StepBasic_ConversionBasedUnit;

// A unit of a unit of a unit; what is deeper goes in a circle.
constexpr int kDeepestUnit = 16;

/// What a unit is so many of; null where nothing can be told.
Handle(StepBasic_NamedUnit) base_of(const Handle(StepBasic_MeasureWithUnit) & measure) {
  if (measure.IsNull() || measure->ValueComponentMember().IsNull()) return {};
  const StepBasic_Unit of = measure->UnitComponent();
  return of.Value().IsNull() ? Handle(StepBasic_NamedUnit)() : of.NamedUnit();
}

/// Whether the measure was told in a unit that is itself told in another.
bool flatten(const Handle(StepBasic_MeasureWithUnit) & measure, int depth) {
  const auto base = Handle(Conversion)::DownCast(base_of(measure));
  if (base.IsNull() || depth > kDeepestUnit) return false;
  const Handle(StepBasic_MeasureWithUnit) below = base->ConversionFactor();
  flatten(below, depth + 1);
  if (base_of(below).IsNull()) return false;
  measure->SetValueComponent(measure->ValueComponent() * below->ValueComponent());
  measure->SetUnitComponent(below->UnitComponent());
  return true;
}

double si_prefix(const StepBasic_SiUnit& unit) {
  return unit.HasPrefix() ? STEPConstruct_UnitContext::ConvertSiPrefix(unit.Prefix()) : 1;
}

/// The units of a representation that OpenCASCADE looks at.
Handle(StepRepr_GlobalUnitAssignedContext) units_of(const StepRepr_Representation& shape) {
  using Plain = StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext;
  using Uncertain = StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx;
  const auto plain = Handle(Plain)::DownCast(shape.ContextOfItems());
  if (!plain.IsNull()) return plain->GlobalUnitAssignedContext();
  const auto uncertain = Handle(Uncertain)::DownCast(shape.ContextOfItems());
  if (!uncertain.IsNull()) return uncertain->GlobalUnitAssignedContext();
  return {};
}

std::optional<double> length_of(const Handle(StepBasic_NamedUnit) & unit) {
  if (unit.IsNull()) return std::nullopt;
  if (unit->IsKind(STANDARD_TYPE(StepBasic_SiUnitAndLengthUnit)))
    return si_prefix(*Handle(StepBasic_SiUnit)::DownCast(unit));
  if (!unit->IsKind(STANDARD_TYPE(StepBasic_ConversionBasedUnitAndLengthUnit))) return std::nullopt;
  const Handle(StepBasic_MeasureWithUnit) measure = Handle(Conversion)::DownCast(unit)->ConversionFactor();
  const auto base = Handle(StepBasic_SiUnit)::DownCast(base_of(measure));
  if (base.IsNull()) return std::nullopt;
  return measure->ValueComponent() * si_prefix(*base);
}

}  // namespace

std::vector<Handle(Standard_Transient)> flatten_units(const Handle(StepData_StepModel) & model) {
  std::vector<Handle(Standard_Transient)> changed;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepBasic_ConversionBasedUnitAndLengthUnit)) &&
        !entity->IsKind(STANDARD_TYPE(StepBasic_ConversionBasedUnitAndPlaneAngleUnit)))
      continue;
    const auto unit = Handle(Conversion)::DownCast(entity);
    if (flatten(unit->ConversionFactor(), 0)) changed.push_back(unit);
  }
  return changed;
}

std::optional<double> unit_of_length(const StepRepr_Representation& shape) {
  const Handle(StepRepr_GlobalUnitAssignedContext) units = units_of(shape);
  if (units.IsNull() || units->Units().IsNull()) return std::nullopt;
  std::optional<double> last;  // OpenCASCADE takes the last one as well
  for (int i = 1; i <= units->NbUnits(); ++i)
    if (const auto length = length_of(units->UnitsValue(i))) last = length;
  return last;
}

bool has_unit_of_angle(const StepRepr_Representation& shape) {
  const Handle(StepRepr_GlobalUnitAssignedContext) units = units_of(shape);
  if (units.IsNull() || units->Units().IsNull()) return false;
  for (int i = 1; i <= units->NbUnits(); ++i) {
    const Handle(StepBasic_NamedUnit) unit = units->UnitsValue(i);
    if (!unit.IsNull() && (unit->IsKind(STANDARD_TYPE(StepBasic_SiUnitAndPlaneAngleUnit)) ||
                           unit->IsKind(STANDARD_TYPE(StepBasic_ConversionBasedUnitAndPlaneAngleUnit))))
      return true;
  }
  return false;
}

}  // namespace tegotae
