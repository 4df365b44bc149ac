#include "bench/measure_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tegotae/core/clock.hpp"

namespace tegotae::bench {
namespace {

constexpr double kPeriod = 1e-3;  // s

}  // namespace

LoopFigures measure_loop(const BenchScene& scene, HapticLoop& loop, const PenSpeed& speed, int rounds,
                         LoopTrace& trace) {
  std::vector<Pose> way;
  for (int i = 0; i < rounds && scene.add_round; ++i) scene.add_round(i, way);
  const StylusScript script(scene.pen ? timed(scene.pen, scene.pen_seconds, speed) : timed(way, speed));
  const auto ticks = static_cast<std::size_t>(std::ceil(script.end() / kPeriod)) + 1;
  const std::size_t stride = std::max<std::size_t>(ticks / static_cast<std::size_t>(scene.most_fcl_poses), 1);

  LoopFigures f;
  std::vector<std::int64_t> wall, cpu;
  wall.reserve(ticks);
  cpu.reserve(ticks);
  trace.ticks.clear();
  trace.ticks.reserve(ticks);
  trace.start = loop.report().proxy.X;
  double lowest = 0;
  f.fifo = on_measuring_thread([&] {
    Rest rest;
    for (std::size_t k = 0; k < ticks; ++k) {
      const Pose Y = script.pose(kPeriod * static_cast<double>(k));
      rest.pause_if_due();
      const std::int64_t cpu0 = thread_cpu_ns(), wall0 = monotonic_ns();
      const TickReport& r = loop.step(Y, kPeriod);
      const std::int64_t wall1 = monotonic_ns(), cpu1 = thread_cpu_ns();
      trace.ticks.push_back({r.proxy.X, Y});
      if (scene.tip) lowest = std::min(lowest, (r.proxy.X * *scene.tip).z());
      if (k % stride == 0) {
        for (const Pose& X : r.substeps) trace.committed.add(X);
        trace.checked += static_cast<std::int64_t>(r.substeps.size());
      }
      if (r.contacts == 0 && !r.flags.timed_out && !scene.all_ticks) continue;
      wall.push_back(wall1 - wall0);
      cpu.push_back(cpu1 - cpu0);
      f.contacts += r.contacts;
      f.contacts_max = std::max(f.contacts_max, r.contacts);
      f.limits += r.constraints;
      f.resolves += r.resolves;
      f.candidate_parts += r.candidate_parts;
      f.cut += r.flags.timed_out;
      f.overflow += r.flags.overflow;
      if (k % stride == 0) {
        trace.X.push_back(r.proxy.X);
        trace.Y.push_back(Y);
      }
    }
  });
  f.ticks = ticks;
  f.in_contact = wall.size();
  f.tick_us = percentiles(wall);
  f.tick_cpu_us = percentiles(cpu);
  const double n = static_cast<double>(std::max<std::size_t>(f.in_contact, 1));
  f.contacts /= n;
  f.limits /= n;
  f.resolves /= n;
  f.candidate_parts /= n;
  f.depth = scene.tip ? -lowest : std::numeric_limits<double>::quiet_NaN();
  return f;
}

}  // namespace tegotae::bench
