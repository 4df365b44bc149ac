#pragma once

#include <StepData_StepModel.hxx>
#include <StepRepr_Representation.hxx>
#include <optional>
#include <vector>

namespace tegotae {

/// Makes every unit of length or angle that is told in one that is not of the SI (a mil in inches) one that is told in
/// the SI's: OpenCASCADE goes one step down, and takes the unit for its own where that is not the last. Returns what it
/// changed.
std::vector<Handle(Standard_Transient)> flatten_units(const Handle(StepData_StepModel) & model);

/// The length of a representation's unit, m; none where it tells none, or one that OpenCASCADE does not read. Units
/// have to be flat.
std::optional<double> unit_of_length(const StepRepr_Representation& shape);

/// Whether a representation states a unit of plane angle that OpenCASCADE reads.
bool has_unit_of_angle(const StepRepr_Representation& shape);

}  // namespace tegotae
