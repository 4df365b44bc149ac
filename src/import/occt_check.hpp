#pragma once

#include <XSControl_WorkSession.hxx>
#include <string>

namespace tegotae {

/// Looks through the entities that OpenCASCADE has read, before they become shapes; whether colors can be read too
/// (OpenCASCADE follows null pointers in damaged ones). Throws Error when one that tells shape or place is damaged, or
/// scales or mirrors, which OpenCASCADE drops.
bool check_entities(const std::string& path, const Handle(XSControl_WorkSession) & session);

}  // namespace tegotae
