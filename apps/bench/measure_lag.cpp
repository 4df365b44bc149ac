#include "bench/measure_lag.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/timing.hpp"

namespace tegotae::bench {
namespace {

constexpr double kLagPeriod = 1e-3;                // s
constexpr double kPulls = 1e-3;                    // N
constexpr std::int64_t kLongest = 30'000'000'000;  // ns, of CPU time

const Part& held_part_of(const Scene& scene) {
  return *std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; });
}

double at(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size()))) - 1];
}

}  // namespace

Scene without_budget(Scene scene, const Pose& start) {
  scene.contact.tick_budget = std::numeric_limits<double>::infinity();
  std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; })->pose = start;
  return scene;
}

LagFigures measure_lag(const BenchScene& scene, HapticLoop& unlimited, const LoopTrace& trace) {
  LagFigures f;
  const Vec3 center = unlimited.center();
  const double stiffness = unlimited.coupling().stiffness;
  double radius = 0;
  for (const Vec3& v : held_part_of(scene.scene).mesh->vertices) radius = std::max(radius, (v - center).norm());
  std::vector<double> off;
  off.reserve(trace.ticks.size());
  double force2 = 0, error2 = 0;
  std::size_t pulls = 0;
  const std::int64_t begin = thread_cpu_ns();
  for (const LoopTrace::Tick& tick : trace.ticks) {
    if (thread_cpu_ns() - begin > kLongest) break;
    const Pose X = unlimited.step(tick.Y, kLagPeriod).proxy.X;
    const Displacement d = displacement(X, tick.X, center);
    off.push_back(d.dp.norm() + radius * d.dr.norm());
    const double force = stiffness * (X * center - tick.Y * center).norm(), error = stiffness * d.dp.norm();
    f.error_most = std::max(f.error_most, error);
    if (force < kPulls) continue;
    force2 += force * force;
    error2 += error * error;
    ++pulls;
  }
  f.ticks = off.size();
  std::sort(off.begin(), off.end());
  if (!off.empty()) f.p50 = at(off, 0.5), f.p99 = at(off, 0.99), f.most = off.back();
  f.error_share = std::numeric_limits<double>::quiet_NaN();
  if (pulls == 0) return f;
  f.force_rms = std::sqrt(force2 / static_cast<double>(pulls));
  f.error_rms = std::sqrt(error2 / static_cast<double>(pulls));
  f.error_share = f.error_rms / f.force_rms;
  return f;
}

}  // namespace tegotae::bench
