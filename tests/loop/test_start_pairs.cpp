// Scenes that start assembled: seats at exactly zero gap or overlapping by micrometers, and parts drawn into each
// other.
#include <cmath>
#include <random>

#include "bodies.hpp"
#include "catch.hpp"
#include "fcl_oracle.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;
using Catch::Contains;

namespace {

// Rounding of poses and coordinates in these scenes, m.
constexpr double kRounding = 1e-9;
// What the library promises: parts that touch come no deeper into each other than they start, up to this.
constexpr double kNoDeeper = 2.1e-7;

struct Run {
  const Scene& scene;
  HapticLoop loop;
  FclOracle oracle;

  explicit Run(const Scene& s) : scene(s), loop(s), oracle(s) {}

  /// Moves the pen in a straight line to `to` in `ticks`, then lets it stand; `look` is asked at every committed pose.
  template <typename F>
  Pose to(const Pose& from, const Pose& to, int ticks, F look) {
    for (int i = 1; i <= ticks + 40; ++i) {
      const double s = std::min(1.0, static_cast<double>(i) / ticks);
      const TickReport& r = loop.step({from.q.slerp(s, to.q), (1 - s) * from.p + s * to.p}, 1e-3);
      for (const Pose& X : r.substeps) look(X);
    }
    return loop.report().proxy.X;
  }
};

Scene make_scene(const std::string& resolver) {
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  return scene;
}

/// Places everything by `X`.
void carry(Scene& scene, const Pose& X) {
  for (Part& part : scene.parts) part.pose = X * part.pose;
}

const Pose& held_pose(const Scene& scene) {
  for (const Part& p : scene.parts)
    if (p.held) return p.pose;
  throw Error("no part is held");
}

/// A block in front of up to three boards that look along x, y and z: it overlaps the board k by `depth[k]` (m).
struct Corner {
  Scene scene;
  Pose X_W;  ///< of the corner's frame, boards at x <= 0, y <= 0, z <= 0
  Vec3 size;
  std::vector<double> depth;

  Corner(const std::string& resolver, std::mt19937& rng, std::vector<double> depths)
      : scene(make_scene(resolver)), X_W(random_pose(rng, 0.05)), depth(std::move(depths)) {
    std::uniform_real_distribution<double> unit(0, 1);
    size = Vec3(0.01 + 0.02 * unit(rng), 0.01 + 0.02 * unit(rng), 0.01 + 0.02 * unit(rng));
    Vec3 at = 0.5 * size + Vec3(0.011, 0.012, 0.013);  // away from the boards that are not there
    for (std::size_t k = 0; k < depth.size(); ++k) {
      const Vec3 board = Vec3::Constant(0.15) - 0.13 * Vec3::Unit(k);
      scene.parts.push_back(
          {"board " + std::to_string(k), shared(box(board)), {Quat::Identity(), -0.01 * Vec3::Unit(k)}});
      at[k] = 0.5 * size[k] - depth[k];
    }
    scene.parts.push_back({"block", shared(box(size)), {Quat::Identity(), at}, true});
    carry(scene, X_W);
  }

  /// How deep the block at `X` is in board `k`: boards are much larger than the block, so its corners tell.
  double depth_at(const Pose& X, std::size_t k) const {
    double lowest = INFINITY;
    for (const Vec3& v : scene.parts.back().mesh->vertices)
      lowest = std::min(lowest, (X_W.inverse() * (X * v))[static_cast<Eigen::Index>(k)]);
    return -lowest;
  }
  Vec3 outwards() const {
    Vec3 n = Vec3::Zero();
    for (std::size_t k = 0; k < depth.size(); ++k) n[static_cast<Eigen::Index>(k)] = 1;
    return X_W.q * n.normalized();
  }
};

}  // namespace

