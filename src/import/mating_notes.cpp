#include "import/mating_notes.hpp"

#include <algorithm>

#include "import/note_texts.hpp"

namespace tegotae {
namespace {

const char* names_of(FaceKind kind) {
  switch (kind) {
    case FaceKind::cone:
      return "cones";
    case FaceKind::sphere:
      return "spheres";
    case FaceKind::torus:
      return "tori";
    default:
      return "free-form faces";
  }
}

}  // namespace

void MatingNotes::add(const AssemblyPart& a, const AssemblyPart& b, FaceKind kind) {
  if (kind == FaceKind::cylinder) return;
  Pair& pair = pairs_[std::minmax(a.shape, b.shape)];
  if (pair.kinds.empty()) pair.names = '"' + a.name + "\" and \"" + b.name + '"';
  pair.kinds.insert(kind);
}

void MatingNotes::report(double chord, ImportNotes& notes) const {
  for (const auto& [shapes, pair] : pairs_) {
    std::string kinds;
    for (const FaceKind kind : pair.kinds) kinds += (kinds.empty() ? "" : " and ") + std::string(names_of(kind));
    notes.add(note_texts::kMayMate, pair.names + " in " + kinds, chord);
  }
}

}  // namespace tegotae
