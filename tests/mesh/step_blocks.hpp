#pragma once

#include "apps/run_program.hpp"
#include "mesh/assembly_checks.hpp"
#include "mesh/step_text.hpp"

namespace tegotae::test {

inline Assembly read_step_text(const std::string& text) {
  const TempFolder folder;
  folder.write("a.step", text);
  return read_assembly(folder / "a.step");
}

inline Assembly read(const StepText& step) {
  return read_step_text(step.text());
}

inline std::string refusal(const StepText& step) {
  return refusal([&] { read(step); });
}

/// A part that is StepText::block(), `x_mm` beside its place.
inline void check_block(const Assembly& a, std::size_t part, double x_mm = 0) {
  check_box(box_of(a, part), {1e-3 * x_mm, 0, 0}, {0.04 + 1e-3 * x_mm, 0.03, 0.01});
  CHECK(report(*a.shapes[a.parts[part].shape]).inverted_shells == 0);
}

inline std::string r(int id) {
  return StepText::ref(id);
}

/// `text` with each name replaced by the reference to it.
inline std::string with_ids(std::string text, const std::vector<std::pair<std::string, int>>& ids) {
  for (const auto& [name, id] : ids)
    for (std::size_t at; (at = text.find(name)) != std::string::npos;) text.replace(at, name.size(), r(id));
  return text;
}

}  // namespace tegotae::test
