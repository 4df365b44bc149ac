#include "sim/proxy_loop.hpp"

#include "sim/contact_loop.hpp"
#include "sim/impulse_loop.hpp"
#include "sim/penalty_loop.hpp"

namespace tegotae {

std::unique_ptr<ProxyLoop> make_proxy_loop(const Scene& scene, const ContactSettings& settings,
                                           const MassProperties& mass) {
  if (settings.custom_resolver) return std::make_unique<ContactLoop>(scene, settings, mass);
  if (settings.resolver == "impulse") return std::make_unique<ImpulseLoop>(scene, settings, mass);
  if (settings.resolver == "penalty") return std::make_unique<PenaltyLoop>(scene, settings, mass);
  return std::make_unique<ContactLoop>(scene, settings, mass);
}

}  // namespace tegotae
