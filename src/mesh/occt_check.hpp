#pragma once

#include <XSControl_WorkSession.hxx>
#include <set>
#include <string>

namespace tegotae {

/// What is known of a STEP file's entities before they become shapes.
struct StepEntities {
  bool colors = true;                 ///< false: OpenCASCADE would follow null pointers in the colors
  std::set<std::string> tessellated;  ///< products with triangles that this OpenCASCADE does not know
};

/// Looks through the entities that OpenCASCADE has read. Throws Error when one that tells shape or place is damaged, or
/// scales or mirrors, which OpenCASCADE drops.
StepEntities check_entities(const std::string& path, const Handle(XSControl_WorkSession) & session);

}  // namespace tegotae