TEST_CASE("a block that touches one, two or three boards is off them from the first tick on", "[start]") {
  const std::string resolver = GENERATE("lp", "qp", "impulse");
  const int boards = GENERATE(1, 2, 3);
  const int seed = GENERATE(0, 1, 2, 3, 4, 5);
  CAPTURE(resolver, boards, seed);
  std::mt19937 rng(static_cast<unsigned>(100 * boards + seed));
  std::uniform_real_distribution<double> some(0, 9.9e-6);
  std::vector<double> depth;
  // Exactly in line first, then by up to the tolerance.
  for (int k = 0; k < boards; ++k) depth.push_back(seed == 0 ? 0 : some(rng));
  const Corner c(resolver, rng, depth);
  const Pose X0 = held_pose(c.scene);
  Run run(c.scene);

  const InitialContactReport& start = run.loop.start();
  REQUIRE(start.pairs.size() == static_cast<std::size_t>(boards));
  double square = 0;
  for (const InitialContact& p : start.pairs) {
    CHECK(p.clash.kind == ClashKind::touch);
    CHECK((p.clash.gap > 0 ? -p.clash.gap : p.clash.depth.value()) == Approx(depth[p.part]).margin(kRounding));
    CHECK(p.state == InitialContactState::active);
    square += std::pow(depth[p.part] + 2e-6, 2);
  }
  CHECK(start.shift > 1e-6);
  CHECK(start.shift < std::sqrt(square));  // straight off all of them, by what is missing to 2 um at most

  const auto free = [&](const Pose& X) {
    REQUIRE(run.oracle.intersecting(X).empty());
    for (std::size_t k = 0; k < depth.size(); ++k) REQUIRE(c.depth_at(X, k) < 0);
  };
  free(run.loop.report().proxy.X);

  SECTION("contacts are there at the first tick") {
    run.loop.step({X0.q, X0.p - 1e-5 * c.outwards()}, 1e-3);
    CHECK(run.loop.report().proxy.touching);
    CHECK(run.loop.report().contacts >= (resolver == "impulse" ? 1 : 3 * (boards == 1)));
  }
  SECTION("it can be pulled off") {
    const Pose to{X0.q, X0.p + 3e-3 * c.outwards()};
    const Pose X = run.to(X0, to, 40, free);
    CHECK((X.p - to.p).norm() < (resolver == "impulse" ? 2e-4 : kRounding));
  }
  SECTION("it does not go in") {
    const Pose to{X0.q, X0.p - 3e-3 * c.outwards()};
    const Pose X = run.to(X0, to, 40, free);
    for (std::size_t k = 0; k < depth.size(); ++k) CHECK(c.depth_at(X, k) > -3e-5);
    CHECK(run.loop.report().proxy.touching);
  }
  SECTION("it slides along") {
    if (boards == 3 || resolver == "impulse") return;
    const Vec3 way = 4e-3 * (c.X_W.q * Vec3::UnitZ());
    const Vec3 along = boards == 1 ? Vec3(4e-3 * (c.X_W.q * Vec3::UnitY())) : way;
    const Pose X = run.to(X0, {X0.q, X0.p - 5e-4 * c.outwards() + along}, 40, free);
    CHECK((X.p - X0.p).dot(along.normalized()) > 0.98 * along.norm());
  }
}

namespace {

/// A block of 10 mm between the walls of a slot along y that is too narrow by `squeeze` (m), half of it on either side.
/// The slot is one part: two walls on a floor, which the block stands `floor` above.
struct Slot {
  static constexpr double kWidth = 0.01, kLength = 0.03;
  Scene scene;
  double squeeze;

  Slot(const std::string& resolver, double s, double floor) : scene(make_scene(resolver)), squeeze(s) {
    TriangleMesh slot;
    const double x = 0.5 * (kWidth - s), outer = 0.02, top = 0.01, bottom = -0.01;
    const std::vector<std::array<double, 2>> outline = {{-outer, bottom}, {outer, bottom}, {outer, top}, {x, top},
                                                        {x, 0},           {-x, 0},         {-x, top},    {-outer, top}};
    for (const double y : {-0.5 * kLength, 0.5 * kLength})
      for (const auto& p : outline) slot.vertices.push_back({p[0], y, p[1]});
    for (std::uint32_t i = 0; i < 8; ++i) {
      const std::uint32_t j = (i + 1) % 8;
      slot.triangles.push_back({i, j, j + 8});
      slot.triangles.push_back({i, j + 8, i + 8});
    }
    const std::vector<std::array<std::uint32_t, 3>> cap = {{0, 5, 1}, {0, 6, 5}, {0, 7, 6},
                                                           {1, 5, 4}, {1, 4, 2}, {2, 4, 3}};
    for (const auto& t : cap) {
      slot.triangles.push_back({t[0], t[1], t[2]});
      slot.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
    }
    // Caps and sides as listed look inwards or outwards together: turn them out.
    for (auto& t : slot.triangles) std::swap(t[1], t[2]);
    scene.parts.push_back({"slot", shared(slot), Pose{}});
    scene.parts.push_back(
        {"block", shared(box({kWidth, 0.01, 0.012})), {Quat::Identity(), {0, 0, 0.006 + floor}}, true});
  }

