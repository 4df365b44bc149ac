// How much force an assembly takes, over depth.
#include <cmath>

#include "bodies.hpp"
#include "catch.hpp"
#include "review/assembly_force.hpp"
#include "review/review.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::review;
using namespace tegotae::test;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

/// A block over a floor, led from one pose to another; no rows yet.
Review review_of(const Pose& from, const Pose& to) {
  Scene scene;
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"floor", shared(box({0.4, 0.4, 0.02})), {Quat::Identity(), {0, 0, -0.01}}});
  scene.parts.push_back({"block", shared(box({0.04, 0.04, 0.02})), from, true});
  SceneFile file{"scene.toml", scene, {}, StylusScript({{0, from}, {1, to}}), {}, "", {}};
  return {"r.mcap", std::move(file), {}, Vec3::Zero(), {}, {}, {}, {}, {}};
}

/// A row `depth` down from `top`, with one contact that pushes up by `normal` and by `friction` (N).
RecordFrame row(std::uint64_t tick, double top, double depth, double normal, double friction) {
  RecordFrame f;
  f.tick = tick;
  f.t = 1e-3 * static_cast<double>(tick);
  f.x.p = f.y.p = {0, 0, top - depth};
  ContactForce& c = f.forces.items[0];
  c.part = {0};
  c.n = Vec3::UnitX();
  c.force = normal;
  c.mu = 0.5;
  c.friction = {0, 0, friction};
  // A second contact, straight against the way.
  ContactForce& end = f.forces.items[1];
  end.part = {0};
  end.n = Vec3::UnitZ();
  end.force = 1;
  end.point = {0.01, 0, 0};
  f.forces.count = 2;
  return f;
}

}  // namespace

TEST_CASE("insertion, seating and pull-out are told apart, with friction's share", "[review]") {
  const double top = 0.05;
  Review r = review_of({Quat::Identity(), {0, 0, top}}, {Quat::Identity(), {0, 0, 0.01}});
  auto& rows = r.recording.frames;
  std::uint64_t tick = 0;
  // Down by 40 mm against 1 N and a friction that grows to 2 N; there against 5 N more; and up against 0.5 N.
  for (int i = 0; i <= 4000; ++i) rows.push_back(row(tick++, top, 1e-5 * i, 4, 2.0 * i / 4000));
  for (int i = 0; i < 100; ++i) rows.push_back(row(tick++, top, 0.04, 10, 6));
  for (int i = 0; i <= 4000; ++i) rows.push_back(row(tick++, top, 0.04 - 1e-5 * i, 4, -1.5));
  const AssemblyForce f = assembly_force(r, {}, false, {});
  REQUIRE(f.known);
  CHECK(f.rubs);
  CHECK(f.way == Approx(0.04));
  CHECK(f.insertion.force == Approx(3).epsilon(0.01));
  CHECK(f.insertion.depth == Approx(0.04).epsilon(0.01));
  CHECK(f.insertion.part == "floor");
  CHECK(f.insertion_mean == Approx(2).epsilon(0.01));
  CHECK(f.friction_share == Approx(0.5).epsilon(0.01));
  CHECK(f.seating.force == Approx(7));
  CHECK(f.seating.depth == Approx(0.04));
  CHECK(f.pull_out.force == Approx(0.5));
  CHECK(f.pull_out_mean == Approx(0.5).epsilon(0.01));
  for (const DepthForce& d : f.over_depth) {
    CHECK(d.insertion == Approx(1 + 2 * d.depth / 0.04).epsilon(0.02));
    CHECK(d.friction == Approx(2 * d.depth / 0.04).margin(0.02));
    CHECK(d.pull_out == Approx(0.5).epsilon(0.01));
    CHECK(d.pull_out_peak == Approx(0.5).epsilon(0.01));
    // It stood at the end of the way only.
    if (&d == &f.over_depth.back())
      CHECK(d.seating == Approx(7).epsilon(0.02));  // a tick of it is of the way
    else
      CHECK(std::isnan(d.seating));
    CHECK(std::isnan(d.low));
  }
  const std::string csv = assembly_force_csv(f);
  CHECK(csv.rfind("depth_mm,insertion_n,", 0) == 0);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 201);
  const std::vector<std::string> text = assembly_force_text(f);
  REQUIRE(text.size() == 3);
  CHECK_THAT(text[0], StartsWith("insertion: at most 3.00 N at "));
  CHECK_THAT(text[1], StartsWith("seating (final): at most 7.00 N at 40.00 mm, against floor"));
  CHECK_THAT(text[2], StartsWith("pull-out: at most 0.50 N at "));
}

