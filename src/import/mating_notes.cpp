#include "import/mating_notes.hpp"

#include <algorithm>

#include "core/number_text.hpp"

namespace tegotae {
namespace {

constexpr std::size_t kMaxLines = 5;  // and one that says how many more there are

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

void MatingNotes::tell(double chord, std::vector<std::string>& notes) const {
  const std::string advice = ": facets reach up to " + number_text(1e6 * chord, 3) +
                             " um into the clearance; for a fit with less play take a smaller --chord";
  std::size_t lines = 0;
  for (const auto& [shapes, pair] : pairs_) {
    if (++lines > kMaxLines) break;
    std::string kinds;
    for (const FaceKind kind : pair.kinds) kinds += (kinds.empty() ? "" : " and ") + std::string(names_of(kind));
    notes.push_back(pair.names + " may mate in " + kinds + advice);
  }
  if (pairs_.size() > kMaxLines)
    notes.push_back(std::to_string(pairs_.size() - kMaxLines) + " more pairs of parts may mate in such faces");
}

}  // namespace tegotae
