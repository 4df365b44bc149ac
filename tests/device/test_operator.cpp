// The operator model: closed forms of its parts, and what a person would do.
#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "device/delayed_view.hpp"
#include "operator/minimum_jerk.hpp"
#include "operator/tremor.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/operator/operator.hpp"

using namespace tegotae;

namespace {

using Path = MinimumJerk<1>;

Path::Vector one(double x) {
  return Path::Vector::Constant(x);
}

/// A peg of 50 mm, its tip 25 mm below its file frame, over a hole of 40 mm at the origin.
InsertionTask task() {
  InsertionTask t;
  t.tip = Vec3(0, 0, -0.025);
  t.depth = 0.04;
  t.start.p = Vec3(0.03, 0, 0.065);
  t.goal.p = Vec3(0, 0, -0.015);
  return t;
}

OperatorProfile steady(const char* name) {
  OperatorProfile p = operator_profile(name);
  p.tremor = p.tremor_angle = p.aim_error = p.tilt_error = p.eye_error = p.eye_tilt_error = 0;
  return p;
}

double tip_depth(const Pose& X) {
  return -(X * Vec3(0, 0, -0.025)).z();
}
double tilt(const Pose& X) {
  return rotation_vector(X.q).norm();
}

/// The hand's targets while pen and part follow it exactly, at 1 kHz; `seen` may change what it is shown.
template <typename F>
std::vector<HandTarget> follow(Operator& op, double seconds, F seen) {
  std::vector<HandTarget> out;
  Pose pen = op.start();
  for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
    const double t = 1e-3 * i;
    op.see(t, seen(t, pen));
    out.push_back(op.target(t + 5e-4, pen));
    pen = out.back().pose;
  }
  return out;
}

bool same_bits(const Pose& a, const Pose& b) {
  return std::memcmp(a.p.data(), b.p.data(), 3 * sizeof(double)) == 0 &&
         std::memcmp(a.q.coeffs().data(), b.q.coeffs().data(), 4 * sizeof(double)) == 0;
}

}  // namespace

TEST_CASE("a path from rest to rest is the minimum-jerk polynomial", "[operator]") {
  const double d = 0.3, T = 0.8, t0 = 2;
  const Path path({one(0.1), one(0), one(0)}, one(0.1 + d), t0, T);
  CHECK(path.at(t0).x[0] == Approx(0.1));
  CHECK(std::abs(path.at(t0).v[0]) < 1e-15);
  CHECK(std::abs(path.at(t0).a[0]) < 1e-15);
  const double end = std::nextafter(t0 + T, 0.0);
  CHECK(path.at(end).x[0] == Approx(0.1 + d));
  CHECK(std::abs(path.at(end).v[0]) < 1e-12);
  CHECK(std::abs(path.at(end).a[0]) < 1e-10);
  CHECK(path.at(t0 + 10 * T).x[0] == 0.1 + d);
  double peak = 0, peak_at = 0, jerk2 = 0;
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const double t = t0 + T * (i + 0.5) / n, s = (i + 0.5) / n;
    REQUIRE(path.at(t).x[0] == Approx(0.1 + d * (10 * s * s * s - 15 * s * s * s * s + 6 * s * s * s * s * s)));
    if (path.at(t).v[0] > peak) peak = path.at(t).v[0], peak_at = t;
    const double h = T / n, j = (path.at(t + h / 2).a[0] - path.at(t - h / 2).a[0]) / h;
    if (i > 0 && i + 1 < n) jerk2 += j * j * h;
  }
  CHECK(peak == Approx(1.875 * d / T).epsilon(1e-6));
  CHECK(peak_at == Approx(t0 + T / 2).epsilon(1e-3));
  CHECK(jerk2 == Approx(720 * d * d / std::pow(T, 5)).epsilon(2e-2));  // the least there is
}

TEST_CASE("a path from a state in motion begins with it and ends at rest", "[operator]") {
  const Path path({one(0.2), one(-0.5), one(3)}, one(-0.1), 1, 0.4);
  CHECK(path.at(1).x[0] == Approx(0.2));
  CHECK(path.at(1).v[0] == Approx(-0.5));
  CHECK(path.at(1).a[0] == Approx(3));
  const double end = std::nextafter(1.4, 0.0);
  CHECK(path.at(end).x[0] == Approx(-0.1));
  CHECK(std::abs(path.at(end).v[0]) < 1e-12);
  CHECK(std::abs(path.at(end).a[0]) < 1e-10);
}

