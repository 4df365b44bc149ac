#include <cmath>

#include "bench/results.hpp"
#include "core/number_text.hpp"
#include "shared/format.hpp"

namespace tegotae::bench {
namespace {

// Of a tick's budget, for what ends after the last look at the clock, µs.
constexpr double kBudgetSlack = 100;
// The paper-sized programs are to beat GLPK by this much at this many contacts.
constexpr int kGlpkRows = 64;
constexpr double kGlpkRatio = 25;
// Hierarchies: µs and bytes a triangle.
constexpr double kMaxBuildUs = 2, kMaxBytes = 160;
constexpr double kMaxGrowth = 3;
// A tick with friction by one without, and the most that it takes (p99.9, µs).
constexpr double kMaxFriction = 1.5, kMaxTick = 900;
// From files to the first tick, s.
constexpr double kMaxFirstStart = 1.2, kMaxSecondStart = 0.15;
// How near (m) a peg comes to the bottom of its hole when it is pressed on it.
constexpr double kArrived = 1e-4;

using apps::format;

std::string number(double x) {
  if (!std::isfinite(x)) return "–";
  return std::abs(x) < 10 ? number_text(x, 2) : fixed_text(x, 0);
}

std::string count(std::size_t n) {
  if (n < 10000) return std::to_string(n);
  return n < 950000 ? format("%.0f k", 1e-3 * static_cast<double>(n)) : format("%.1f M", 1e-6 * static_cast<double>(n));
}

std::string verdict(bool met) {
  return met ? "met" : "**missed**";
}

std::string targets_table(const Results& r) {
  std::string text =
      "| scene | triangles | median (target), µs | p99.9 (target), µs | FCL median / p99, µs | faster than FCL "
      "(target) | "
      "verdict |\n|---|---|---|---|---|---|---|\n";
  for (const SceneFigures& s : r.rows) {
    const double ratio = s.fcl.us.p50 / s.hand.tick_us.p50;
    std::string missed;
    if (!(s.hand.tick_us.p50 <= s.targets.p50_us)) missed += "median ";
    if (!(s.hand.tick_us.p999 <= s.targets.p999_us)) missed += "p99.9 ";
    if (s.targets.fcl_ratio > 0 && !(ratio >= s.targets.fcl_ratio)) missed += "ratio ";
    if (s.intersecting > 0) missed += "free ";
    // A peg that stayed outside was not measured in its jams.
    if (s.depth > 0 && !(s.hand.depth >= s.depth - kArrived)) missed += "bottom ";
    text +=
        format("| `%s` | %s / %s | %s (%s) | %s (%s) | %s / %s | %s × (%s) | ", s.scene.c_str(),
               count(s.held_triangles).c_str(), count(s.fixed_triangles).c_str(), number(s.hand.tick_us.p50).c_str(),
               number(s.targets.p50_us).c_str(), number(s.hand.tick_us.p999).c_str(), number(s.targets.p999_us).c_str(),
               number(s.fcl.us.p50).c_str(), number(s.fcl.us.p99).c_str(), number(ratio).c_str(),
               s.targets.fcl_ratio > 0 ? number(s.targets.fcl_ratio).c_str() : "–");
    text += missed.empty() ? "met |\n" : "**missed:** " + missed + "|\n";
  }
  return text;
}

void add_run(const std::string& scene, const char* speed, const LoopFigures& f, std::string& text) {
  text +=
      format("| `%s` | %s | %s / %s / %s / %s | %s / %s / %s / %s | %.0f / %d | %.0f | %.1f | %zu of %zu |",
             scene.c_str(), speed, number(f.tick_us.p50).c_str(), number(f.tick_us.p99).c_str(),
             number(f.tick_us.p999).c_str(), number(f.tick_us.max).c_str(), number(f.tick_cpu_us.p50).c_str(),
             number(f.tick_cpu_us.p99).c_str(), number(f.tick_cpu_us.p999).c_str(), number(f.tick_cpu_us.max).c_str(),
             f.contacts, f.contacts_max, f.limits, f.resolves, f.cut, f.in_contact);
  text += std::isfinite(f.depth) ? " " + fixed_text(1e3 * f.depth, 1) + " |\n" : " – |\n";
}

std::string runs_table(const Results& r) {
  std::string text =
      "| scene | pen | wall: median / p99 / p99.9 / max, µs | CPU: the same, µs | contacts mean / max | limits | "
      "programs | ticks cut | depth, mm |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const SceneFigures& s : r.rows) {
    add_run(s.scene, "hand", s.hand, text);
    add_run(s.scene, "fast", s.fast, text);
  }
  return text;
}

std::string checks_table(const Results& r) {
  std::string text =
      "| scene | hierarchy, µs a triangle (2) | bytes a triangle (160) | verdict | FCL poses that overlap | pairs, "
      "mean | "
      "committed poses that intersect |\n|---|---|---|---|---|---|---|\n";
  for (const SceneFigures& s : r.rows) {
    const bool met = s.build.us_per_triangle <= kMaxBuildUs && s.build.bytes_per_triangle <= kMaxBytes;
    text += format("| `%s` | %.2f | %.0f | %s | %zu of %zu | %.0f | %lld of %lld |\n", s.scene.c_str(),
                   s.build.us_per_triangle, s.build.bytes_per_triangle, verdict(met).c_str(), s.fcl.overlap,
                   s.fcl.poses, s.fcl.pairs, static_cast<long long>(s.intersecting), static_cast<long long>(s.checked));
  }
  return text;
}

std::string seat_table(const Results& r) {
  std::string text;
  for (const SceneFigures& s : r.rows) {
    if (!s.seat) continue;
    const SeatFigures& f = *s.seat;
    const SeatTargets& t = s.seat_targets;
    std::string missed;
    if (!(f.rest_us.p50 <= t.rest_p50_us)) missed += "rest ";
    if (!(f.arrival_ms <= t.arrival_ms)) missed += "arrival ";
    if (t.slide_mm_s > 0 && !(f.slide_mm_s >= t.slide_mm_s)) missed += "slide ";
    if (!(f.off_ms <= t.off_ms)) missed += "off ";
    text += format("| `%s` | %s / %s (%s) | %s / %s | %s (%s) | %.3f | %s (%s) | %s (%s) | %zu of %zu | ",
                   s.scene.c_str(), number(f.rest_us.p50).c_str(), number(f.rest_us.p999).c_str(),
                   number(t.rest_p50_us).c_str(), number(f.moving_us.p50).c_str(), number(f.moving_us.p999).c_str(),
                   number(f.arrival_ms).c_str(), number(t.arrival_ms).c_str(), 1e3 * f.above_seat,
                   number(f.slide_mm_s).c_str(), t.slide_mm_s > 0 ? number(t.slide_mm_s).c_str() : "–",
                   number(f.off_ms).c_str(), number(t.off_ms).c_str(), f.cut, f.ticks);
    text += missed.empty() ? "met |\n" : "**missed:** " + missed + "|\n";
  }
  if (text.empty()) return text;
  return "\n### On a seat\n\n| scene | at rest: median / p99.9 (target of the median), µs | moving in contact: median "
         "/ "
         "p99.9, µs | arrives after the pen (target), ms | rests over its seat, mm | slides (target), mm/s | off after "
         "the pen (target), ms | ticks cut | verdict |\n|---|---|---|---|---|---|---|---|---|\n" +
         text;
}

std::string start_table(const Results& r) {
  if (r.starts.empty()) return "";
  std::string text = "\n### Start\n\n| file | triangles | first start (" + number(kMaxFirstStart) +
                     "), s | second start (" + number(kMaxSecondStart) + "), s | verdict |\n|---|---|---|---|---|\n";
  for (const StartFigures& f : r.starts)
    text += format("| %s | %s | %.2f | %.3f | ", f.format.c_str(), count(f.triangles).c_str(), f.first_s, f.second_s) +
            verdict(f.first_s <= kMaxFirstStart && f.second_s <= kMaxSecondStart) + " |\n";
  return text;
}

std::string growth_line(const Results& r) {
  double first = NAN, last = NAN;
  for (const SceneFigures& s : r.rows) {
    if (s.scene == "2k/2k@0.99") first = s.hand.tick_us.p50;
    if (s.scene == "200k/200k@0.99") last = s.hand.tick_us.p50;
  }
  if (!std::isfinite(last / first)) return "";
  return format("\nGrowth of the median from 2 k to 200 k triangles at 0.99: %.1f × (at most 3): ", last / first) +
         verdict(last <= kMaxGrowth * first) + ".\n";
}

std::string budget_table(const Results& r) {
  std::string text;
  for (const SceneFigures& s : r.rows) {
    for (const BudgetFigures& b : s.budgets) {
      const double most = 1e6 * b.budget + kBudgetSlack;
      text +=
          format("| `%s` | %.1f | %s | %s | %s | %s | %zu of %zu | %lld of %lld | ", s.scene.c_str(), 1e3 * b.budget,
                 number(b.loop.tick_us.p999).c_str(), number(b.loop.tick_cpu_us.p999).c_str(), number(most).c_str(),
                 std::isfinite(b.loop.depth) ? number(1e3 * b.loop.depth).c_str() : "–", b.loop.cut, b.loop.in_contact,
                 static_cast<long long>(b.intersecting), static_cast<long long>(b.checked));
      text += verdict(b.loop.tick_us.p999 <= most && b.intersecting == 0) + " |\n";
    }
  }
  if (text.empty()) return text;
  return "\n### Budgets\n\n| scene | budget, ms | p99.9 wall, µs | p99.9 CPU, µs | at most, µs | depth, mm | ticks cut "
         "| "
         "intersecting | verdict |\n|---|---|---|---|---|---|---|---|---|\n" +
         text;
}

std::string lag_table(const Results& r) {
  std::string text =
      "\n### Lag: against the same pen without a budget\n\n| scene | pen | X is off: median / p99 / max, µm | force, N "
      "RMS | its error, N RMS (max) | of the force | ticks cut |\n|---|---|---|---|---|---|---|\n";
  const auto row = [&](const SceneFigures& s, const char* pen, const LagFigures& f, const LoopFigures& loop) {
    const std::string share = std::isfinite(f.error_share) ? format("%.2g %%", 100 * f.error_share) : "–";
    const std::string first = f.ticks < loop.ticks ? format(", first %zu ticks of %zu", f.ticks, loop.ticks) : "";
    text += format("| `%s` | %s%s | %s / %s / %s | %s | %s (%s) | %s | %zu of %zu |\n", s.scene.c_str(), pen,
                   first.c_str(), number(1e6 * f.p50).c_str(), number(1e6 * f.p99).c_str(),
                   number(1e6 * f.most).c_str(), number(f.force_rms).c_str(), number(f.error_rms).c_str(),
                   number(f.error_most).c_str(), share.c_str(), loop.cut, loop.in_contact);
  };
  for (const SceneFigures& s : r.rows) {
    row(s, "hand", s.hand_lag, s.hand);
    row(s, "fast", s.fast_lag, s.fast);
  }
  return text;
}

std::string friction_solve_table(const Results& r) {
  if (r.friction_solves.empty()) return "";
  std::string text =
      "\n### Solves with friction\n\n| contacts | median (target), µs | p99, µs | exact | verdict "
      "|\n|---|---|---|---|---|\n";
  for (const FrictionSolveFigures& f : r.friction_solves) {
    const bool judged = std::isfinite(f.target_us);
    text += format("| %d | %.1f (%s) | %.0f | %.1f %% | ", f.contacts, f.us.p50, number(f.target_us).c_str(), f.us.p99,
                   100 * f.exact);
    text += (judged ? verdict(f.us.p50 <= f.target_us) : "–") + " |\n";
  }
  return text;
}

std::string friction_table(const Results& r) {
  std::string text;
  for (const SceneFigures& s : r.rows) {
    if (!s.friction) continue;
    const LoopFigures& f = s.friction->loop;
    const double ratio = f.tick_us.p50 / s.hand.tick_us.p50;
    const bool met = ratio <= kMaxFriction && f.tick_us.p999 <= kMaxTick && s.friction->intersecting == 0;
    text += format("| `%s` | %.2g | %s / %s | %s / %s | %.2f | %.1f | %zu of %zu | %lld of %lld | ", s.scene.c_str(),
                   s.friction->mu, number(f.tick_us.p50).c_str(), number(f.tick_us.p999).c_str(),
                   number(s.hand.tick_us.p50).c_str(), number(s.hand.tick_us.p999).c_str(), ratio, f.resolves, f.cut,
                   f.in_contact, static_cast<long long>(s.friction->intersecting),
                   static_cast<long long>(s.friction->checked));
    text += verdict(met) + " |\n";
  }
  if (text.empty()) return text;
  return "\n### With friction\n\n| scene | mu | median / p99.9, µs | without: median / p99.9, µs | ratio of the "
         "medians "
         "(1.5) | programs | ticks cut | intersecting | verdict |\n|---|---|---|---|---|---|---|---|---|\n" +
         text;
}

std::string lp_table(const Results& r) {
  if (r.lp.empty()) return "";
  std::string text =
      "\n### Linear program\n\n| contacts | lp peg / ball (target), µs | pivots | qp peg / ball, µs | GLPK peg / "
      "ball, "
      "µs | faster than GLPK | relative duality gap | verdict |\n|---|---|---|---|---|---|---|---|\n";
  for (const LpFigures& f : r.lp) {
    const double ratio = f.peg.glpk_us / f.peg.us;
    const bool met = f.peg.us <= f.target_us && f.peg.failed == 0 && !(f.n == kGlpkRows && ratio < kGlpkRatio);
    text += format("| %d | %s / %s (%s) | %.1f / %.1f | %s / %s | %s / %s | %s × | %.0e | %s |\n", f.n,
                   number(f.peg.us).c_str(), number(f.ball.us).c_str(), number(f.target_us).c_str(), f.peg.iterations,
                   f.ball.iterations, number(f.peg.qp_us).c_str(), number(f.ball.qp_us).c_str(),
                   number(f.peg.glpk_us).c_str(), number(f.ball.glpk_us).c_str(), number(ratio).c_str(),
                   std::max(f.peg.gap, f.ball.gap), verdict(met).c_str());
  }
  return text;
}

}  // namespace

std::string tables(const Results& r) {
  std::string text;
  if (!r.rows.empty())
    text += "### Whole tick, in contact, at hand speed (0.1 m/s, 0.5 rad/s)\n\n" + targets_table(r) + growth_line(r) +
            "\n### Both speeds (fast: 0.4 m/s, 4 rad/s)\n\n" + runs_table(r) + lag_table(r) + friction_table(r) +
            seat_table(r) + "\n### Hierarchies and checks\n\n" + checks_table(r);
  return text + start_table(r) + budget_table(r) + lp_table(r) + friction_solve_table(r);
}

}  // namespace tegotae::bench
