#include "tegotae/resolve/kind.hpp"

#include <algorithm>

#include "tegotae/core/error.hpp"

namespace tegotae {

const std::vector<std::string>& resolver_names() {
  static const std::vector<std::string> names{"qp", "lp", "impulse", "penalty"};  // in the order of ResolverKind
  return names;
}

const std::string& to_string(ResolverKind kind) {
  return resolver_names().at(static_cast<std::size_t>(kind));
}

ResolverKind resolver_kind(const std::string& name) {
  const auto& names = resolver_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw Error(ErrorKind::setting, "unknown resolver \"" + name + "\"; known are qp, lp, impulse, penalty");
  return static_cast<ResolverKind>(at - names.begin());
}

}  // namespace tegotae
