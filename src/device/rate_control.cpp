#include "device/rate_control.hpp"

#include <algorithm>
#include <cmath>

#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

void require(bool good, const char* setting) {
  if (!good)
    throw Error(ErrorKind::setting, std::string("rate control: ") + setting + " is out of range", {{}, 0, setting, {}});
}

bool positive(double x) {
  return std::isfinite(x) && x > 0;
}

/// Speed (of the full one) and direction; the dead zone is round, so that no direction is favored.
Vec3 shaped(const Vec3& deflection, double dead_zone) {
  const double size = deflection.norm();
  if (!(size > dead_zone) || !std::isfinite(size)) return Vec3::Zero();
  const double beyond = std::min(1.0, (size - dead_zone) / (1.0 - dead_zone));
  return beyond * beyond / size * deflection;
}

/// `step`, cut so that lead + step does not grow beyond `reach`.
Vec3 within_reach(const Vec3& lead, const Vec3& step, double reach) {
  const Vec3 next = lead + step;
  const double most = std::max(reach, lead.norm());
  return next.norm() <= most ? step : Vec3(next * (most / next.norm()) - lead);
}

}  // namespace

RateControl::RateControl(const RateControlSettings& settings) : settings_(settings) {
  require(positive(settings.speed), "speed");
  require(positive(settings.turn_rate), "turn_rate");
  require(settings.dead_zone >= 0 && settings.dead_zone < 1, "dead_zone");
  require(positive(settings.reach), "reach");
  require(positive(settings.turn_reach), "turn_reach");
}

void RateControl::step(const Deflection& deflection, double dt, const Displacement& lead) noexcept {
  velocity_ = {};
  if (!(dt > 0) || !lead.dp.allFinite() || !lead.dr.allFinite()) return;
  const Vec3 dp = dt * settings_.speed * shaped(deflection.linear, settings_.dead_zone);
  const Vec3 dr = dt * settings_.turn_rate * shaped(deflection.angular, settings_.dead_zone);
  const Displacement made = {within_reach(lead.dp, dp, settings_.reach),
                             within_reach(lead.dr, dr, settings_.turn_reach)};
  pose_ = displaced(pose_, Vec3::Zero(), made);
  velocity_ = {made.dp / dt, made.dr / dt};
}

}  // namespace tegotae
