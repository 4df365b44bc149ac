#include "shared/blocked_text.hpp"

#include <cmath>

#include "shared/format.hpp"

namespace tegotae::apps {

std::string place_text(const Vec3& p) {
  // Rounded first, so that there is no "-0.00".
  const auto mm = [](double m) { return 0.01 * std::round(1e5 * m) + 0.0; };
  return format("(%.2f, %.2f, %.2f) mm", mm(p.x()), mm(p.y()), mm(p.z()));
}

std::string blocked_text(const Blocker& blocker) {
  if (blocker.part.empty()) return "nothing blocked it at the end; the hand did not bring it there";
  return "blocked by " + blocker.part + " at " + place_text(blocker.place_W);
}

}  // namespace tegotae::apps
