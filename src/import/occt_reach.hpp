#pragma once

#include <XSControl_WorkSession.hxx>
#include <vector>

namespace tegotae {

/// Whether OpenCASCADE makes a shape of an entity of this kind, when it is an item of a representation.
bool is_shape_item(const Handle(Standard_Transient) & entity);

/// Construction lines and planes beside a shape, and what ties them to it: no part of the shape (ISO 10303-42).
bool is_supplement(const Handle(Standard_Transient) & entity);

/// Of each entity of the model, by its number from 1 on, whether the shape or the place of a product is made of it.
/// What OpenCASCADE goes through on the way to shapes is among these.
std::vector<bool> of_shape(const Handle(XSControl_WorkSession) & session);

}  // namespace tegotae
