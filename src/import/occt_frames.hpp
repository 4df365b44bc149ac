#pragma once

#include <StepData_StepModel.hxx>
#include <StepGeom_Axis2Placement3d.hxx>
#include <optional>
#include <vector>

#include "import/part_file.hpp"

namespace tegotae {

/// The frame as ISO 10303-42 (build_axes) means it, in the unit of its coordinates; none when it has no directions that
/// can be.
std::optional<Matrix34> frame_of(const StepGeom_Axis2Placement3d& frame);

/// Tells places so that OpenCASCADE reads them as the standard means them. It brings one frame to lie on another right
/// when one of the two is the identity only, and chooses other axes where a frame leaves its second one out. So what
/// places a shape in such a way gets the identity for its first frame, and for its second one the place of the shape.
/// `reached` says for each entity, by its number from 1 on, whether a shape is made of it. Units have to be flat.
/// Returns what it changed.
std::vector<Handle(Standard_Transient)> plain_places(const Handle(StepData_StepModel) & model,
                                                     const std::vector<bool>& reached);

}  // namespace tegotae
