#include "session/torsion.hpp"

#include "core/number_text.hpp"
#include "loop/held_weight.hpp"
#include "tegotae/coupling/stability.hpp"
#include "tegotae/transport/channel.hpp"

namespace tegotae {

namespace {

constexpr const char* kDeviceScheme = "shm:";

std::string stiffness_text(double stiffness) {
  return number_text(stiffness, 3) + " N·m/rad";
}

}  // namespace

Scene bounded_by(Scene scene, const std::string& device) {
  if (device.rfind(kDeviceScheme, 0) != 0) return scene;
  tegotae_shm_device device_info{};
  // A device that has written nothing yet is one of which nothing is known.
  ChannelReader::open(device.substr(std::string(kDeviceScheme).size())).read(device_info);
  if (scene.max_torsional_stiffness)
    scene.max_torsional_stiffness =
        torsional_stiffness_bound(device_info.torsional_stiffness_limit, device_info.torque_limit);
  scene.weight.max_force = weight_bound(device_info.continuous_force);
  return scene;
}

std::string torsion_text(const Scene& scene, const HapticLoop& loop) {
  const double chosen = loop.coupling().torsional_stiffness;
  if (!scene.max_torsional_stiffness) return stiffness_text(chosen) + ", as set";
  const double radius = loop.radius_of_gyration() / scene.scale;
  const double fitting = loop.coupling().stiffness * radius * radius;
  const std::string rule =
      "stiffness x (radius of gyration, " + number_text(1e3 * radius, 3) + " mm)^2 = " + stiffness_text(fitting);
  if (chosen > fitting) return stiffness_text(chosen) + ", the minimum; " + rule;
  if (chosen < fitting) return stiffness_text(chosen) + ", the maximum for this device; " + rule;
  return stiffness_text(chosen) + "; " + rule;
}

}  // namespace tegotae
