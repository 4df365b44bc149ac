// What the hand feels of a part that starts on a coplanar seat, pressed onto it and pulled off: known in closed form.
#include <cmath>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "tegotae/coupling/coupling.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "tegotae/session/session.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kTick = 1e-3;

/// A block of 10 mm on a board, their faces exactly in line, in any place and orientation.
struct Seat {
  Scene scene;
  Vec3 up;     ///< the board's normal
  Pose X0;     ///< of the block
  Vec3 along;  ///< the board's x

  explicit Seat(unsigned seed, const std::string& resolver) {
    std::mt19937 rng(seed);
    const Pose X_W = random_pose(rng, 0.05);
    scene.contact.resolver = resolver_kind(resolver);
    scene.contact.tick_budget = INFINITY;
    scene.parts.push_back({"board", shared(box({0.1, 0.1, 0.02})), X_W * Pose{Quat::Identity(), {0, 0, -0.01}}});
    X0 = X_W * Pose{Quat::Identity(), {0.01, -0.02, 0.005}};
    scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), X0, true});
    up = X_W.q * Vec3::UnitZ();
    along = X_W.q * Vec3::UnitX();
  }
  double height(const Pose& X) const { return up.dot(X.p - X0.p); }
};

/// The loop with a pen that is led; the wrench as the servo forms it.
struct Hand {
  HapticLoop loop;
  CouplingSettings coupling;
  Pose Y;

  explicit Hand(const Seat& seat) : loop(seat.scene), Y(seat.X0) {}
  Wrench to(const Pose& next) {
    const Displacement d = displacement(Y, next, loop.center());
    Y = next;
    loop.step(Y, kTick);
    return coupling_wrench(coupling, loop.report().proxy, Y, {d.dp / kTick, d.dr / kTick}, loop.center());
  }
};

}  // namespace

TEST_CASE("the force at a seat is stiffness times depth of the hand from the first tick on, and nothing off it",
          "[start]") {
  const std::string resolver = GENERATE("lp", "qp");
  const unsigned seed = GENERATE(1u, 2u, 3u);
  CAPTURE(resolver, seed);
  const Seat seat(seed, resolver);
  Hand hand(seat);
  const double k = hand.coupling.stiffness, kt = hand.coupling.torsional_stiffness, d = hand.coupling.damping;
  const double l_min = *hand.loop.contact().l_min;
  const auto rests = [&] {
    const double h = seat.height(hand.loop.report().proxy.X);
    REQUIRE(h > 0);
    REQUIRE(h < l_min);
    return h;
  };
  // At once a millimeter into the seat. The pen came with 1 m/s, the part stands.
  const double depth = 1e-3;
  const Pose pressed{seat.X0.q, seat.X0.p - depth * seat.up};
  const double before = seat.height(hand.loop.report().proxy.X);
  Wrench w = hand.to(pressed);
  REQUIRE(hand.loop.report().proxy.touching);
  double h = rests();
  CHECK((w.force - (k * (depth + h) + d * (depth + h - before) / kTick) * seat.up).norm() < 1e-6);
  CHECK(w.torque.norm() < 1e-6);
  // Standing there, less what the part may still rise to the gap that it keeps.
  for (int i = 0; i < 50; ++i) w = hand.to(pressed);
  h = rests();
  CHECK((w.force - k * (depth + h) * seat.up).norm() < 1e-6);
  CHECK(w.force.norm() == Approx(k * depth).epsilon(1e-2));
  CHECK(w.torque.norm() < 1e-6);
  // Pressed and turned about the board's x by an angle that does not lift it, k_t · angle < k · depth · half the side:
  // the torque of that angle.
  const double angle = 0.01;
  REQUIRE(kt * angle < 0.8 * k * depth * 0.005);
  for (int i = 0; i < 50; ++i) w = hand.to({rotation(angle * seat.along) * seat.X0.q, pressed.p});
  rests();
  CHECK((w.torque + kt * angle * seat.along).norm() < 0.02 * kt * angle);
  CHECK(w.force.dot(seat.up) == Approx(k * depth).epsilon(0.02));
  // Half the way back in one move, then pulled off by 20 um a tick: no force holds it back, and none is left.
  const Pose half{seat.X0.q, seat.X0.p - 0.5 * depth * seat.up};
  for (int i = 0; i < 50; ++i) w = hand.to(half);
  h = rests();
  CHECK((w.force - k * (0.5 * depth + h) * seat.up).norm() < 1e-6);
  const double step = 2e-5;
  int off = 0;
  for (int i = 1; i <= 60; ++i) {
    const double at = -0.5 * depth + step * i;  // of the pen
    w = hand.to({seat.X0.q, seat.X0.p + at * seat.up});
    h = seat.height(hand.loop.report().proxy.X);
    CAPTURE(i, h);
    // What the damper takes off while the pen leaves and the part rests; nothing more holds the hand.
    REQUIRE(w.force.dot(seat.up) > -d * step / kTick - 1e-9);
    if (at < 0) REQUIRE(w.force.dot(seat.up) == Approx(k * (h - at) - d * step / kTick).margin(k * l_min));
    if (at > l_min + step) {
      ++off;
      REQUIRE(w.force.norm() == 0);
      REQUIRE(w.torque.norm() == 0);
      REQUIRE(h == Approx(at).margin(1e-9));
    }
  }
  CHECK(off > 20);
}

