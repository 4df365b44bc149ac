#include "import/occt_entities.hpp"

#include <StepData_UndefinedEntity.hxx>
#include <cctype>

#include "import/step_lists.hpp"

namespace tegotae {

std::string step_name(const Handle(Standard_Transient) & entity) {
  std::string name;
  auto unknown = Handle(StepData_UndefinedEntity)::DownCast(entity);
  if (!unknown.IsNull()) {
    for (; !unknown.IsNull(); unknown = unknown->Next()) {
      const std::string kind = unknown->StepType();
      if (kind.compare(0, kUnfilled.size(), kUnfilled) == 0)
        return kind.substr(kUnfilled.size()) + " with an empty list";
      name += (name.empty() ? "" : "+") + kind;
    }
    return name;
  }
  const std::string type = entity->DynamicType()->Name();  // "StepShape_RightCircularCylinder"
  for (std::size_t i = type.find('_') + 1; i < type.size(); ++i) {
    const auto c = static_cast<unsigned char>(type[i]);
    // Axis2Placement3d is AXIS2_PLACEMENT_3D.
    const bool dimension = std::isdigit(c) != 0 && type.compare(i + 1, 1, "d") == 0;
    const bool starts_word = std::isupper(c) != 0 || dimension;
    if (starts_word && !name.empty()) name += '_';
    name += static_cast<char>(std::toupper(c));
  }
  return name;
}

std::string named(const Handle(StepData_StepModel) & model, const Handle(Standard_Transient) & entity) {
  const std::string name = step_name(entity);
  const bool vowel = std::string("AEIOU").find(name.front()) != std::string::npos;
  return "#" + std::to_string(model->IdentLabel(entity)) + (vowel ? " is an " : " is a ") + name;
}

}  // namespace tegotae
