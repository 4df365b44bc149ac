// Ticks with little time: what times out is reported, and X stays free. How long ticks take is not tested here: it
// depends on what else the machine does.
#include "bodies.hpp"
#include "catch.hpp"
#include "loop/tick_reserve.hpp"
#include "stress_run.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

TEST_CASE("within any budget X stays free, and ticks that ran out of it say so", "[budget]") {
  StressOptions options;
  options.resolver = GENERATE("lp", "qp");
  options.budget = GENERATE(1e-6, 1e-4, 3e-4, 8e-4);
  const std::string name = GENERATE("peg_0.99", "peg_0.999", "knots", "wedged_stars");
  CAPTURE(options.resolver, options.budget, name);
  StressResult sum;
  LatencyHistogram cpu;
  for (unsigned seed = 81; seed < 84; ++seed) sum.add(run_stress_script(stress_scene(name, seed), seed, options, cpu));
  CAPTURE(sum.first_intersecting);
  CHECK(sum.intersecting == 0);
  CHECK(sum.infeasible == 0);
  // An interrupt after the last look at the clock counts as the thread's time: one tick in ten thousand, never two
  // here.
  CHECK(sum.late_unreported <= 1 + sum.ticks / 1000);
  // No machine searches a peg in its hole within a microsecond.
  if (options.budget == 1e-6 && name != "knots") CHECK(sum.timed_out > 0);
}

TEST_CASE("a tick that ends after its budget says so, whatever it did", "[budget]") {
  const std::string resolver = GENERATE("qp", "lp", "impulse", "penalty");
  const auto cube = shared(box({0.02, 0.02, 0.02}));
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = 1e-9;  // no tick is as short
  scene.parts = {{"fixed", cube, Pose()}, {"held", cube, {Quat::Identity(), {0, 0, 0.03}}, true}};
  HapticLoop loop(scene);
  const auto step = [&loop](double z) { return loop.step({Quat::Identity(), {0, 0, z}}, 1e-3).flags; };
  CAPTURE(resolver);
  for (const double z : {0.3, 0.03, 0.019}) {  // far off, near, pressed
    CAPTURE(z);
    CHECK(step(z).timed_out);
  }
  CHECK(loop.step({Quat::Identity(), {NAN, 0, 0}}, 1e-3).flags.timed_out);
  // One that holds another part from then on follows no pen.
  scene.parts[0].held = true;
  scene.parts[1].held = false;
  scene.parts[1].pose.p.z() = 0.5;
  loop.change(scene);
  const TickFlags changed = step(0.3);
  CHECK(changed.part_changed);
  CHECK(changed.timed_out);
}

TEST_CASE("ticks stop before their budget ends by what the last late ones needed afterwards", "[budget]") {
  constexpr double kBudget = 8e-4;
  constexpr std::int64_t kBegin = 1'000'000'000, kEnd = kBegin + 800'000;
  TickReserve reserve;
  const auto kept = [&] { return kEnd - reserve.stop_after(kBegin, kBudget); };
  CHECK(kept() == 0);
  // What ends before it has to stop tells nothing.
  reserve.ended(kEnd, kEnd - 1000, kBudget);
  CHECK(kept() == 0);
  reserve.ended(kEnd, kEnd + 100'000, kBudget);
  CHECK(std::abs(kept() - 100'000) <= 1);
  // Shorter ones make it less, little by little, and no less than they need.
  reserve.ended(kEnd, kEnd + 20'000, kBudget);
  const std::int64_t less = kept();
  CHECK(less > 20'000);
  CHECK(less < 100'000);
  for (int i = 0; i < 1000; ++i) reserve.ended(kEnd, kEnd + 20'000, kBudget);
  CHECK(std::abs(kept() - 20'000) <= 1);
  // A tick that lasted for a second leaves most of the budget to those to come, and is soon forgotten.
  reserve.ended(kEnd, kEnd + 1'000'000'000, kBudget);
  CHECK(kept() > 20'000);
  CHECK(kept() < 400'000);
  for (int i = 0; i < 100; ++i) reserve.ended(kEnd, kEnd + 20'000, kBudget);
  CHECK(std::abs(kept() - 20'000) <= 1);
  // No deadline stays none, whatever was late before.
  CHECK(reserve.stop_after(kBegin, INFINITY) == kNoDeadline);
  reserve.ended(kNoDeadline, kEnd, kBudget);
  CHECK(reserve.stop_after(kBegin, INFINITY) == kNoDeadline);
}
