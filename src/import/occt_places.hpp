#pragma once

#include <StepData_StepModel.hxx>
#include <string>
#include <vector>

namespace tegotae {

/// Throws Error when an entity that places a shape does so in a way that OpenCASCADE reads otherwise than ISO 10303
/// means it, or not at all. `reached` says for each entity, by its number from 1 on, whether a shape is made of it.
void require_places(const std::string& path, const Handle(StepData_StepModel) & model,
                    const std::vector<bool>& reached);

}  // namespace tegotae
