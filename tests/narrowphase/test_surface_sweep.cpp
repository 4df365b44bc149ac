// Motions that are looked at as a whole: what is said to be free or met against exact tests of triangles and FCL.
#include "alloc_guard.hpp"
#include "catch.hpp"
#include "core/numbers.hpp"
#include "narrowphase/facing.hpp"
#include "narrowphase/offered_motions.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "narrowphase/surface_sweep.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"
#include "tegotae/core/clock.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kClearance = 1.1e-6;
/// What is met ends a motion so much before it is touched, at most (m), with what finding the place leaves.
constexpr double kEndsBefore = 14e-6;

std::shared_ptr<const PatchTree> tree_of(const MeshPtr& mesh) {
  return std::make_shared<const PatchTree>(mesh);
}

/// A sweep past one part whose file frame is the world's.
SurfaceSweep sweep_past(const MeshPtr& a, const MeshPtr& b, const Vec3& center,
                        std::shared_ptr<const Facing> facing = nullptr) {
  return SurfaceSweep(tree_of(a), center, {{tree_of(b), Pose{}}}, std::move(facing), nullptr, 24);
}

double run(SurfaceSweep& sweep, const Pose& X, const Displacement& d, bool outside = false, double worth = kInfinity) {
  const std::vector<std::uint32_t> near = {0};
  const std::vector<bool> nothing_inside = {outside};
  const AllocGuard guard;
  SweepAim aim;
  aim.clearance = kClearance;
  aim.worth = worth;
  sweep.begin(X, d, near, nothing_inside, aim);
  sweep.go_on(kNoDeadline);
  CHECK(guard.count() == 0);
  CHECK(!sweep.under_way());
  return sweep.share();
}

/// The surface and a box of few faces below it.
MeshPtr on_base(const MeshPtr& surface) {
  TriangleMesh both = *surface;
  const MeshPtr base = box({0.06, 0.06, 0.02});
  const auto first = static_cast<std::uint32_t>(both.vertices.size());
  for (const Vec3& v : base->vertices) both.vertices.emplace_back(v - Vec3(0, 0, 0.025));
  for (const auto& t : base->triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return std::make_shared<const TriangleMesh>(both);
}

Pose random_start(std::mt19937& rng, const Scene& scene) {
  return displaced(scene.start, scene.center, {random_in_ball(rng, scene.move), random_in_ball(rng, scene.turn)});
}

Displacement random_motion(std::mt19937& rng, const Scene& scene, bool turns) {
  const Vec3 moved = random_in_ball(rng, 8 * scene.move);
  return {moved, turns ? random_in_ball(rng, scene.turn) : Vec3::Zero()};
}

}  // namespace

TEST_CASE("the first part of a motion is free as far as is said, and what was met is met soon after it") {
  std::mt19937 rng(33);
  int whole = 0, cut = 0;
  for (const Scene& scene : scenes()) {
    INFO(scene.name);
    const Oracle oracle(scene.a, scene.b);
    SurfaceSweep sweep = sweep_past(scene.a, scene.b, scene.center);
    for (int n = 0; n < 60; ++n) {
      const Pose X = random_start(rng, scene);
      if (oracle.meet(X) || oracle.distance(X) < 2 * kClearance) continue;
      const Displacement d = random_motion(rng, scene, n % 3 != 0);
      const double share = run(sweep, X, d);
      CHECK(oracle.hits(X, scene.center, share * d, 20) == 0);
      (share == 1 ? whole : cut) += 1;
      if (share == 1) {
        CHECK(sweep.blocking().empty());
        continue;
      }
      CHECK(sweep.blocking().empty() == sweep.ended_early());
      if (n % 3 != 0 || sweep.ended_early()) continue;
      // Straight ways end where there is something, and it is told.
      const FacePair met = sweep.blocking().front();
      const Pose end = displaced(X, scene.center, share * d);
      CHECK(Oracle(single(*scene.a, met.a), single(*scene.b, met.b)).distance(end) < kEndsBefore);
      CHECK(oracle.distance(end) < kEndsBefore);
    }
  }
  CHECK(whole > 20);
  CHECK(cut > 20);
}

