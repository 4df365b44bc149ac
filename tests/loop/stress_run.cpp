#include "stress_run.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "path_oracle.hpp"
#include "stress_record.hpp"
#include "tegotae/core/clock.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae::test {
namespace {

// Shorter ways (m) are not looked into: the gap that the loop keeps is larger.
constexpr double kRestingPiece = 1e-6;
// What a tick does after it last looked at the clock (ns), generously.
constexpr std::int64_t kAfterLastLook = 20'000;

std::int64_t cpu_ns() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

/// Names a tick of a script, as one runs it again.
std::string place(const StressScene& stress, unsigned seed, const StressOptions& options, int tick) {
  return stress.name + " seed " + std::to_string(seed) + " resolver " + options.resolver + " tick " +
         std::to_string(tick);
}

/// Counts a tick that took `took` ns and does not say that it was late.
void count_late(StressResult& result, const TickReport& r, std::int64_t took, double budget, const std::string& where) {
  if (!(budget > 0) || r.flags.timed_out || 1e-9 * static_cast<double>(took - kAfterLastLook) <= budget) return;
  ++result.late_unreported;
  if (result.first_late.empty()) result.first_late = where + ", " + std::to_string(took / 1000) + " us";
}

double radius(const TriangleMesh& mesh, const Vec3& center) {
  double r = 0;
  for (const Vec3& v : mesh.vertices) r = std::max(r, (v - center).norm());
  return r;
}

}  // namespace

void StressResult::add(const StressResult& o) {
  scripts += o.scripts, ticks += o.ticks, substeps += o.substeps, poses += o.poses, intersecting += o.intersecting;
  touching += o.touching, timed_out += o.timed_out, overflow += o.overflow, infeasible += o.infeasible,
      stalled += o.stalled;
  out_of_time += o.out_of_time, out_of_capacity += o.out_of_capacity, unexplained += o.unexplained;
  late_unreported += o.late_unreported, seconds_loop += o.seconds_loop, seconds_check += o.seconds_check;
  if (first_intersecting.empty()) first_intersecting = o.first_intersecting;
  if (first_late.empty()) first_late = o.first_late;
}

StressResult run_stress_script(const StressScene& stress, unsigned seed, const StressOptions& options,
                               LatencyHistogram& cpu) {
  StressResult result;
  result.scripts = 1;
  Scene scene = stress.scene;
  scene.contact.resolver = resolver_kind(options.resolver);
  scene.friction.mu = options.mu;
  scene.contact.tick_budget = options.budget > 0 ? options.budget : std::numeric_limits<double>::infinity();
  HapticLoop loop(scene);
  const FclOracle oracle(scene);
  const Part& held = *std::find_if(scene.parts.begin(), scene.parts.end(), [](const Part& p) { return p.held; });
  const double size = radius(*held.mesh, loop.center());
  StressScript script(seed, held.pose, loop.center(), size, stress.envelope);
  std::unique_ptr<StressRecord> record;
  if (!options.record.empty()) record = std::make_unique<StressRecord>(options.record, stress, seed);
  Pose last = held.pose;
  const auto ask = [&](const Pose& X, int tick, const char* where) {
    ++result.poses;
    const auto names = oracle.intersecting(X);
    if (names.empty()) return;
    ++result.intersecting;
    if (!result.first_intersecting.empty()) return;
    result.first_intersecting = place(stress, seed, options, tick) + " (" + where + ") with " + names.front();
  };
  for (int tick = 0; tick < options.ticks; ++tick) {
    const Pose Y = script.next();
    const std::int64_t begin = cpu_ns();
    const TickReport& r = loop.step(Y, 0.001);
    const std::int64_t took = cpu_ns() - begin;
    cpu.add(took);
    if (record) record->add(tick, Y, r);
    ++result.ticks;
    result.touching += r.proxy.touching;
    result.timed_out += r.flags.timed_out;
    result.overflow += r.flags.overflow;
    result.infeasible += r.status == ResolveStatus::infeasible;
    result.stalled += r.status == ResolveStatus::stalled;
    if (r.lag > loop.lag_bound()) {
      result.out_of_time += r.lag_reason == LagReason::time;
      result.out_of_capacity += r.lag_reason == LagReason::capacity;
    }
    count_late(result, r, took, options.budget, place(stress, seed, options, tick));
    result.seconds_loop += 1e-9 * static_cast<double>(took);
    const std::int64_t checking = cpu_ns();
    for (const Pose& X : r.substeps) {
      ++result.substeps;
      if (travel(last, X, loop.center(), size) > kRestingPiece)
        for_poses_between(last, X, loop.center(), options.between + 1,
                          result.substeps % 2 == 0 ? PathKind::center : PathKind::origin,
                          [&](const Pose& P) { ask(P, tick, "on the way"); });
      if (!(X.p == last.p && X.q.coeffs() == last.q.coeffs())) ask(X, tick, "committed");
      last = X;
    }
    result.seconds_check += 1e-9 * static_cast<double>(cpu_ns() - checking);
  }
  if (record) record->close();
  result.unexplained = loop.report().unexplained_lag_ticks;
  return result;
}

}  // namespace tegotae::test
