// The certificate against sampled poses: never certified where triangles meet, certified where there is room.
#include "alloc_guard.hpp"
#include "catch.hpp"
#include "narrowphase/patch_front.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

void require_cover(const PatchFront& front, const PatchTree& a, const PatchTree& b) {
  REQUIRE(covers_once(a, b, [&](auto f) { front.for_each_pair(f); }));
}

}  // namespace

TEST_CASE("a certified motion has no intersecting pose", "[patch]") {
  for (const Scene& scene : scenes()) {
    CAPTURE(scene.name);
    const PatchTree a(scene.a), b(scene.b);
    const Oracle oracle(scene.a, scene.b);
    PatchFront front;
    front.attach(a, scene.center, b);
    std::mt19937 rng(17);
    Pose X = scene.start;
    REQUIRE(front.certify(X, {}).status == CertifyStatus::certified);
    int certified = 0, blocked = 0;
    for (int i = 0; i < 100; ++i) {
      const double size = std::pow(10.0, uniform(rng, -3, 0));
      Displacement d{random_in_ball(rng, size * scene.move), random_in_ball(rng, size * scene.turn)};
      d.dp -= 0.5 * size * scene.move * (X * a.origin()).normalized();  // back to B

      const CertifyReport report = front.certify(X, d);
      if (report.status == CertifyStatus::certified) {
        ++certified;
        REQUIRE(oracle.hits(X, scene.center, d, i % 4 == 0 ? 32 : 8) == 0);
        X = displaced(X, scene.center, d);
      } else {
        ++blocked;
      }
      if (i % 30 == 0) require_cover(front, a, b);
    }
    require_cover(front, a, b);
    INFO(certified << " certified, " << blocked << " not");
    CHECK(certified >= 30);
    CHECK(blocked >= 2);  // 4 with clang, which draws the numbers of a motion in another order
  }
}

TEST_CASE("a motion with room around it is certified", "[patch]") {
  // Four halvings of the time leave sixteen pieces, and what is farther apart than a piece can carry it has a plane
  // that stands still: an eighth of the motion is twice that.
  for (const Scene& scene : scenes()) {
    CAPTURE(scene.name);
    const PatchTree a(scene.a), b(scene.b);
    const Oracle oracle(scene.a, scene.b);
    double reach = 0;
    for (const Vec3& v : scene.a->vertices) reach = std::max(reach, (v - scene.center).norm());
    PatchFront front;
    front.attach(a, scene.center, b);
    std::mt19937 rng(23);
    const double room = oracle.distance(scene.start);
    int asked = 0;
    for (int i = 0; i < 40; ++i) {
      const double size = 4 * room * std::pow(10.0, uniform(rng, -2, 0));
      const Displacement d{random_in_ball(rng, size), random_in_ball(rng, size / reach)};
      const double motion = d.dp.norm() + (reach + scene.center.norm()) * d.dr.norm();
      if (oracle.path_distance(scene.start, scene.center, d, 16) < motion / 8) continue;
      ++asked;
      const CertifyReport report = front.certify(scene.start, d, {1000000});
      REQUIRE(report.status == CertifyStatus::certified);
    }
    CHECK(asked >= 10);
  }
}

TEST_CASE("blocking pairs stand in the way", "[patch]") {
  const Scene scene = scenes()[3];
  const PatchTree a(scene.a), b(scene.b);
  PatchFront front;
  front.attach(a, scene.center, b);
  // 9 mm above the plate, 20 mm down.
  const Displacement d{Vec3(0, 0, -0.02), Vec3::Zero()};
  const CertifyReport report = front.certify(scene.start, d);
  REQUIRE(report.status == CertifyStatus::blocked);
  REQUIRE(!front.blocking().empty());
  for (const BlockingPair& p : front.blocking()) {
    // Seen along the motion the triangles overlap, and the one of A goes from above the other to below its top.
    Vec3 low_a = Vec3::Constant(1), high_a = -low_a, low_b = low_a, high_b = -low_a;
    for (int k = 0; k < 3; ++k) {
      const Vec3 va = scene.start * a.corner(p.face_a, k), vb = b.corner(p.face_b, k);
      low_a = low_a.cwiseMin(va);
      high_a = high_a.cwiseMax(va);
      low_b = low_b.cwiseMin(vb);
      high_b = high_b.cwiseMax(vb);
    }
    for (int i = 0; i < 2; ++i) REQUIRE((low_a[i] <= high_b[i] && low_b[i] <= high_a[i]));
    REQUIRE(low_a.z() > high_b.z());
    REQUIRE(low_a.z() + d.dp.z() <= high_b.z());
  }
}

TEST_CASE("calls cut short leave a front that covers everything", "[patch]") {
  std::mt19937 rng(31);
  for (const Scene& scene : scenes()) {
    CAPTURE(scene.name);
    const PatchTree a(scene.a), b(scene.b);
    const Oracle oracle(scene.a, scene.b);
    PatchFront front(FrontCapacity{3000, 8});
    front.attach(a, scene.center, b);
    int certified = 0;
    for (int i = 0; i < 120; ++i) {
      const double size = std::pow(10.0, uniform(rng, -4, 0));
      const Displacement d{random_in_ball(rng, size * scene.move), random_in_ball(rng, size * scene.turn)};
      const CertifyReport report = front.certify(scene.start, d, {static_cast<int>(uniform(rng, 1, 400))});
      if (report.status != CertifyStatus::certified) continue;
      ++certified;
      if (certified % 8 == 0) REQUIRE(oracle.hits(scene.start, scene.center, d, 16) == 0);
    }
    REQUIRE(certified > 10);
    require_cover(front, a, b);
  }
}

TEST_CASE("a certificate allocates nothing", "[patch]") {
  const Scene scene = scenes()[1];
  const PatchTree a(scene.a), b(scene.b);
  PatchFront front;
  std::mt19937 rng(41);
  const AllocGuard guard;
  front.attach(a, scene.center, b);
  for (int i = 0; i < 300; ++i) {
    const double size = std::pow(10.0, uniform(rng, -4, 0.5));
    front.certify(scene.start, {random_in_ball(rng, size * scene.move), random_in_ball(rng, size * scene.turn)});
  }
  const auto allocations = guard.count();
  REQUIRE(allocations == 0);
}

TEST_CASE("the same calls give the same answers and the same front", "[patch]") {
  const Scene scene = scenes()[0];
  const PatchTree a(scene.a), b(scene.b);
  auto run = [&] {
    PatchFront front;
    front.attach(a, scene.center, b);
    std::mt19937 rng(43);
    std::vector<int> log;
    for (int i = 0; i < 100; ++i) {
      const CertifyReport r =
          front.certify(scene.start, {random_in_ball(rng, scene.move), random_in_ball(rng, scene.turn)});
      log.insert(log.end(), {static_cast<int>(r.status), r.pairs, r.searches, r.splits, r.merges});
    }
    return log;
  };
  REQUIRE(run() == run());
}