TEST_CASE("what whole blocks tell to be free is free, and most of it or as much as it was to be worth") {
  std::mt19937 rng(36);
  int by_blocks = 0, by_faces = 0;
  auto all = scenes();
  all.push_back({"sheet", wave(0.1, 0.01, 0.05, 40), wave(0.1, 0.01, 0.05, 57), Vec3::Zero(),
                 Pose{Quat::Identity(), Vec3(0, 0, 0.01)}, 0.004, 0.02});
  // What is under large nodes of small faces and large ones is asked.
  all.push_back({"sheet on a die with a base", wave(0.05, 0.002, 0.05, 60), on_base(wave(0.1, 0.002, 0.05, 80)),
                 Vec3::Zero(), Pose{Quat::Identity(), Vec3(0, 0, 0.002)}, 0.001, 0.02});
  for (const Scene& scene : all) {
    INFO(scene.name);
    const Oracle oracle(scene.a, scene.b);
    const auto tree = tree_of(scene.a);
    SurfaceSweep sweep(tree, scene.center, {{tree_of(scene.b), Pose{}}}, Facing::of(scene.a, tree), nullptr, 24);
    for (int n = 0; n < 60; ++n) {
      const Pose X = random_start(rng, scene);
      if (oracle.meet(X) || oracle.distance(X) < 2 * kClearance) continue;
      const Displacement d = random_motion(rng, scene, n % 3 != 0);
      const double share = run(sweep, X, d, true), worth = uniform(rng, 0, 0.5) * d.dp.norm();
      const double rough = run(sweep, X, d, true, worth);
      CHECK(oracle.hits(X, scene.center, rough * d, 20) == 0);
      const double size = d.dp.norm() + (tree->radius() + (tree->origin() - scene.center).norm()) * d.dr.norm();
      CHECK(rough < share + kEndsBefore / size);
      if (sweep.ended_early()) {
        CHECK(rough * size > std::min(worth, 0.84 * share * size) * (1 - 1e-9));
        CHECK(sweep.blocking().empty());
        ++by_blocks;
      } else if (rough < 1) {
        CHECK(!sweep.blocking().empty());
        ++by_faces;
      }
    }
  }
  CHECK(by_blocks > 20);
  CHECK(by_faces > 20);
}

TEST_CASE("what would be asked face by face for seconds is looked at less far") {
  // Around in its hole, no plane that stands still keeps faces of the peg apart from those that they pass.
  const MeshPtr pin = peg(0.01, 0.03, 20000), bore = hole(0.01 + 5e-5, 0.02, 20000);
  const Oracle oracle(pin, bore);
  SurfaceSweep sweep = sweep_past(pin, bore, Vec3::Zero());
  const Displacement far{Vec3::Zero(), Vec3(0, 0, 0.6)}, near{Vec3::Zero(), Vec3(0, 0, 1e-4)};
  REQUIRE(!oracle.meet(Pose{}));
  const double share = run(sweep, Pose{}, far);
  CHECK(sweep.ended_early());
  CHECK(sweep.blocking().empty());
  CHECK(share > 1e-3);
  CHECK(oracle.hits(Pose{}, Vec3::Zero(), share * far, 50) == 0);
  CHECK(run(sweep, Pose{}, near) == 1);
  CHECK(!sweep.ended_early());
}

TEST_CASE("a sheet comes down on its die to where FCL finds touching") {
  const MeshPtr sheet = wave(0.1, 0.01, 0.05, 40), die = wave(0.1, 0.01, 0.05, 57);
  const Oracle oracle(sheet, die);
  SurfaceSweep sweep = sweep_past(sheet, die, Vec3::Zero());
  for (const double turn : {0.0, 0.003}) {
    const Pose X{rotation(Vec3(0, turn, turn)), Vec3(0.001, 0, 0.01)};
    const Displacement down{{0, 0, -0.02}, {0, 0, 0}};
    REQUIRE(!oracle.meet(X));
    const double share = run(sweep, X, down);
    REQUIRE(share < 1);
    CHECK(oracle.hits(X, Vec3::Zero(), share * down, 40) == 0);
    CHECK(oracle.distance(displaced(X, Vec3::Zero(), share * down)) < kEndsBefore);
  }
}

