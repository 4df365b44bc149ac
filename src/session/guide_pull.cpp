#include "session/guide_pull.hpp"

#include "tegotae/core/error.hpp"

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

PathGuide guide_along(const std::vector<Pose>& path, const Scene& scene, const HapticLoop& loop) {
  const ResolverKind resolver = scene.contact.resolver;
  if (!scene.contact.custom_resolver && resolver != ResolverKind::qp)
    throw Error(ErrorKind::setting, "guide: the resolver " + to_string(resolver) + " does not support a load; qp does");
  PathGuideSettings guide;
  guide.coupling = loop.coupling();
  guide.scale = scene.scale;
  guide.center = loop.center();
  guide.force = strongest(scene, loop);
  return PathGuide(path, guide);
}

}  // namespace tegotae
