#include "shared/blocked_text.hpp"

#include "core/number_text.hpp"

namespace tegotae::apps {

std::string place_text(const Vec3& p) {
  const auto mm = [](double m) { return fixed_text(1e3 * m, 2); };
  return "(" + mm(p.x()) + ", " + mm(p.y()) + ", " + mm(p.z()) + ") mm";
}

std::string blocked_text(const Blocker& blocker) {
  if (blocker.part.empty()) return "nothing blocked it at the end; the hand did not bring it there";
  return "blocked by " + blocker.part + " at " + place_text(blocker.place_W);
}

}  // namespace tegotae::apps
