// Fast motions past thin things, and starts at tiny gaps.
#include "catch.hpp"
#include "narrowphase/patch_front.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

MeshPtr one_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {a, b, c};
  mesh->triangles = {{0, 1, 2}};
  return mesh;
}

struct Fixture {
  std::shared_ptr<PatchTree> a, b;
  Vec3 center;
  PatchFront front;

  Fixture(const MeshPtr& ma, const MeshPtr& mb, const Vec3& c = Vec3::Zero())
      : a(std::make_shared<PatchTree>(ma)), b(std::make_shared<PatchTree>(mb)), center(c) {
    front.attach(*a, center, *b);
  }
  CertifyStatus operator()(const Pose& X, const Displacement& d) { return front.certify(X, d).status; }
};

}  // namespace

TEST_CASE("nothing tunnels through a 0.1 mm sheet at 2 m/s", "[patch]") {
  const MeshPtr sheet = box({0.05, 0.05, 5e-5});
  for (const MeshPtr& tool : {box({0.02, 0.02, 5e-5}), peg(0.0005, 0.03, 200), peg(0.005, 0.03, 400)}) {
    Fixture f(tool, sheet);
    std::mt19937 rng(3);
    for (int i = 0; i < 50; ++i) {
      // Starts within 1 mm above the sheet, whole within 35 mm of it; 2 mm down in one tick, turning by up to 20 mrad.
      const Pose X{Quat::Identity(),
                   Vec3(uniform(rng, -0.02, 0.02), uniform(rng, -0.02, 0.02), uniform(rng, 2e-4, 1e-3))};
      const Displacement d{Vec3(uniform(rng, -1e-4, 1e-4), uniform(rng, -1e-4, 1e-4), -2e-3),
                           random_in_ball(rng, 0.02)};
      REQUIRE(f(X, d) == CertifyStatus::blocked);
      // Along the sheet there is room.
      REQUIRE(f(X, {Vec3(2e-3, 0, 0), Vec3::Zero()}) == CertifyStatus::certified);
    }
  }
}

