#include "session/hand_guide.hpp"

#include <algorithm>
#include <cstdio>

#include "tegotae/core/error.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae {
namespace {

// Of what the weight leaves of the force that the device stands for long; the rest is for contacts.
constexpr double kGuideShare = 0.5;

double strongest(const Scene& scene, const HapticLoop& loop) {
  if (!scene.weight.max_force) return PathGuide::kForce;
  // Half of what the device stands for is the most of the weight.
  const double left = 2 * *scene.weight.max_force - loop.weight().force.norm();
  return std::clamp(kGuideShare * left, 0.0, PathGuide::kForce);
}

}  // namespace

std::optional<PathGuide> make_guide(const SceneFile& file, const RunSettings& settings, const HapticLoop& loop) {
  if (settings.guide_path.empty()) return std::nullopt;
  const ResolverKind resolver = file.scene.contact.resolver;
  if (!file.scene.contact.custom_resolver && resolver != ResolverKind::qp)
    throw Error("guide: the resolver " + to_string(resolver) + " knows no load; qp does");
  PathGuideSettings guide;
  guide.coupling = loop.coupling();
  guide.scale = file.scene.scale;
  guide.center = loop.center();
  guide.force = strongest(file.scene, loop);
  return PathGuide(read_path(settings.guide_path), guide);
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