  /// How deep a corner of the block at `X` is in a wall, while it is between the walls.
  double deepest(const Pose& X) const {
    double deep = -INFINITY;
    for (const Vec3& v : scene.parts[1].mesh->vertices) {
      const Vec3 p = X * v;
      if (std::abs(p.y()) < 0.5 * kLength && p.z() < 0.01)
        deep = std::max(deep, std::abs(p.x()) - 0.5 * (kWidth - squeeze));
      if (std::abs(p.y()) < 0.5 * kLength) deep = std::max(deep, -p.z());
    }
    return deep;
  }
};

}  // namespace

TEST_CASE("a block pressed into a slot slides, comes no deeper, and is kept out once it came out", "[start]") {
  const std::string resolver = GENERATE("lp", "qp");
  const double squeeze = GENERATE(0.0, 2e-6, 1.2e-5);
  const double floor = GENERATE(0.0, 1e-3);
  CAPTURE(resolver, squeeze, floor);
  const Slot slot(resolver, squeeze, floor);
  Run run(slot.scene);
  const InitialContactReport& start = run.loop.start();
  REQUIRE(start.pairs.size() == 1);
  CHECK(start.pairs[0].clash.depth.value() == Approx(0.5 * squeeze).margin(kRounding));
  CHECK(start.pairs[0].state == InitialContactState::shrunk);
  CHECK(run.loop.report().shrunk == 1);
  const Pose X0 = held_pose(slot.scene);
  const double most = 0.5 * squeeze + kNoDeeper;
  const auto no_deeper = [&](const Pose& X) { REQUIRE(slot.deepest(X) < most); };
  // Pressed against a wall and the floor it slides along.
  Pose pen{X0.q, X0.p + Vec3(5e-4, 4e-3, -5e-4)};
  Pose X = run.to(X0, pen, 60, no_deeper);
  CHECK(X.p.y() > 3.9e-3);
  CHECK(run.loop.report().proxy.touching);
  // Up and out.
  const Pose above{X0.q, X0.p + Vec3(0, 4e-3, 0.012)};
  X = run.to(pen, above, 200, no_deeper);
  CHECK((X.p - above.p).norm() < 1e-5);
  CHECK(run.loop.report().shrunk == 0);
  CHECK(start.pairs[0].state == InitialContactState::active);
  CHECK(start.pairs[0].freed == 1);
  // And not in again, as there is no room.
  X = run.to(above, X0, 200, [&](const Pose& P) { REQUIRE(run.oracle.intersecting(P).empty()); });
  CHECK(X.p.z() > 0.015);
}

TEST_CASE("a block pressed in between two boards is pulled out from where it rubs on their ends", "[start]") {
  // Walls of two parts, exactly opposite, with no room between: their constraints have no answer but along them.
  const std::string resolver = GENERATE("lp", "qp");
  const double aside = GENERATE(0.0, 1e-6, 1e-4);
  CAPTURE(resolver, aside);
  Scene scene = make_scene(resolver);
  for (const double side : {-1.0, 1.0})
    scene.parts.push_back({side < 0 ? "left" : "right",
                           shared(box({0.01, 0.02, 0.02})),
                           {Quat::Identity(), {side * (0.01 - 3e-6), 0, 0}}});
  scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), Pose{}, true});
  HapticLoop loop(scene);
  REQUIRE(loop.report().shrunk == 2);
  for (int i = 1; i <= 1000; ++i) {
    const double y = 2e-5 * i;
    const Pose Y{Quat::Identity(), {i > 100 && i <= 200 ? aside : 0, y, 0}};
    const Pose& X = loop.step(Y, 1e-3).proxy.X;
    REQUIRE(X.p.y() == Approx(y).margin(1e-5));
    // While they overlap along y, no deeper than at the start.
    if (y < 0.0149) REQUIRE(std::abs(X.p.x()) < kNoDeeper);
  }
  CHECK(loop.report().shrunk == 0);
}