TEST_CASE("what a few faces meet at once is told, and nothing is free then") {
  const MeshPtr sheet = wave(0.1, 0.01, 0.05, 60), die = wave(0.1, 0.01, 0.05, 60);
  SurfaceSweep sweep = sweep_past(sheet, die, Vec3::Zero());
  const double within = 20e-6;
  const auto look = [&](double above, const Displacement& d, double blocked_within) {
    SweepAim aim;
    aim.clearance = kClearance;
    aim.blocked_within = blocked_within;
    sweep.begin({Quat::Identity(), Vec3(0, 0, above)}, d, {0}, {false}, aim);
    sweep.go_on(kNoDeadline);
    return sweep.share();
  };
  // Along the seat the flanks are met soon, and far above it nothing is.
  const Displacement along{{1e-3, 0, 0}, {0, 0, 0}}, down{{0, 0, -1e-3}, {0, 0, 0}};
  const double share = look(8e-6, along, 0);
  REQUIRE(share > 0);
  REQUIRE(share * along.dp.norm() < within);
  CHECK(!sweep.met_at_once());
  CHECK(look(8e-6, along, within) == 0);
  CHECK(sweep.met_at_once());
  CHECK(!sweep.ended_early());
  REQUIRE(!sweep.blocking().empty());
  for (const FacePair& met : sweep.blocking()) {
    const Oracle pair(single(*sheet, met.a), single(*die, met.b));
    CHECK(pair.path_distance({Quat::Identity(), Vec3(0, 0, 8e-6)}, Vec3::Zero(), (within / 1e-3) * along, 20) <
          kEndsBefore);
  }
  CHECK(look(2e-3, down, within) == 1);
  CHECK(!sweep.met_at_once());
  CHECK(sweep.blocking().empty());
  // What is met later ends the motion there.
  const double later = look(3e-4, down, within);
  CHECK(later == look(3e-4, down, 0));
  CHECK(later > 0.2);
}

TEST_CASE("a sweep that is interrupted at every step ends like one that is not") {
  const MeshPtr sheet = wave(0.1, 0.01, 0.05, 30), die = wave(0.1, 0.01, 0.05, 41);
  SurfaceSweep at_once = sweep_past(sheet, die, Vec3::Zero()), in_steps = sweep_past(sheet, die, Vec3::Zero());
  const Pose X{rotation(Vec3(0, 0.01, 0)), Vec3(0, 0, 0.012)};
  const Displacement down{{0.001, 0, -0.02}, {0, 0, 0.02}};
  const double share = run(at_once, X, down);
  in_steps.begin(X, down, {0}, {false}, {kClearance});
  int calls = 1;
  while (!in_steps.go_on(1)) ++calls;
  CHECK(calls > 100);
  CHECK(in_steps.share() == share);
  REQUIRE(in_steps.blocking().size() == at_once.blocking().size());
  for (std::size_t i = 0; i < at_once.blocking().size(); ++i) {
    CHECK(in_steps.blocking()[i].a == at_once.blocking()[i].a);
    CHECK(in_steps.blocking()[i].b == at_once.blocking()[i].b);
  }
}

TEST_CASE("of several parts, what is met nearest is told first") {
  // Plates of 4 mm under the left and the right of a third, one of them nearer.
  const auto plate = tree_of(box({0.01, 0.01, 0.002})), held = tree_of(box({0.03, 0.005, 0.002}));
  for (const int nearer : {0, 1}) {
    const auto down = [&](int part) { return part == nearer ? -0.01 : -0.02; };
    const std::vector<CellFront::FixedPart> fixed = {{plate, {Quat::Identity(), Vec3(-0.015, 0, down(0))}},
                                                     {plate, {Quat::Identity(), Vec3(0.015, 0, down(1))}}};
    SurfaceSweep sweep(held, Vec3::Zero(), fixed, nullptr, nullptr, 24);
    sweep.begin(Pose{}, {{0, 0, -0.05}, Vec3::Zero()}, {0, 1}, {false, false}, {kClearance});
    sweep.go_on(kNoDeadline);
    REQUIRE(!sweep.blocking().empty());
    CHECK(sweep.blocking().front().part == static_cast<std::uint32_t>(nearer));
    CHECK(std::abs(sweep.share() - 0.006 / 0.05) < kEndsBefore / 0.05);
    // What was met before, farther on, is told after it.
    if (nearer == 1) CHECK(sweep.blocking().back().part == 0);
  }
}

