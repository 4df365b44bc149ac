#include "session/hand_guide.hpp"

#include "core/number_text.hpp"
#include "session/guide_pull.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae {

std::optional<PathGuide> make_guide(const SceneFile& file, const RunSettings& settings, const HapticLoop& loop) {
  if (settings.guide_path.empty()) return std::nullopt;
  return guide_along(read_path(settings.guide_path), file.scene, loop);
}

std::string guide_text(PathGuide guide, const Pose& X) {
  guide.pull(X, 0);
  const std::string text = number_text(guide.force(), 3) + " N and " + number_text(1e3 * guide.torque(), 3) +
                           " mN·m at most, along " + number_text(1e3 * guide.length(), 4) +
                           " mm of path; none farther than " + number_text(1e3 * PathGuide::kReach, 3) + " mm from it";
  if (guide.distance() < PathGuide::kReach) return text;
  return text + " (it is " + number_text(1e3 * guide.distance(), 3) + " mm off there now)";
}

}  // namespace tegotae