TEST_CASE("overlapping parts are refused, with names, depth, place and what to do", "[start]") {
  Scene scene = make_scene("qp");
  scene.parts.push_back({"plate", shared(box({0.1, 0.1, 0.02})), {Quat::Identity(), {0, 0, -0.01}}});
  scene.parts.push_back({"block", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {0.02, 0.01, 0.0049}}, true});
  CHECK_THROWS_WITH(HapticLoop(scene), Contains("\"block\" and \"plate\"") && Contains("100 um deep") &&
                                           Contains("-0.0001) m") && Contains("initial_overlap") &&
                                           Contains("touch_tolerance"));
  scene.contact.touch_tolerance = 2e-4;
  CHECK(HapticLoop(scene).start().pairs[0].state == InitialContactState::active);
  scene.contact.touch_tolerance = 0;
  scene.parts[1].pose.p.z() = 0.005 - 1e-6;
  CHECK_THROWS_AS(HapticLoop(scene), Error);
}

TEST_CASE("an ignored overlap is suspended until it has come free; others hold meanwhile", "[start]") {
  const std::string resolver = GENERATE("lp", "qp", "impulse");
  const std::string narrowphase = GENERATE("patch", "fcl");
  if (resolver == "impulse" && narrowphase == "fcl") return;
  CAPTURE(resolver, narrowphase);
  Scene scene = make_scene(resolver);
  scene.contact.narrowphase = narrowphase == "fcl" ? NarrowPhase::fcl : NarrowPhase::patch;
  scene.contact.initial_overlap = InitialOverlap::ignore;
  // A bolt drawn 5 mm into a post, over a floor that it stands on.
  scene.parts.push_back({"post", shared(box({0.02, 0.02, 0.04})), {Quat::Identity(), {0.02, 0, 0.02}}});
  scene.parts.push_back({"floor", shared(box({0.2, 0.2, 0.02})), {Quat::Identity(), {0, 0, -0.01}}});
  scene.parts.push_back({"bolt", shared(box({0.02, 0.01, 0.01})), {Quat::Identity(), {0.005, 0, 0.005}}, true});
  Run run(scene);
  const InitialContactReport& start = run.loop.start();
  REQUIRE(start.pairs.size() == 2);
  for (const InitialContact& p : start.pairs)
    CHECK(p.state == (p.part == 0 ? InitialContactState::filtered : InitialContactState::active));
  CHECK(run.loop.report().filtered == 1);
  const auto floor_holds = [&](const Pose& X) {
    const auto hit = run.oracle.intersecting(X);
    REQUIRE(std::count(hit.begin(), hit.end(), "floor") == 0);
  };
  floor_holds(run.loop.report().proxy.X);
  const Pose X0 = held_pose(scene), deeper{X0.q, X0.p + Vec3(4e-3, 1e-3, -2e-3)};
  Pose X = run.to(X0, deeper, 40, floor_holds);
  CHECK(X.p.x() > X0.p.x() + 3.9e-3);  // nothing keeps it out of the post
  CHECK(run.loop.report().filtered == 1);
  const Pose out{X0.q, X0.p + Vec3(-9e-3, 0, 1e-3)};
  run.to(deeper, out, 100, floor_holds);
  CHECK(run.loop.report().filtered == 0);
  const Pose in{X0.q, X0.p + Vec3(2e-3, 0, 1e-3)};
  X = run.to(out, in, 100, [&](const Pose& P) { REQUIRE(run.oracle.intersecting(P).empty()); });
  CHECK(X.p.x() < 1e-9);
}

TEST_CASE("a part inside another is not free of it because their surfaces do not meet", "[start]") {
  Scene scene = make_scene("qp");
  scene.contact.initial_overlap = InitialOverlap::ignore;
  scene.parts.push_back({"block", shared(box({0.04, 0.04, 0.04})), Pose{}});
  scene.parts.push_back({"pin", shared(box({0.01, 0.01, 0.01})), {Quat::Identity(), {0.005, 0, 0}}, true});
  CHECK_THROWS_WITH(
      [&] {
        Scene refused = scene;
        refused.contact.initial_overlap = InitialOverlap::refuse;
        HapticLoop loop(refused);
      }(),
      Contains("one inside the other"));
  Run run(scene);
  const Pose X0 = held_pose(scene);
  const auto none = [](const Pose&) {};
  const Pose across{X0.q, {-0.012, 0, 0}}, out{X0.q, {-0.03, 0, 0}};
  run.to(X0, across, 50, none);
  CHECK(run.loop.report().filtered == 1);
  run.to(across, out, 50, none);
  CHECK(run.loop.report().filtered == 0);
  run.to(out, X0, 50, [&](const Pose& P) { REQUIRE(run.oracle.intersecting(P).empty()); });
  CHECK(run.loop.report().proxy.X.p.x() < -0.025);
}