TEST_CASE("of a solid the faces that recede need not be looked at") {
  std::mt19937 rng(34);
  const MeshPtr a = box({0.02, 0.015, 0.01}), b = knot(0.05, 0.006, 800);
  const auto tree = tree_of(a);
  const auto facing = Facing::of(a, tree);
  REQUIRE(facing);
  const Oracle oracle(a, b);
  SurfaceSweep some(tree, Vec3::Zero(), {{tree_of(b), Pose{}}}, facing, nullptr, 24);
  SurfaceSweep all = sweep_past(a, b, Vec3::Zero());
  int cut = 0;
  for (int n = 0; n < 60; ++n) {
    const Pose X{rotation(random_in_ball(rng, 3)), 0.085 * random_in_ball(rng, 1).normalized()};
    if (oracle.meet(X)) continue;
    const Displacement d{random_in_ball(rng, 0.1), n % 2 == 0 ? Vec3::Zero() : random_in_ball(rng, 0.2)};
    const double share = run(some, X, d, true);
    CHECK(share == Approx(run(all, X, d)).margin(kEndsBefore / d.dp.norm()));
    CHECK(oracle.hits(X, Vec3::Zero(), share * d, 20) == 0);
    cut += share < 1;
  }
  CHECK(cut > 10);
}

TEST_CASE("a way is gone along in both directions, but not back before where it was come to") {
  const Vec3 center(0.01, 0, 0);
  ProvedWay way(center, 0.05, 4);
  const Pose X{rotation(Vec3(0.1, 0.2, 0.3)), Vec3(1, 2, 3)};
  const Displacement d{{0.01, 0, 0}, {0, 0, 0.1}};
  CHECK(!way.toward(X, d));
  way.set(X, d, {2, 3});
  const auto at = [&](double s) { return displaced(X, center, s * d); };
  const auto size = [](const Displacement& by) { return by.dp.norm() + 0.05 * by.dr.norm(); };
  const Pose half = at(0.5);
  way.come_to(half);
  REQUIRE(way.toward(half, 0.25 * d));
  CHECK(size(displacement(displaced(half, center, *way.toward(half, 0.25 * d)), at(0.75), center)) < 1e-12);
  // What leads beyond the end ends there, and what leads back where it was come to.
  CHECK(size(displacement(displaced(half, center, *way.toward(half, 2.0 * d)), at(1), center)) < 1e-12);
  const Pose later = at(0.8);
  CHECK(size(displacement(displaced(later, center, *way.toward(later, -1.0 * d)), half, center)) < 1e-12);
  CHECK(way.ends_at(at(1)));
  CHECK(!way.done());
  way.come_to(at(1));
  CHECK(way.done());
  // Beside the way there is no proof, only a motion onto it.
  const Pose beside{half.q, half.p + Vec3(0, 1e-9, 0)};
  CHECK(!way.is_on(beside));
  CHECK(!way.toward(beside, d));
  REQUIRE(way.join(beside, 0.25 * d));
  CHECK(way.is_on(displaced(beside, center, *way.join(beside, 0.25 * d))));
  way.drop();
  CHECK(!way.toward(half, d));
}

TEST_CASE("a motion is not offered again where it was not made, but a short one that was made does not count") {
  OfferedMotions offered(Vec3(0.01, 0, 0), 0.05);
  const Pose X{rotation(Vec3(0.1, 0.2, 0.3)), Vec3(1, 2, 3)};
  CHECK(!offered.declined(X, 1));
  const Displacement d{{0.01, 0, 0}, {0, 0, 0.1}}, hair{{3e-7, 0, 0}, Vec3::Zero()};
  offered.add(X, d, 1);
  CHECK(!offered.declined(X, 1));  // in the tick it is asked about again
  CHECK(offered.declined(X, 2));
  CHECK(offered.declined({X.q, X.p + Vec3(0, 0, 0.5e-6)}, 3));
  CHECK(!offered.declined({X.q, X.p + Vec3(0, 0, 1.5e-6)}, 3));
  // To the end of a way, which ends here: the next way begins there.
  const Pose Z{X.q, X.p + Vec3(0, 0, 1)}, end = displaced(Z, Vec3(0.01, 0, 0), hair);
  offered.add(Z, hair, 4);
  CHECK(offered.declined(Z, 5));
  CHECK(!offered.declined(end, 5));
  // It remembers a few.
  for (std::uint64_t tick = 5; tick < 9; ++tick) offered.add({X.q, Vec3(0, 0, static_cast<double>(tick))}, d, tick);
  CHECK(!offered.declined(X, 9));
}

