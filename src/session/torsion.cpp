#include "session/torsion.hpp"

#include <cstdio>

#include "loop/held_weight.hpp"
#include "tegotae/coupling/stability.hpp"
#include "tegotae/transport/channel.hpp"

namespace tegotae {

namespace {

constexpr const char* kDeviceScheme = "shm:";

std::string format(const char* pattern, double a, double b = 0, double c = 0) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b, c);
  return text;
}

}  // namespace

Scene bounded_by(Scene scene, const std::string& device) {
  if (device.rfind(kDeviceScheme, 0) != 0) return scene;
  tegotae_shm_device told{};
  // A device that has written nothing yet is one of which nothing is known.
  ChannelReader::open(device.substr(std::string(kDeviceScheme).size())).read(told);
  if (scene.max_torsional_stiffness)
    scene.max_torsional_stiffness = torsional_stiffness_bound(told.torsional_stiffness_limit, told.torque_limit);
  scene.weight.max_force = weight_bound(told.continuous_force);
  return scene;
}

std::string torsion_text(const Scene& scene, const HapticLoop& loop) {
  const double chosen = loop.coupling().torsional_stiffness;
  if (!scene.max_torsional_stiffness) return format("%.3g N·m/rad, as set", chosen);
  const double radius = loop.radius_of_gyration() / scene.scale;
  const double fitting = loop.coupling().stiffness * radius * radius;
  const std::string rule = format("stiffness x (radius of gyration, %.3g mm)^2 = %.3g N·m/rad", 1e3 * radius, fitting);
  if (chosen > fitting) return format("%.3g N·m/rad, the minimum; ", chosen) + rule;
  if (chosen < fitting) return format("%.3g N·m/rad, the maximum for this device; ", chosen) + rule;
  return format("%.3g N·m/rad; ", chosen) + rule;
}

}  // namespace tegotae