TEST_CASE("what a way out takes is told as the pull-out, over the depth that the part had", "[review]") {
  const double top = 0.05;
  Review r = review_of({Quat::Identity(), {0, 0, 0.01}}, {Quat::Identity(), {0, 0, top}});
  auto& rows = r.recording.frames;
  std::uint64_t tick = 0;
  // Stands 40 mm deep against 7 N; up against 0.5 N and, from half way on, 1.5 N; once back a little against 1 N and 1
  // N more.
  for (int i = 0; i < 100; ++i) rows.push_back(row(tick++, top, 0.04, 10, 6));
  for (int i = 0; i <= 2000; ++i) rows.push_back(row(tick++, top, 0.04 - 1e-5 * i, 4, -1.5));
  for (int i = 0; i <= 200; ++i) rows.push_back(row(tick++, top, 0.02 + 1e-5 * i, 4, 1));
  for (int i = 0; i <= 2200; ++i) rows.push_back(row(tick++, top, 0.022 - 1e-5 * i, 4, -2.5));
  const AssemblyForce f = assembly_force(r, {}, true, {});
  REQUIRE(f.known);
  CHECK(f.way == Approx(0.04));
  CHECK(f.pull_out.force == Approx(1.5));
  CHECK(f.pull_out.depth < 0.0221);
  CHECK(f.pull_out_mean == Approx(1).epsilon(0.05));
  CHECK(f.insertion.force == Approx(2));
  CHECK(f.seating.force == Approx(7));
  CHECK(f.seating.depth == Approx(0.04));
  for (const DepthForce& d : f.over_depth) {
    if (d.depth > 0.019 && d.depth < 0.023) continue;  // where it went back
    CHECK(d.pull_out == Approx(d.depth > 0.02 ? 0.5 : 1.5).epsilon(0.02));
    CHECK(d.friction == Approx(d.depth > 0.02 ? 1.5 : 2.5).epsilon(0.02));
    CHECK(std::isnan(d.insertion));
  }
  const std::vector<std::string> text = assembly_force_text(f);
  REQUIRE(text.size() == 3);
  CHECK(text[0].find("friction") == std::string::npos);
  CHECK_THAT(text[2], StartsWith("pull-out: at most 1.50 N at ") && EndsWith(" of it friction"));
}

TEST_CASE("a recording without contact forces, or of a part that goes nowhere, has no force of an assembly",
          "[review]") {
  const double top = 0.05;
  Review r = review_of({Quat::Identity(), {0, 0, top}}, {Quat::Identity(), {0, 0, 0.01}});
  for (int i = 0; i <= 400; ++i) {
    r.recording.frames.push_back(row(static_cast<std::uint64_t>(i), top, 1e-4 * i, 1, 1));
    r.recording.frames.back().forces = {};
  }
  CHECK_FALSE(assembly_force(r, {}, false, {}).known);
  Review still = review_of({Quat::Identity(), {0, 0, top}}, {Quat::Identity(), {0, 0, top}});
  for (int i = 0; i <= 400; ++i) still.recording.frames.push_back(row(static_cast<std::uint64_t>(i), top, 0, 1, 1));
  const AssemblyForce f = assembly_force(still, {}, false, {});
  CHECK_FALSE(f.known);
  CHECK(assembly_force_text(f).empty());
}

TEST_CASE("a band of friction leads the recorded pen once more", "[review]") {
  // Pressed on the floor with 1.6 N and pushed along it by 30 mm: what resists is mu N.
  const Pose from{Quat::Identity(), {0, 0, 0.01002}};
  Review r = review_of(from, {Quat::Identity(), {0.03, 0, 0.008}});
  r.file.scene.friction.mu = 0.2;
  HapticLoop loop(r.file.scene);
  r.center = loop.center();
  for (int i = 0; i < 1700; ++i) {
    RecordFrame f;
    f.tick = static_cast<std::uint64_t>(i);
    f.t = 1e-3 * i;
    f.y = {Quat::Identity(), {2e-5 * std::max(0, i - 200), 0, 0.01 - 2e-3 * std::min(1.0, i / 200.0)}};
    const TickReport& report = loop.step(f.y, 1e-3);
    f.x = report.proxy.X;
    f.forces = report.forces;
    r.recording.frames.push_back(f);
  }
  r.file.script = StylusScript({{0, from}, {1, {Quat::Identity(), {0.03, 0, 0.01}}}});
  const AssemblyForce f = assembly_force(r, {0.1, 0.4}, false, {});
  REQUIRE(f.known);
  CHECK(f.insertion_mean == Approx(0.2 * 1.6).epsilon(0.02));
  CHECK(f.friction_share == Approx(1).epsilon(0.02));
  CHECK(f.low_mean == Approx(0.1 * 1.6).epsilon(0.02));
  CHECK(f.high_mean == Approx(0.4 * 1.6).epsilon(0.02));
  CHECK(f.high_depth < f.way);
  CHECK(f.low_depth > f.way);
}

TEST_CASE("forces and depths that round to zero have no sign", "[review]") {
  AssemblyForce f;
  f.known = true;
  f.insertion = {0.004, -1e-6, 0, Vec3::Zero(), "base"};
  f.pull_out = f.seating = f.insertion;
  f.insertion_mean = f.pull_out_mean = f.low_mean = f.high_mean = -0.0049;
  f.low_depth = f.high_depth = -4e-6;
  f.band = {0.1, 0.2};
  CHECK(assembly_force_text(f) ==
        std::vector<std::string>{
            "insertion: at most 0.00 N at 0.00 mm, against base; 0.00 N in the mean over the way",
            "seating (final): at most 0.00 N at 0.00 mm, against base",
            "pull-out: at most 0.00 N at 0.00 mm, against base; 0.00 N in the mean over the way",
            "insertion with friction of 0.1 to 0.2: 0.00 to 0.00 N in the mean, to 0.00 and 0.00 mm"});
}
