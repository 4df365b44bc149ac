// Sheets that are drawn out behind them: what is inside against closed forms, and lifts against FCL.
#include "catch.hpp"
#include "narrowphase/backing.hpp"
#include "narrowphase/surface_sweep.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"
#include "tegotae/core/clock.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kKeptGap = 1.1e-6;
using Side = Backing::Side;

std::shared_ptr<const PatchTree> hierarchy_of(const MeshPtr& mesh) {
  return std::make_shared<const PatchTree>(mesh);
}

/// Faces that look either way.
MeshPtr with_turned_faces(const MeshPtr& mesh, std::mt19937& rng) {
  auto out = std::make_shared<TriangleMesh>(*mesh);
  for (auto& t : out->triangles)
    if (rng() % 2 == 0) std::swap(t[0], t[1]);
  return out;
}

MeshPtr both(const MeshPtr& a, const MeshPtr& b, const Vec3& at) {
  auto out = std::make_shared<TriangleMesh>(*a);
  const auto first = static_cast<std::uint32_t>(a->vertices.size());
  for (const Vec3& v : b->vertices) out->vertices.push_back(v + at);
  for (const auto& t : b->triangles) out->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return out;
}

}  // namespace

TEST_CASE("what a sheet is drawn out to is inside, on its side and as deep") {
  std::mt19937 rng(51);
  const double side = 0.1;
  const auto tree = hierarchy_of(with_turned_faces(wave(side, 0, 0.04, 20), rng));
  const auto backing = Backing::of(tree, nullptr);
  REQUIRE(backing);
  const double depth = backing->drawn(Side::plus).norm();
  CHECK(depth > 0.01 * side);
  CHECK(backing->drawn(Side::plus).cross(Vec3::UnitZ()).norm() < 1e-9 * depth);
  int inside = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = random_in_ball(rng, 0.08);
    const bool under = std::abs(p.x()) < side / 2 && std::abs(p.y()) < side / 2;
    for (const Side s : {Side::plus, Side::minus}) {
      const double z = p.z() * (backing->drawn(s).z() > 0 ? 1 : -1);
      const bool expected = under && z > 0 && z < depth;
      CHECK(backing->outside(p, s) != expected);
      inside += expected;
    }
  }
  CHECK(inside > 100);
}

TEST_CASE("of curved sheets however they lie, what each face is drawn out to is inside") {
  std::mt19937 rng(53);
  int inside = 0, outside = 0;
  for (int n = 0; n < 12; ++n) {
    // Somewhere in space, some with a second one of small faces.
    auto sheet = std::make_shared<TriangleMesh>(*with_turned_faces(wave(0.1, 0.008, 0.05, n % 3 == 0 ? 24 : 40), rng));
    if (n % 2 == 0) sheet = std::make_shared<TriangleMesh>(*both(sheet, wave(0.01, 0, 1, 12), Vec3(0.1, 0.02, 0.01)));
    const Pose at{rotation(random_in_ball(rng, 3)), random_in_ball(rng, 1)};
    for (Vec3& v : sheet->vertices) v = at * v;
    const auto backing = Backing::of(hierarchy_of(sheet), nullptr);
    REQUIRE(backing);
    const Vec3 up = at.q * Vec3::UnitZ();
    REQUIRE(backing->drawn(Side::plus).cross(up).norm() < 0.05 * backing->drawn(Side::plus).norm());
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = at * Vec3(uniform(rng, -0.06, 0.12), uniform(rng, -0.06, 0.06), uniform(rng, -0.02, 0.02));
      for (const Side side : {Side::plus, Side::minus}) {
        const Vec3 back = -backing->drawn(side);
        bool expected = false, unsure = false;
        for (const auto& t : sheet->triangles) {
          // p + s back = a + u (b - a) + v (c - a)
          const Vec3 &a = sheet->vertices[t[0]], &b = sheet->vertices[t[1]], &c = sheet->vertices[t[2]];
          Mat3 system;
          system << b - a, c - a, -back;
          if (std::abs((b - a).cross(c - a).normalized().dot(back.normalized())) < 0.11) continue;
          const Vec3 x = system.inverse() * (p - a);
          const double least = std::min({x[0], x[1], 1 - x[0] - x[1], x[2], 1 - x[2]});
          expected = expected || least > 0;
          unsure = unsure || std::abs(least) < 1e-4;
        }
        if (unsure) continue;
        CHECK(backing->outside(p, side) == !expected);
        (expected ? inside : outside) += 1;
      }
    }
  }
  CHECK(inside > 2000);
  CHECK(outside > 5000);
}

