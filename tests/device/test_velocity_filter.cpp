// What poses in steps tell of a pen's velocity. The oracle is the true motion that was rounded to the steps.
#include <algorithm>
#include <cmath>

#include "catch.hpp"
#include "device/velocity_filter.hpp"

using namespace tegotae;

namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kSample = 1e-3, kCutoff = 50, kStep = 3e-5, kTurnStep = 1e-4;
// Of a sample's difference, what a first-order low-pass of 50 Hz lets through at once.
const double kGain = 1 - std::exp(-2 * M_PI * kCutoff * kSample);

double stepped(double x, double step) {
  return step * std::round(x / step);
}

/// Feeds the way x(i) of ticks `i` along y in steps; says the velocity along y after each.
template <typename Way, typename Say>
void follow(VelocityFilter& filter, int ticks, Way way, Say say) {
  for (int i = 0; i < ticks; ++i) {
    filter.add({0.1, stepped(way(i), kStep), -0.2}, Quat::Identity(), i * kMs);
    CHECK(filter.velocity().v.x() == 0);
    say(i, filter.velocity().v.y());
  }
}

}  // namespace

TEST_CASE("the velocity of a pen that goes slower than a step a sample is its own, not that of its steps", "[device]") {
  for (double share : {0.02, 0.07, 0.11, 0.3, 0.45, 0.75, 1.0, 1.6, 7.3}) {  // steps a sample
    const double v = share * kStep / kSample;
    VelocityFilter filter(kCutoff, kStep, kTurnStep);
    double sum = 0, worst = 0;
    int counted = 0;
    follow(
        filter, 4000, [&](int i) { return v * i * kSample; },
        [&](int i, double seen) {
          if (i < 1000) return;
          ++counted;
          sum += seen;
          worst = std::max(worst, std::abs(seen - v));
        });
    CAPTURE(share, v, worst);
    CHECK(sum / counted == Approx(v).epsilon(0.02));
    // Waiting steps come every N or N + 1 samples; others are differences.
    const double off = share < 0.1 ? v / std::floor(1 / share) : kStep / kSample;
    CHECK(worst <= off * (1 + 1e-9));
    // Differences would give this much more than the pen's velocity after each step.
    if (share < 0.1) CHECK(worst < 0.5 * (kGain * kStep / kSample - v));
  }
}

TEST_CASE("a step after a rest, and steps to and fro, are not a velocity", "[device]") {
  VelocityFilter filter(kCutoff, kStep, kTurnStep);
  double most = 0;
  const auto look = [&most](int, double seen) { most = std::max(most, std::abs(seen)); };
  follow(
      filter, 500, [](int i) { return i < 300 ? 0 : kStep; }, look);
  CHECK(most == 0);
  VelocityFilter shaken(kCutoff, kStep, kTurnStep);
  follow(
      shaken, 500, [](int i) { return i / 12 % 2 == 0 ? 0 : kStep; }, look);
  CHECK(most == 0);
  // The second step the same way, after 0.08 s, tells 0.38 mm/s; after 0.2 s nothing.
  VelocityFilter slow(kCutoff, kStep, kTurnStep);
  const auto way = [](int i) { return kStep * ((i >= 300) + (i >= 380) + (i >= 580)); };
  double late = 0;
  follow(slow, 700, way, [&](int i, double seen) {
    most = std::max(most, seen);
    if (i >= 579) late = std::max(late, seen);
  });
  CHECK(late < 1e-12);
  CHECK(most > 0);
  CHECK(most <= kStep / 0.08);
}

TEST_CASE("the velocity of a pen that stops falls with the time in which no step came", "[device]") {
  VelocityFilter filter(kCutoff, kStep, kTurnStep);
  const double v = 0.05;
  const int stop = 200;
  follow(
      filter, 400, [&](int i) { return v * kSample * std::min(i, stop); },
      [&](int i, double seen) {
        // The low-pass of what is left of the full velocity, and of at most a step in the time since.
        double bound = v + kStep / kSample;
        for (int n = 1; n <= i - stop; ++n) bound += kGain * (kStep / (n * kSample) - bound);
        if (i >= stop) CHECK(seen <= bound);
        if (i == 399) CHECK(seen < 1e-12);  // stands
      });
}

TEST_CASE("where no steps are known, and of swings over many steps, velocities are filtered differences", "[device]") {
  VelocityFilter plain(kCutoff, 0, 0);
  for (int i = 0; i < 200; ++i) {
    plain.add({0, 0.2 * i * kSample, 0}, rotation({0, 0, 3.0 * i * kSample}), i * kMs);
    const double reached = 1 - std::pow(1 - kGain, i);
    CHECK(plain.velocity().v.y() == Approx(0.2 * reached));
    CHECK(plain.velocity().w.z() == Approx(3.0 * reached));
  }
  VelocityFilter known(kCutoff, kStep, kTurnStep), unknown(kCutoff, 0, 0);
  const auto swing = [](int i) { return 2e-3 * std::sin(2 * M_PI * 20 * i * kSample); };
  double apart = 0, most = 0;
  for (int i = 0; i < 500; ++i) {
    known.add({0, stepped(swing(i), kStep), 0}, Quat::Identity(), i * kMs);
    unknown.add({0, swing(i), 0}, Quat::Identity(), i * kMs);
    apart = std::max(apart, (known.velocity().v - unknown.velocity().v).norm());
    most = std::max(most, unknown.velocity().v.norm());
  }
  CHECK(apart < 2 * kGain * kStep / kSample);
  CHECK(most > 5 * apart);
}

TEST_CASE("turns are known by their steps about any axis", "[device]") {
  const Quat held = rotation({0.4, -0.3, 0.8});
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0)}) {
    VelocityFilter filter(kCutoff, kStep, kTurnStep);
    const double w = 0.1 * kTurnStep / kSample;
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      filter.add(Vec3::Zero(), rotation(stepped(w * i * kSample, kTurnStep) * axis) * held, i * kMs);
      if (i > 500) worst = std::max(worst, (filter.velocity().w - w * axis).norm());
    }
    CHECK(worst < 0.11 * w);
  }
}
