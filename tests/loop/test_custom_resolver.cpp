// Resolvers from outside: whatever they answer, the held part stays out of the others.
#include <cmath>
#include <limits>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Answers what it is told to, without a look at the constraints.
class Liar final : public Resolver {
 public:
  explicit Liar(int kind) : kind_(kind) {}
  Resolution resolve(const LowRankMatrix&, const double*, const Vec6& wanted) noexcept override {
    Resolution r;
    r.status = ResolveStatus::solved;
    const int kind = kind_ < 4 ? kind_ : static_cast<int>(rng_() % 4);
    switch (kind) {
      case 0:
        r.motion = wanted;
        break;
      case 1:
        r.motion = Vec6::Constant(std::numeric_limits<double>::quiet_NaN());
        break;
      case 2:
        r.motion = 1e9 * Vec6::Ones();
        break;
      default:
        r.motion = -3 * wanted;
        break;
    }
    return r;
  }
  bool projects() const override { return true; }

 private:
  int kind_;
  std::minstd_rand rng_{3};
};

/// The paper's program, that gives up where the way is far.
class Shortsighted final : public Resolver {
 public:
  explicit Shortsighted(int capacity) : paper_(make_resolver(ResolverKind::lp, capacity)) {}
  Resolution resolve(const LowRankMatrix& rows, const double* bounds, const Vec6& wanted) noexcept override {
    if (wanted.norm() > kFar) return {Vec6::Zero(), ResolveStatus::stalled, 0, nullptr};
    return paper_->resolve(rows, bounds, wanted);
  }
  bool projects() const override { return false; }

 private:
  static constexpr double kFar = 1e-3;  // m
  std::unique_ptr<Resolver> paper_;
};

}  // namespace

TEST_CASE("a part goes on by shorter ways where a program has no answer for the whole", "[resolver]") {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.contact.custom_resolver = [](int most) { return std::make_unique<Shortsighted>(most); };
  scene.parts.push_back({"floor", shared(box(Vec3(0.2, 0.2, 0.01))), {Quat::Identity(), Vec3(0, 0, -0.005)}});
  scene.parts.push_back({"block", shared(box(Vec3(0.02, 0.02, 0.02))), {Quat::Identity(), Vec3(0, 0, 0.0101)}, true});
  HapticLoop loop(scene);
  for (int i = 0; i < 100; ++i) loop.step({Quat::Identity(), Vec3(0, 0, 0.01)}, 1e-3);
  CHECK(loop.report().contacts > 0);
  // 30 mm along the floor, at once.
  for (int i = 0; i < 200; ++i) loop.step({Quat::Identity(), Vec3(0.03, 0, 0.01)}, 1e-3);
  CHECK(loop.report().proxy.X.p.x() == Approx(0.03).margin(1e-6));
  CHECK(loop.report().unexplained_lag_ticks == 0);
}

TEST_CASE("a custom resolver that answers nonsense cannot make parts intersect", "[resolver]") {
  const int kind = GENERATE(0, 1, 2, 3, 4);
  CAPTURE(kind);
  std::mt19937 rng(17);
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.contact.custom_resolver = [kind](int) { return std::make_unique<Liar>(kind); };
  scene.parts.push_back({"floor", shared(box(Vec3(0.2, 0.2, 0.01))), {Quat::Identity(), Vec3(0, 0, -0.005)}});
  scene.parts.push_back({"star", shared(random_star_body(rng, 14, 0.02)), {Quat::Identity(), Vec3(0.03, 0, 0.02)}});
  scene.parts.push_back({"block", shared(box(Vec3(0.02, 0.02, 0.02))), {Quat::Identity(), Vec3(0, 0, 0.03)}, true});
  HapticLoop loop(scene);
  const FclOracle oracle(scene);
  int touching = 0;
  for (int i = 0; i < 800; ++i) {
    const double t = 1e-3 * i;
    const Pose Y{rotation(0.5 * Vec3(std::sin(5 * t), std::sin(4 * t), 0)),
                 Vec3(0.03 * std::sin(3 * t), 0.005 * std::sin(7 * t), 0.03 - 0.04 * std::sin(2 * t))};
    const TickReport& r = loop.step(Y, 1e-3);
    touching += r.constraints > 0;
    for (const Pose& X : r.substeps) {
      REQUIRE(X.p.allFinite());
      REQUIRE(X.q.coeffs().allFinite());
      REQUIRE(oracle.intersecting(X).empty());
    }
  }
  CHECK(touching > 100);
}

TEST_CASE("a custom resolver takes the place of the named one, and must exist", "[resolver]") {
  Scene scene;
  scene.parts.push_back({"block", shared(box(Vec3(0.02, 0.02, 0.02))), Pose{}, true});
  int capacity = 0;
  scene.contact.custom_resolver = [&capacity](int most) {
    capacity = most;
    return make_resolver(ResolverKind::lp, most);
  };
  HapticLoop loop(scene);
  CHECK(capacity > 0);
  scene.contact.custom_resolver = [](int) { return std::unique_ptr<Resolver>(); };
  CHECK_THROWS_AS(HapticLoop(scene), Error);
}
