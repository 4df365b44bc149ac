#include "loop/friction_pairs.hpp"

#include <algorithm>
#include <string>

#include "loop/scene_parts.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

double checked(double mu, const std::string& what) {
  if (mu >= 0 && mu <= kMaxMu) return mu;
  throw Error(ErrorKind::setting,
              what + ": the coefficient of friction must be from 0 to 10, not " + std::to_string(mu),
              {{}, 0, "friction", {}});
}

}  // namespace

std::vector<double> friction_of_parts(const Scene& scene) {
  const std::string& held = held_part(scene).name;
  std::vector<double> mu(scene.parts.size(), checked(scene.friction.mu, "friction"));
  for (const PairFriction& pair : scene.friction.pairs) {
    checked(pair.mu, "friction between " + pair.a + " and " + pair.b);
    for (std::size_t i = 0; i < mu.size(); ++i) {
      const std::string& fixed = scene.parts[i].name;
      if ((pair.a == held && pair.b == fixed) || (pair.b == held && pair.a == fixed)) mu[i] = pair.mu;
    }
  }
  const bool rubs = std::any_of(mu.begin(), mu.end(), [](double m) { return m > 0; });
  if (rubs && !scene.contact.custom_resolver && scene.contact.resolver != ResolverKind::qp)
    throw Error(ErrorKind::setting,
                "friction: the resolver " + to_string(scene.contact.resolver) + " does not support friction; qp does",
                {{}, 0, "friction", {}});
  return mu;
}

}  // namespace tegotae
