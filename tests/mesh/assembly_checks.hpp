#pragma once

#include <algorithm>
#include <string>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/assembly.hpp"
#include "tegotae/mesh/report.hpp"

namespace tegotae::test {

/// What the Error of `action` says; empty without one.
template <class Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// The same of reading the parts of a file.
inline std::string refusal(const std::string& path) {
  return refusal([&] { read_assembly(path); });
}

inline bool has_note(const Assembly& a, const std::string& text) {
  for (const std::string& note : a.notes)
    if (note.find(text) != std::string::npos) return true;
  return false;
}

/// The part of that name, which must be there.
inline const AssemblyPart& part(const Assembly& a, const std::string& name) {
  const auto found = std::find_if(a.parts.begin(), a.parts.end(), [&](const auto& p) { return p.name == name; });
  INFO(name);
  REQUIRE(found != a.parts.end());
  return *found;
}

/// Around a part where it stands, m.
inline Eigen::AlignedBox3d box_of(const Assembly& a, std::size_t part) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : a.shapes[a.parts[part].shape]->vertices) box.extend(a.parts[part].pose * p);
  return box;
}

inline void check_box(const Eigen::AlignedBox3d& box, const Vec3& lo, const Vec3& hi, double within = 1e-9) {
  INFO(box.min().transpose() << " to " << box.max().transpose());
  CHECK((box.min() - lo).norm() < within);
  CHECK((box.max() - hi).norm() < within);
}

}  // namespace tegotae::test