TEST_CASE("who asks about some of the parts is answered about the motion that was asked for") {
  const MeshPtr sheet = wave(0.1, 0.01, 0.05, 60), die = wave(0.1, 0.01, 0.05, 83);
  PatchMotionCheck check(sheet, Vec3::Zero(), 0.075, {die}, {Pose{}}, {});
  std::vector<FacePair> blocking;
  blocking.reserve(64);
  int unknown = 0, instead = 0;
  for (int i = 0; i < 40; ++i) {
    check.begin({0}, monotonic_ns(), OtherParts::ignored);
    blocking.clear();
    unknown += check.check(Pose{Quat::Identity(), Vec3(0, 0, 2e-4)}, {{0, 0, -1e-4}, {}}, kClearance, blocking) ==
               MotionAnswer::unknown;
    instead += check.instead().has_value();
  }
  CHECK(unknown == 40);
  CHECK(instead == 0);
}

TEST_CASE("with little time a tick, a fine sheet comes down on its die by motions that are looked at as a whole") {
  const MeshPtr sheet = wave(0.1, 0.01, 0.05, 60), die = wave(0.1, 0.01, 0.05, 83);
  const Oracle oracle(sheet, die);
  PatchMotionCheck check(sheet, Vec3::Zero(), 0.075, {die}, {Pose{}}, {});
  std::vector<FacePair> blocking;
  blocking.reserve(64);
  Pose X{Quat::Identity(), Vec3(0, 0, 0.02)}, Y = X;
  const Displacement pen{{0, 0, -1e-4}, {0, 0, 0}};
  const std::vector<std::uint32_t> near = {0};
  int instead = 0, met = 0, hits = 0;
  for (int tick = 0; tick < 3000 && met == 0; ++tick) {
    if (tick < 250) Y.p += pen.dp;
    const Displacement d = displacement(X, Y, Vec3::Zero());
    const AllocGuard guard;
    const std::int64_t deadline_ns = monotonic_ns() + 100000;
    check.begin(near, deadline_ns, OtherParts::far);
    check.trust_start();
    check.heads({tick < 250 ? pen : Displacement{}});
    blocking.clear();
    check.check(X, d, kClearance, blocking);
    const auto other = check.instead();
    instead += other.has_value();
    const Displacement made = check.free_share() * (other ? *other : d);
    const Pose next = displaced(X, Vec3::Zero(), made);
    if (blocking.empty()) check.prepare(next, pen, deadline_ns + 50000);
    CHECK(guard.count() == 0);
    if (tick % 20 == 0 || !blocking.empty()) hits += oracle.hits(X, Vec3::Zero(), made, 5);
    X = next;
    met += !blocking.empty() && oracle.distance(X) < 1e-4;
  }
  CHECK(hits == 0);
  CHECK(instead > 0);
  CHECK(met == 1);
}

TEST_CASE("what is met ends a motion farther off where that is wanted, and is told before the look is done") {
  // Closed forms: a box over another one.
  const MeshPtr cube = box({0.01, 0.01, 0.01}), plate = box({0.05, 0.05, 0.01});
  SurfaceSweep sweep = sweep_past(cube, plate, Vec3::Zero());
  constexpr double kWay = 2e-3;
  const auto left = [&](double gap, double near_within) {
    SweepAim aim{kClearance};
    aim.kept_far = 100e-6;
    aim.far = 200e-6;
    aim.near_within = near_within;
    sweep.begin({Quat::Identity(), {0.003, 0.002, 0.02 + gap}}, {{0, 0, -kWay}, Vec3::Zero()}, {0}, {false}, aim);
    sweep.go_on(kNoDeadline);
    return gap - sweep.share() * kWay;
  };
  CHECK(left(1e-3, 1.1e-3) == Approx(100e-6).margin(1e-6));
  CHECK(sweep.met_near());
  REQUIRE_FALSE(sweep.blocking().empty());
  CHECK(left(1e-3, 0.5e-3) == Approx(100e-6).margin(1e-6));
  CHECK_FALSE(sweep.met_near());
  CHECK(left(210e-6, 0) == Approx(100e-6).margin(1e-6));
  // Nearer than that it is gone on to contact.
  CHECK(left(190e-6, 0) == Approx(SweepAim{kClearance}.kept).margin(2e-6));
}