namespace {

/// Keeps what the pen felt.
struct Felt final : RunObserver {
  struct Sample {
    double t;
    Pose X, Y;
    Wrench wrench;
    bool touching;
  };
  std::vector<Sample> samples;
  void before_tick(double) override {}
  void after_tick(const TickView& tick) noexcept override {
    const ProxyState& proxy = tick.loop.report().proxy;
    samples.push_back({tick.t, proxy.X, tick.pen.state.pose, tick.pen.wrench, proxy.touching});
  }
};

}  // namespace

TEST_CASE("the pen feels the seat through servo and safety chain, and nothing off it", "[start]") {
  const Seat seat(4, "qp");
  const auto at = [&](double h) { return Pose{seat.X0.q, seat.X0.p + h * seat.up}; };
  const double depth = 2e-3;
  const SceneFile file = {
      "seat",
      seat.scene,
      {},
      StylusScript({{0, at(0)}, {0.4, at(0)}, {0.6, at(-depth)}, {1.4, at(-depth)}, {1.8, at(5e-3)}, {2, at(5e-3)}})};
  Felt felt;
  RunSettings settings;
  settings.real_time = false;
  settings.observer = &felt;
  const RunSummary summary = run_session(file, settings);
  CHECK(summary.completed);
  CHECK(summary.penetrating == 0);
  const double k = file.scene.coupling.stiffness, l_min = *HapticLoop(file.scene).contact().l_min;
  int pressed = 0, off = 0;
  for (const Felt::Sample& s : felt.samples) {
    CAPTURE(s.t);
    const double h = seat.height(s.X), pen = seat.height(s.Y);
    if (s.t > 1.2 && s.t < 1.4) {  // at rest
      ++pressed;
      REQUIRE(h > 0);
      REQUIRE(h < l_min);
      REQUIRE(pen < -0.1 * depth);
      REQUIRE(s.wrench.force.dot(seat.up) == Approx(-k * pen).epsilon(0.01).margin(k * l_min));
      REQUIRE((s.wrench.force - s.wrench.force.dot(seat.up) * seat.up).norm() < 0.01 * k * std::abs(pen));
    }
    // The wrench of a sample is from before its tick.
    if (s.t > 1.4 && pen > 1e-3) {
      ++off;
      REQUIRE_FALSE(s.touching);
      REQUIRE(s.wrench.force.norm() == 0);
      REQUIRE(s.wrench.torque.norm() == 0);
    }
  }
  CHECK(pressed > 150);
  CHECK(off > 200);
}