TEST_CASE("tremor is as large as asked for and lies in 8 to 12 Hz", "[operator]") {
  std::mt19937_64 rng(5);
  const double rms = 3e-5, angle_rms = 6e-4, dt = 1e-3;
  const Tremor tremor(rms, angle_rms, rng);
  const int n = 10000;  // 10 s
  std::vector<double> x(n);
  double square = 0, square_angle = 0;
  for (int i = 0; i < n; ++i) {
    const Tremor::Value v = tremor.at(dt * i);
    x[static_cast<std::size_t>(i)] = v.d.dp.x() * (0.5 - 0.5 * std::cos(2 * M_PI * i / n));  // Hann
    square += v.d.dp.squaredNorm() / (3.0 * n);
    square_angle += v.d.dr.squaredNorm() / (3.0 * n);
    if (i % 100 == 0) {
      const double h = 1e-6;
      CHECK((tremor.at(dt * i + h).d.dp - tremor.at(dt * i - h).d.dp - 2 * h * v.rate.v).norm() < 1e-6 * 2 * h);
      CHECK((tremor.at(dt * i + h).d.dr - tremor.at(dt * i - h).d.dr - 2 * h * v.rate.w).norm() < 1e-6 * 2 * h);
    }
  }
  CHECK(std::sqrt(square) == Approx(rms).epsilon(0.1));
  CHECK(std::sqrt(square_angle) == Approx(angle_rms).epsilon(0.1));
  double inside = 0, all = 0;
  for (int k = 1; k <= 300; ++k) {  // to 30 Hz in steps of 0.1
    std::complex<double> sum = 0;
    for (int i = 0; i < n; ++i) sum += x[static_cast<std::size_t>(i)] * std::polar(1.0, -2 * M_PI * k * (i % n) / n);
    all += std::norm(sum);
    if (k >= 79 && k <= 121) inside += std::norm(sum);
  }
  CHECK(inside / all > 0.999);
}

TEST_CASE("the eye is late by its delay", "[operator]") {
  DelayedView view;
  CHECK(view.at(1) == nullptr);
  for (int i = 0; i < 2000; ++i) view.add(1e-3 * i, {Quat::Identity(), Vec3(i, 0, 0)});
  CHECK(view.at(1.999 - 0.2)->p.x() == Approx(1799).margin(1));
  CHECK(view.at(-5)->p.x() >= 1400);  // the oldest kept

  // Two operators with the same seed; one is shown a part that sits 3 mm aside from a certain time on.
  const OperatorProfile p = operator_profile("average");
  Operator a(p, task(), 7), b(p, task(), 7);
  const double jump = 2.3;  // in the hole, where it aims at every look
  const auto fair = follow(a, 3.5, [](double, const Pose& X) { return X; });
  const auto late = follow(b, 3.5, [&](double t, const Pose& X) {
    return t < jump ? X : Pose{X.q, X.p + Vec3(0, 0.003, 0)};
  });
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fair.size() && std::isinf(first); ++i)
    if (!same_bits(fair[i].pose, late[i].pose)) first = 1e-3 * static_cast<double>(i);
  CHECK(first >= jump + p.visual_delay);
  CHECK(first < jump + p.visual_delay + 0.25);  // it looks five times a second
}

TEST_CASE("the first reach is a minimum-jerk path with the speed of the profile", "[operator]") {
  const OperatorProfile p = steady("careful");
  Operator op(p, task(), 1);
  const auto targets = follow(op, 4, [](double, const Pose& X) { return X; });
  // From 30 mm aside and 40 mm over the surface to the hover of 4 mm, at a mean speed of the profile's.
  const double way = std::hypot(0.03, 0.04 - 0.004), T = way / p.carry_speed;
  double peak = 0;
  for (std::size_t i = 1; i < targets.size(); ++i) {
    const double t = 1e-3 * static_cast<double>(i) + 5e-4;
    const Vec3 v = (targets[i].pose.p - targets[i - 1].pose.p) / 1e-3;
    REQUIRE((v - 0.5 * (targets[i].velocity.v + targets[i - 1].velocity.v)).norm() < 1e-4);
    if (t < T) peak = std::max(peak, v.norm());
  }
  CHECK(peak == Approx(1.875 * way / T).epsilon(1e-3));
  CHECK(tip_depth(targets[static_cast<std::size_t>(1000 * T) + 5].pose) == Approx(-0.004));
}

TEST_CASE("with nothing in the way it goes to the bottom, whoever it is", "[operator]") {
  for (const OperatorProfile& p : operator_profiles()) {
    CAPTURE(p.name);
    Operator op(p, task(), 3);
    const auto targets = follow(op, 10, [](double, const Pose& X) { return X; });
    CHECK(tip_depth(targets.back().pose) == Approx(0.04).margin(1e-3));
    CHECK(!op.stuck());
  }
}

TEST_CASE("a tilted and offset part is seen and set right", "[operator]") {
  InsertionTask t = task();
  t.own_errors = false;
  t.offset = Vec3(0.005, 0, 0);
  t.tilt = Vec3(0, 0.2, 0);
  Operator op(steady("average"), t, 1);
  const auto targets = follow(op, 8, [](double, const Pose& X) { return X; });
  CHECK(tilt(targets[1000].pose) == Approx(0.2).margin(0.01));  // when the reach has ended
  CHECK(tilt(targets.back().pose) < 0.02);
  CHECK((targets.back().pose * t.tip).head<2>().norm() < 5e-4);
}

