#include "scene_file/scene_friction.hpp"

#include <algorithm>
#include <string>

#include "loop/friction_pairs.hpp"

namespace tegotae {
namespace {

double read_mu(const TomlTable& t, double fallback) {
  const double mu = t.at_least_zero("mu", fallback);
  if (mu > kMaxMu) t.fail("mu", "must be at most 10");
  return mu;
}

}  // namespace

void read_friction(const TomlTable& top, Scene& scene) {
  const TomlTable t = top.table("friction", {"mu", "pair"});
  scene.friction.mu = read_mu(t, scene.friction.mu);
  const bool any = scene.friction.mu > 0;
  bool rubs = any;
  for (const TomlTable& pair : t.tables("pair", {"parts", "mu"})) {
    const std::vector<std::string> names = pair.texts("parts");
    if (names.size() != 2) pair.fail("parts", "must be the names of two parts");
    for (const std::string& name : names)
      if (std::none_of(scene.parts.begin(), scene.parts.end(), [&](const Part& p) { return p.name == name; }))
        pair.fail("parts", "no part is named " + name);
    if (!pair.has("mu")) pair.fail("mu", "is missing");
    scene.friction.pairs.push_back({names[0], names[1], read_mu(pair, 0)});
    rubs |= scene.friction.pairs.back().mu > 0;
  }
  if (rubs && scene.contact.resolver != ResolverKind::qp)
    t.fail(any ? "mu" : "pair",
           "the resolver " + to_string(scene.contact.resolver) + " does not support friction; qp does");
}

}  // namespace tegotae
