#include "loop/proxy_loop.hpp"

#include <limits>
#include <utility>

#include "loop/contact_loop.hpp"
#include "loop/impulse_loop.hpp"
#include "loop/penalty_loop.hpp"

namespace tegotae {

void reset(TickReport& report) noexcept {
  std::vector<Pose> substeps = std::move(report.substeps);
  substeps.clear();
  report = {};
  report.substeps = std::move(substeps);
  report.gap = std::numeric_limits<double>::infinity();
}

std::unique_ptr<ProxyLoop> make_proxy_loop(const Scene& scene, const ContactSettings& settings,
                                           const MassProperties& mass) {
  if (settings.custom_resolver) return std::make_unique<ContactLoop>(scene, settings, mass);
  if (settings.resolver == ResolverKind::impulse) return std::make_unique<ImpulseLoop>(scene, settings, mass);
  if (settings.resolver == ResolverKind::penalty) return std::make_unique<PenaltyLoop>(scene, settings, mass);
  return std::make_unique<ContactLoop>(scene, settings, mass);
}

}  // namespace tegotae
