#include "session/fit_watch.hpp"

#include <algorithm>

#include "broadphase/bounding_spheres.hpp"
#include "loop/scene_parts.hpp"

namespace tegotae {

namespace {

// What HeldFast says: the pen's way (m), the same by the part's, and how long (s).
constexpr double kGone = 1e-3, kFarther = 10, kStanding = 0.5;

}  // namespace

FitWatch::FitWatch(const HapticLoop& loop, const Scene& scene)
    : center_(loop.center()),
      radius_(radius_about(*held_part(scene).mesh, loop.center())),
      start_(loop.report().proxy.X) {}

void FitWatch::begin(const Pose& X) noexcept {
  start_ = X;
  first_ = held_ = false;
}

void FitWatch::update(const HapticLoop& loop, const Pose& Y, double dt, HeldFast& found) noexcept {
  held_ = false;
  if (!first_ || loop.change_in_force() != 0) return;
  const double moved = size(displacement(start_, loop.report().proxy.X, center_));
  const double pen = size(displacement(start_, Y, center_));
  const bool stands = pen > kGone && pen > kFarther * moved;
  standing_ = stands ? standing_ + dt : 0;
  held_ = standing_ >= kStanding;
  if (!held_) return;
  found.parts.clear();
  found.moved = moved;
  found.pen = pen;
  for (const InitialContact& pair : loop.start().pairs) {
    if (pair.state != InitialContactState::shrunk) continue;
    const bool touches = std::any_of(loop.constraints().begin(), loop.constraints().end(), [&](const Contact& c) {
      return c.part.index == pair.part && c.gap <= loop.report().contact_gap;
    });
    if (touches) found.parts.push_back(pair.part);
  }
}

}  // namespace tegotae