TEST_CASE("of a fan of needles, the one that a line passes is listed") {
  auto fan = std::make_shared<TriangleMesh>();
  constexpr std::uint32_t kNeedles = 20000;
  fan->vertices.push_back(Vec3::Zero());
  for (std::uint32_t i = 0; i < kNeedles; ++i) {
    const double angle = 2 * kPi * i / kNeedles;
    fan->vertices.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0);
    fan->triangles.push_back({0, 1 + i, 1 + (i + 1) % kNeedles});
  }
  const auto tree = hierarchy_of(fan);
  std::vector<std::uint32_t> faces(kNeedles);
  for (std::uint32_t i = 0; i < kNeedles; ++i) faces[i] = i;
  const FaceColumns columns(*tree, Vec3::UnitZ(), faces);
  std::mt19937 rng(54);
  for (int n = 0; n < 1000; ++n) {
    const double angle = uniform(rng, 0, 2 * kPi), r = uniform(rng, 0.001, 0.0999);
    const auto needle = static_cast<std::uint32_t>(angle / (2 * kPi) * kNeedles);
    const auto listed = columns.beside(Vec3(r * std::cos(angle), r * std::sin(angle), 0.01) - tree->origin());
    CHECK(std::count_if(listed.begin(), listed.end(), [&](const auto& f) { return f.face == needle; }) == 1);
  }
  const auto beside = columns.beside(Vec3(0.11, 0, 0) - tree->origin());
  CHECK(beside.begin() == beside.end());
}

TEST_CASE("only what looks along one axis is drawn out, and no thick solid") {
  const auto backing_of = [](const MeshPtr& mesh) {
    const auto tree = hierarchy_of(mesh);
    const auto facing = Facing::of(mesh, tree);
    return Backing::of(tree, facing.get());
  };
  CHECK(backing_of(wave(0.1, 0.01, 0.05, 40)));
  CHECK(!backing_of(box({0.1, 0.08, 0.03})));
  CHECK(!backing_of(knot(0.05, 0.006, 900)));
}

TEST_CASE("motions of a sheet that is drawn out are free where they are said to be") {
  std::mt19937 rng(52);
  const MeshPtr die = wave(0.12, 0.01, 0.05, 57), post = box({0.01, 0.01, 0.004});
  const MeshPtr others[] = {die, both(die, wave(0.03, 0, 0.04, 6), Vec3(0.01, 0, 0.03)),
                            both(die, post, Vec3(0.02, 0.01, 0.028)), both(die, post, Vec3(0.05, 0, 0.022))};
  int whole = 0, cut = 0, drawn_out = 0, free_lifts = 0;
  for (int n = 0; n < 4; ++n) {
    const MeshPtr sheet = with_turned_faces(wave(0.1, 0.01, 0.05, 40), rng);
    const auto tree = hierarchy_of(sheet);
    const auto backing = Backing::of(tree, nullptr);
    REQUIRE(backing);
    for (const MeshPtr& other : others) {
      const Oracle oracle(sheet, other);
      const auto points = Facing::points_of(other);
      SurfaceSweep sweep(tree, Vec3::Zero(), {{hierarchy_of(other), Pose{}}}, nullptr, backing, 24);
      for (int k = 0; k < 60; ++k) {
        const Pose X{rotation(random_in_ball(rng, 0.02)), random_in_ball(rng, 0.002) + Vec3(0, 0, 0.003)};
        if (oracle.meet(X) || oracle.distance(X) < 2 * kKeptGap) continue;
        const bool lift = k % 2 == 0;
        const Displacement d{
            lift ? Vec3(0.2 * random_in_ball(rng, 0.01) + Vec3(0, 0, 0.01)) : random_in_ball(rng, 0.01),
            k % 3 == 0 ? random_in_ball(rng, 0.02) : Vec3::Zero()};
        const bool plus = backing->drawn(Side::plus).dot(X.q.conjugate() * d.dp) > 0;
        const Side side = plus ? Side::plus : Side::minus;
        SweepAim aim;
        aim.clearance = kKeptGap;
        if (std::all_of(points.begin(), points.end(),
                        [&](const Vec3& p) { return backing->outside(X.inverse() * p, side); }))
          aim.drawn = side;
        sweep.begin(X, d, {0}, {false}, aim);
        sweep.go_on(kNoDeadline);
        const double share = sweep.share();
        CHECK(oracle.hits(X, Vec3::Zero(), share * d, 20) == 0);
        drawn_out += aim.drawn.has_value();
        free_lifts += lift && share == 1;
        (share == 1 ? whole : cut) += 1;
        // What is met is of the sheet, not of what was drawn.
        for (const FacePair& met : sweep.blocking()) CHECK(met.a < sheet->triangles.size());
      }
    }
  }
  CHECK(drawn_out > 100);
  CHECK(free_lifts > 50);
  CHECK(whole > 50);
  CHECK(cut > 50);
}
