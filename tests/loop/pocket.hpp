// Random scenes with a pocket for the held part.
#pragma once

#include <cmath>
#include <string>

#include "bodies.hpp"
#include "tegotae/loop/scene.hpp"

namespace tegotae::test {

/// A body of about `size` (m) over a ring of `others` larger ones, all from random points: lowered, it is wedged
/// between them. Ticks have no budget.
inline Scene pocket(unsigned seed, double size, int others) {
  std::mt19937 rng(seed);
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  const auto body = [&](double s) {
    return shared(seed % 2 == 0 ? random_convex_body(rng, 12, s) : random_star_body(rng, 12, s));
  };
  for (int k = 0; k < others; ++k) {
    const double angle = 2 * M_PI * k / others;
    scene.parts.push_back(
        {"fixed" + std::to_string(k),
         body(1.5 * size),
         {rotation(3 * random_direction(rng)), {1.5 * size * std::cos(angle), 1.5 * size * std::sin(angle), 0}},
         false});
  }
  scene.parts.push_back({"held", body(size), {rotation(random_direction(rng)), {0, 0, 4.5 * size}}, true});
  return scene;
}

}  // namespace tegotae::test
