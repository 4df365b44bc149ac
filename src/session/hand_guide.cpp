#include "session/hand_guide.hpp"

#include <cstdio>

#include "session/guide_pull.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae {

std::optional<PathGuide> make_guide(const SceneFile& file, const RunSettings& settings, const HapticLoop& loop) {
  if (settings.guide_path.empty()) return std::nullopt;
  return guide_along(read_path(settings.guide_path), file.scene, loop);
}

std::string guide_text(PathGuide guide, const Pose& X) {
  guide.pull(X, 0);
  char text[240];
  std::snprintf(text, sizeof text,
                "%.3g N and %.3g mN·m at most, along %.4g mm of path; none farther than %.3g mm from it", guide.force(),
                1e3 * guide.torque(), 1e3 * guide.length(), 1e3 * PathGuide::kReach);
  std::string out = text;
  if (guide.distance() < PathGuide::kReach) return out;
  std::snprintf(text, sizeof text, " (it is %.3g mm off there now)", 1e3 * guide.distance());
  return out + text;
}

}  // namespace tegotae