TEST_CASE("a rod that spins between two pins is stopped", "[patch]") {
  auto pins = std::make_shared<TriangleMesh>();
  for (double x : {-0.01, 0.01}) {
    const MeshPtr pin = peg(0.001, 0.02, 100);
    const auto first = static_cast<std::uint32_t>(pins->vertices.size());
    for (const Vec3& v : pin->vertices) pins->vertices.push_back(v + Vec3(x, 0, -0.01));
    for (const auto& t : pin->triangles) pins->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const MeshPtr rod = box({0.0005, 0.02, 0.0005});
  Fixture f(rod, pins);
  const Oracle oracle(rod, pins);
  // A quarter turn away from the pins to a quarter turn past them: both ends free, the path is not.
  const Pose X{Quat::Identity(), Vec3::Zero()};
  const Displacement half_turn{Vec3::Zero(), Vec3(0, 0, 3.1)};
  REQUIRE(!oracle.meet(X));
  REQUIRE(!oracle.meet(displaced(X, Vec3::Zero(), half_turn)));
  REQUIRE(f(X, half_turn) != CertifyStatus::certified);
  // Tick by tick at 20 rad/s it comes close, and only close.
  Pose Y = X;
  const Displacement tick{Vec3::Zero(), Vec3(0, 0, 0.02)};
  int made = 0;
  while (made < 200 && f(Y, tick) == CertifyStatus::certified) Y = displaced(Y, Vec3::Zero(), tick), ++made;
  // The rod's side (half width 0.5 mm) meets a pin (radius 1 mm, 10 mm out) at asin(1.5 / 10) before a quarter turn.
  const double angle = 0.02 * made, contact = kPi / 2 - std::asin(0.15);
  REQUIRE(angle < contact);
  REQUIRE(angle > contact - 0.025);
}

TEST_CASE("tiny gaps at the start still allow motion away, along and none towards", "[patch]") {
  for (double gap : {1e-6, 1e-8, 1e-10}) {
    CAPTURE(gap);
    const Vec3 a(0, 0, gap), n = Vec3::UnitZ();
    const MeshPtr up = one_triangle(a, a + Vec3(0.01, 0.002, 0.01), a + Vec3(-0.01, 0.003, 0.01));
    const MeshPtr down = one_triangle(Vec3(0, 0, 0), Vec3(0.01, -0.003, -0.01), Vec3(-0.01, -0.001, -0.01));
    const MeshPtr floor = one_triangle(Vec3(-0.02, -0.02, 0), Vec3(0.03, -0.02, 0), Vec3(0, 0.03, 0));
    const MeshPtr flat = one_triangle(a + Vec3(-0.01, 0, 0), a + Vec3(0.01, 0, 0), a + Vec3(0, 0.01, 0));
    const MeshPtr edge = one_triangle(a + Vec3(-0.01, 0.001, 0), a + Vec3(0.01, 0, 0), a + Vec3(0, 0, 0.01));
    const MeshPtr across = one_triangle(Vec3(0.001, -0.01, 0), Vec3(0, 0.01, 0), Vec3(0, 0, -0.01));
    struct Case {
      MeshPtr a, b;
    };
    for (const Case& c : {Case{up, down}, Case{up, floor}, Case{flat, floor}, Case{edge, across}}) {
      Fixture f(c.a, c.b);
      REQUIRE(f({}, {}) == CertifyStatus::certified);
      REQUIRE(f({}, {1e-3 * n, Vec3::Zero()}) == CertifyStatus::certified);
      REQUIRE(f({}, {2e-9 * n, Vec3::Zero()}) == CertifyStatus::certified);
      REQUIRE(f({}, {-2 * gap * n, Vec3::Zero()}) == CertifyStatus::blocked);
      REQUIRE(f({}, {-0.5 * gap * n, Vec3::Zero()}) == CertifyStatus::certified);
    }
    // Sliding along the floor.
    Fixture slide(flat, floor);
    REQUIRE(slide({}, {Vec3(2e-3, 1e-3, 0), Vec3::Zero()}) == CertifyStatus::certified);
    REQUIRE(slide({}, {Vec3(0, 0, 0), Vec3(0, 0, 0.02)}) == CertifyStatus::certified);
  }
}

TEST_CASE("triangles of one plane pass beside each other and not through", "[patch]") {
  const MeshPtr left = one_triangle(Vec3(-0.02, -0.01, 0), Vec3(-1e-6, 0, 0), Vec3(-0.02, 0.01, 0));
  const MeshPtr right = one_triangle(Vec3(0, -0.01, 0), Vec3(0.02, 0, 0), Vec3(0, 0.01, 0));
  Fixture f(left, right);
  REQUIRE(f({}, {Vec3(0, 0.002, 0), Vec3::Zero()}) == CertifyStatus::certified);
  REQUIRE(f({}, {Vec3(0.001, 0, 0), Vec3::Zero()}) == CertifyStatus::blocked);
}

TEST_CASE("the path with a linear file-frame origin is covered too", "[patch]") {
  // A point a meter from its center of mass turns about the far center: the two paths differ by |center| θ² / 8.
  const double c = 1.0, theta = 0.2, sag = c * theta * theta / 8;
  const MeshPtr point = box({1e-4, 1e-4, 1e-4});
  const Vec3 center(c, 0, 0);
  // Linear center: the origin swings on an arc; linear origin: it goes straight along the chord. A wall between.
  const Displacement d{Vec3::Zero(), Vec3(0, 0, theta)};
  const Pose end = displaced({}, center, d);
  const Vec3 chord = 0.5 * end.p, arc = displaced({}, center, 0.5 * d).p;
  REQUIRE((arc - chord).norm() == Approx(sag).epsilon(0.01));
  for (const Vec3& spot : {chord, arc}) {
    auto wall = std::make_shared<TriangleMesh>(*box({5e-4, 5e-4, 5e-4}));
    for (Vec3& v : wall->vertices) v += spot;
    Fixture f(point, wall, center);
    REQUIRE(f({}, {}) == CertifyStatus::certified);
    REQUIRE(f({}, d) != CertifyStatus::certified);
  }
}

TEST_CASE("what is prepared ahead lets nothing through", "[patch]") {
  const double gap = 5e-4, size = 0.1;
  const MeshPtr sheet = wave(size, 0.002, 0.05, 80);
  const Pose X{Quat::Identity(), Vec3(0, 0, gap)};
  const Oracle oracle(sheet, sheet);
  std::vector<FacePair> blocking;
  blocking.reserve(64);
  PatchMotionCheck check(sheet, Vec3::Zero(), size, {sheet}, {Pose{}}, {});
  check.begin({0}, kNoDeadline, OtherParts::far);
  check.prepare(X, {Vec3(0, 0, -1e-4), Vec3::Zero()}, kNoDeadline);
  for (const Displacement& d :
       {Displacement{Vec3(0, 0, -5e-5), Vec3::Zero()}, Displacement{Vec3(2e-5, -2e-5, -2e-5), Vec3(1e-4, 0, 1e-4)}}) {
    REQUIRE(oracle.hits(X, Vec3::Zero(), d, 8) == 0);
    blocking.clear();
    CHECK(check.check(X, d, 1.1e-6, blocking) == MotionAnswer::free);
  }
  const Displacement down{Vec3(0, 0, -2 * gap), Vec3::Zero()};
  REQUIRE(oracle.hits(X, Vec3::Zero(), down, 8) > 0);
  blocking.clear();
  CHECK(check.check(X, down, 1.1e-6, blocking) != MotionAnswer::free);
  CHECK(oracle.hits(X, Vec3::Zero(), check.free_share() * down, 32) == 0);
}