TEST_CASE("blocked, it presses no harder than it means to, wiggles more and more, and stops when free", "[operator]") {
  const OperatorProfile p = steady("average");
  Operator op(p, task(), 4);
  double press = 0, early = 0, late = 0;
  bool stuck = false;
  Pose pen = op.start();
  int tick = 0;
  const auto run = [&](double until, bool blocked, double& most) {
    for (; 1e-3 * tick < until; ++tick) {
      op.see(1e-3 * tick, pen);
      const HandTarget target = op.target(1e-3 * tick + 5e-4, pen);
      pen = target.pose;
      most = std::max(most, tilt(pen));
      stuck = stuck || op.stuck();
      const double ahead = tip_depth(pen) - 0.002;
      if (!blocked || ahead <= 0) continue;
      press = std::max(press, p.hand.stiffness * ahead);
      pen.p.z() += ahead;  // it does not get deeper than 2 mm
    }
  };
  double none = 0;
  run(2.6, true, none);
  run(3.2, true, early);
  run(6.5, true, late);
  CHECK(stuck);
  // What the hand means plus what it runs on before it feels it (20 mm/s for a twentieth of a second).
  CHECK(press < 1.5 * p.press + p.hand.stiffness * 2 * p.insertion_speed * 0.05);
  CHECK(press > 0.8 * p.press);
  CHECK(early > 0.5 * p.wiggle);
  CHECK(late > 2 * early);
  double after = 0;
  run(12, false, none);
  run(13, false, after);
  CHECK(!op.stuck());
  CHECK(after < 0.1 * p.wiggle);
  CHECK(tip_depth(pen) == Approx(0.04).margin(1e-3));
}

TEST_CASE("held fast, it draws back after each two seconds and tries again", "[operator]") {
  const OperatorProfile p = steady("average");
  Operator op(p, task(), 4);
  Pose pen = op.start();
  // The part sticks where it first gets to 2 mm, in both directions, as a wedged one does.
  double first = -1, push = 0, pull = 0;
  std::vector<double> begins;
  bool pulls = false;
  for (int tick = 0; tick < 12000; ++tick) {
    const double t = 1e-3 * tick;
    op.see(t, pen);
    pen = op.target(t + 5e-4, pen).pose;
    const double ahead = tip_depth(pen) - 0.002;
    if (first < 0 && ahead < 0) continue;
    if (first < 0) first = t;
    pen.p.z() += ahead;
    push = std::max(push, p.hand.stiffness * ahead);
    pull = std::max(pull, -p.hand.stiffness * ahead);
    const bool now = p.hand.stiffness * ahead < -0.5 * p.press;
    if (now && !pulls) begins.push_back(t - first);
    pulls = now;
  }
  REQUIRE(first > 0);
  REQUIRE(begins.size() >= 3);
  CHECK(begins[0] > 2);
  for (std::size_t i = 1; i < begins.size(); ++i) CHECK(begins[i] - begins[i - 1] == Approx(2.4).margin(0.1));
  // As hard as it pushes, and what it runs on.
  const double runs_on = p.hand.stiffness * 2 * p.insertion_speed * 0.05;
  CHECK(pull > 0.8 * p.press);
  CHECK(pull < 1.5 * p.press + runs_on);
  CHECK(push < 1.5 * p.press + runs_on);
}

TEST_CASE("the same seed gives the same bits, another seed another hand", "[operator]") {
  const auto run = [](std::uint64_t seed) {
    Operator op(operator_profile("hasty"), task(), seed);
    return follow(op, 2, [](double, const Pose& X) { return X; });
  };
  const auto a = run(11), b = run(11), c = run(12);
  bool same = true;
  int different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    same = same && same_bits(a[i].pose, b[i].pose);
    different += same_bits(a[i].pose, c[i].pose) ? 0 : 1;
  }
  CHECK(same);
  CHECK(different > 1900);
}

TEST_CASE("a simulated pen takes an operator for its hand", "[operator]") {
  Operator op(operator_profile("average"), task(), 2);
  SimulatedDevice device({}, op, Vec3(0, 0, 0.001));
  device.start();
  CHECK((device.true_pose().p - op.start().p).norm() < 1e-12);
  for (int i = 0; i < 6000; ++i) {
    op.see(1e-3 * i, device.true_pose());
    device.advance(1e-3);
  }
  CHECK(tip_depth(device.true_pose()) == Approx(0.04).margin(1e-3));
}

TEST_CASE("what an operator cannot be is refused by name", "[operator]") {
  CHECK_THROWS_WITH(operator_profile("lazy"), Catch::Contains("lazy") && Catch::Contains("careful"));
  OperatorProfile p = operator_profile("average");
  p.visual_delay = 0;
  CHECK_THROWS_WITH(Operator(p, task(), 1), Catch::Contains("visual_delay"));
  InsertionTask t = task();
  t.depth = 0;
  CHECK_THROWS_WITH(Operator(operator_profile("average"), t, 1), Catch::Contains("depth"));
  t = task();
  t.inward = Vec3(0, 0, -2);
  CHECK_THROWS_WITH(Operator(operator_profile("average"), t, 1), Catch::Contains("inward"));
  for (const OperatorProfile& each : operator_profiles()) {
    CHECK(each.visual_delay >= 0.15);
    CHECK(each.visual_delay <= 0.25);
  }
}
