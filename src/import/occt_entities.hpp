#pragma once

#include <StepData_StepModel.hxx>
#include <string>

namespace tegotae {

/// What the file calls an entity of this kind: RIGHT_CIRCULAR_CYLINDER. One of several kinds: A+B. One that was
/// renamed for an empty list (step_lists.hpp): "A with an empty list".
std::string step_name(const Handle(Standard_Transient) & entity);

/// "#17 is a BLOCK".
std::string named(const Handle(StepData_StepModel) & model, const Handle(Standard_Transient) & entity);

}  // namespace tegotae
