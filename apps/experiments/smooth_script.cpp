#include "experiments/smooth_script.hpp"

#include <cmath>

namespace tegotae::experiments {

StylusScript smooth_script(const std::vector<StylusScript::Key>& keys) {
  constexpr double kStep = 0.01;
  std::vector<StylusScript::Key> out{keys.front()};
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const auto &a = keys[i - 1], &b = keys[i];
    const Displacement way = displacement(a.pose, b.pose, Vec3::Zero());
    const int n = static_cast<int>(std::ceil((b.t - a.t) / kStep));
    for (int k = 1; k <= n; ++k) {
      const double u = static_cast<double>(k) / n, s = u * u * u * (10 + u * (6 * u - 15));
      out.push_back({a.t + u * (b.t - a.t), displaced(a.pose, Vec3::Zero(), s * way)});
    }
  }
  return StylusScript(std::move(out));
}

}  // namespace tegotae::experiments
