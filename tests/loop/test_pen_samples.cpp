// Pen samples and times that cannot be: each kind, in each resolver, in contact and in the air.
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>

#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct PenInput {
  Pose Y;
  double dt = 1e-3;
};

/// What becomes of a good sample, and whether the loop may take it.
struct Kind {
  const char* name;
  std::function<void(PenInput&)> spoil;
  bool taken;
};

std::vector<Kind> kinds() {
  std::vector<Kind> all = {
      {"far within range", [](PenInput& s) { s.Y.p.x() = 9.9e3; }, true},
      {"far down", [](PenInput& s) { s.Y.p.z() = -9.9e3; }, true},
      {"no time", [](PenInput& s) { s.dt = 0; }, true},
      {"a microsecond", [](PenInput& s) { s.dt = 1e-6; }, true},
      {"a day", [](PenInput& s) { s.dt = 86400; }, true},
      {"a rounding off unit length", [](PenInput& s) { s.Y.q.coeffs() *= 1 + 1e-4; }, true},
      {"no length", [](PenInput& s) { s.Y.q.coeffs().setZero(); }, false},
      {"twice the length", [](PenInput& s) { s.Y.q.coeffs() *= 2; }, false},
  };
  for (const double p : {1.1e4, -1e9, 1e17, -1e200, 1.7e308, kInf, -kInf, kNaN})
    for (int axis = 0; axis < 3; ++axis)
      all.push_back({"a position", [p, axis](PenInput& s) { s.Y.p[axis] = p; }, false});
  for (const double q : {1e-300, 1e-150, 1e150, 1e200, 1.7e308, kInf, kNaN})
    all.push_back({"a quaternion", [q](PenInput& s) { s.Y.q.coeffs() *= q; }, false});
  for (const double dt : {1e-308, 1e-300, 1e-12, 9e-7, -1e-3, -kInf, kInf, kNaN})
    all.push_back({"a time", [dt](PenInput& s) { s.dt = dt; }, false});
  return all;
}

Scene block_over_floor(const std::string& resolver) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = kInf;
  scene.parts.push_back({"floor", shared(box({0.3, 0.3, 0.02})), {Quat::Identity(), {0, 0, -0.01}}});
  scene.parts.push_back({"block", shared(box({0.03, 0.02, 0.02})), {Quat::Identity(), {0, 0, 0.03}}, true});
  return scene;
}

bool is_pose(const Pose& X) {
  return X.p.allFinite() && std::abs(X.q.norm() - 1) < 1e-9;
}

/// Whether each piece is a pose, and free where the resolver keeps it so.
bool proper_pieces(const TickReport& report, const FclOracle* oracle) {
  for (const Pose& X : report.substeps)
    if (!is_pose(X) || (oracle != nullptr && !oracle->intersecting(X).empty())) return false;
  return !report.substeps.empty() && report.proxy.velocity.v.allFinite() && report.proxy.velocity.w.allFinite();
}

}  // namespace

TEST_CASE("a sample that no pen can have is flagged, and the part goes on as if it had not come", "[sim]") {
  const std::string resolver = GENERATE("qp", "lp", "impulse", "penalty");
  const Scene scene = block_over_floor(resolver);
  const FclOracle fcl(scene);
  const FclOracle* oracle = resolver == "penalty" ? nullptr : &fcl;
  for (const bool air : {false, true})
    for (const Kind& kind : kinds()) {
      HapticLoop loop(scene);
      PenInput good{loop.latest()};
      for (int i = 0; i < 60; ++i) {
        good.Y.p.z() += (air ? 1 : -1) * 5e-4;
        loop.step(good.Y, good.dt);
      }
      REQUIRE(loop.report().proxy.touching != air);
      PenInput bad = good;
      kind.spoil(bad);
      CAPTURE(resolver, air, kind.name, bad.Y.p.transpose(), bad.Y.q.norm(), bad.dt);
      const Pose before = loop.latest();
      const TickReport& report = loop.step(bad.Y, bad.dt);
      CHECK(report.flags.input_ignored != kind.taken);
      CHECK(proper_pieces(report, oracle));
      if (!kind.taken) CHECK((report.proxy.X.p - before.p).norm() < 1e-3);  // with impulse it moves on
      bool proper = true;
      for (int i = 0; i < 600; ++i) {
        // Back over the floor, and then about in the air.
        const double up = std::min(1.0, i / 200.0), s = std::max(0, i - 200);
        loop.step({Quat::Identity(), Vec3(0.01 * std::sin(0.01 * s), 0, good.Y.p.z() + up * (0.06 - good.Y.p.z()))},
                  1e-3);
        proper = proper && !report.flags.input_ignored && proper_pieces(report, oracle);
      }
      CHECK(proper);
      CHECK(report.contacts == 0);
      CHECK((loop.latest().p - Vec3(0.01 * std::sin(0.01 * 399), 0, 0.06)).norm() < 1e-3);
    }
}

TEST_CASE("a part that stands where no pen can be is refused", "[sim]") {
  const std::size_t part = GENERATE(0u, 1u);
  Scene scene = block_over_floor("qp");
  Pose& pose = scene.parts[part].pose;
  SECTION("far away") {
    pose.p.x() = 1e5;
  }
  SECTION("not finite") {
    pose.p.x() = kNaN;
  }
  SECTION("no rotation") {
    pose.q.coeffs() *= 3;
  }
  CHECK_THROWS_WITH(HapticLoop(scene), Catch::Contains(scene.parts[part].name));
}
