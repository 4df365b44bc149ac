// The certificate by free cells against sampled poses, on the scenes of the pair front and on surfaces that lie on each
// other.
#include "alloc_guard.hpp"
#include "catch.hpp"
#include "narrowphase/cell_front.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"
#include "triangle_distance.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

CellFront cells_of(const Scene& scene, std::uint32_t capacity = 1u << 15) {
  return CellFront(std::make_shared<PatchTree>(scene.a), scene.center, {{std::make_shared<PatchTree>(scene.b), Pose{}}},
                   capacity, 32);
}

std::vector<Scene> all_scenes() {
  std::vector<Scene> out = scenes();
  out.push_back({"sheet on its die", wave(0.1, 0.002, 0.05, 20), wave(0.1, 0.002, 0.05, 20), Vec3::Zero(),
                 Pose{Quat::Identity(), Vec3(0, 0, 2e-4)}, 3e-4, 0.004});
  return out;
}

/// Rows of blocks whose tops are at z = 0, around the origin.
struct Blocks {
  MeshPtr mesh;
  double edge;  ///< of the last ones, m

  Blocks(int columns, int rows, double pitch) : edge(0.5 * pitch * (columns - 1) + 0.003) {
    auto out = std::make_shared<TriangleMesh>();
    out->name = "blocks";
    const MeshPtr block = box({0.003, 0.003, 0.005});
    for (int i = 0; i < columns * rows; ++i) {
      const Vec3 at(pitch * (i % columns - 0.5 * (columns - 1)), pitch * (i / columns - 0.5 * (rows - 1)), -0.005);
      const auto first = static_cast<std::uint32_t>(out->vertices.size());
      for (const Vec3& v : block->vertices) out->vertices.push_back(at + v);
      for (const auto& t : block->triangles) out->triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    mesh = out;
  }
};

void require_cover(const CellFront& front, const PatchTree& a, const PatchTree& b) {
  REQUIRE(covers_once(a, b, [&](auto f) {
    front.for_each_cell(
        [&](std::uint32_t, std::uint32_t i, bool face_i, std::uint32_t j, bool face_j) { f(i, face_i, j, face_j); });
  }));
}

/// Looks ahead along the motion, now and then: by other cells for the next call, or by proving a longer motion.
void look_ahead(CellFront& front, const Pose& X, const Displacement& d, std::mt19937& rng) {
  const double times = std::pow(10.0, uniform(rng, 0, 2.5));
  const int way = static_cast<int>(uniform(rng, 0, 4));
  if (way == 0) front.prove_ahead(X, times * d, {static_cast<int>(uniform(rng, 0, 3000))});
  front.foresee(way < 2 ? times * d : Displacement{});
}

}  // namespace

TEST_CASE("a motion certified by cells has no intersecting pose, nor has the share of one that is not", "[patch]") {
  for (const Scene& scene : all_scenes()) {
    CAPTURE(scene.name);
    const PatchTree a(scene.a), b(scene.b);
    const Oracle oracle(scene.a, scene.b);
    CellFront front = cells_of(scene);
    front.set_near({0});
    std::mt19937 rng(17), ahead(18);
    Pose X = scene.start;
    REQUIRE(front.certify(X, {}).status == CertifyStatus::certified);
    int certified = 0, partly = 0;
    for (int i = 0; i < 150; ++i) {
      const double size = std::pow(10.0, uniform(rng, -3, 0));
      Displacement d{random_in_ball(rng, size * scene.move), random_in_ball(rng, size * scene.turn)};
      d.dp -= 0.5 * size * scene.move * (X * a.origin()).normalized();  // back to B
      WorkLimit limit;
      if (i % 3 == 0) limit.searches = static_cast<int>(uniform(rng, 0, 60));
      look_ahead(front, X, d, ahead);
      const CertifyReport report = front.certify(X, d, limit);
      const double share = 0.999999 * report.share;
      if (report.status == CertifyStatus::certified) {
        REQUIRE(report.share == 1);
        ++certified;
      } else if (share > 0) {
        ++partly;
      }
      if (share > 0) REQUIRE(oracle.hits(X, scene.center, share * d, i % 4 == 0 ? 32 : 8) == 0);
      X = displaced(X, scene.center, share * d);
      if (i % 30 == 0) require_cover(front, a, b);
    }
    require_cover(front, a, b);
    INFO(certified << " certified, " << partly << " in part");
    CHECK(certified >= 30);
    CHECK(partly >= 2);
  }
}

TEST_CASE("what lies on a seat meets it from one side, what is in a hole from all", "[patch]") {
  // A cube 10 um from walls along some of the six directions. Where they are planes with the normals of the walls, as
  // many along each, the length of the mean is known.
  const double half = 0.01, gap = 1e-5, wall = 0.002;
  const auto among = [&](const std::vector<Vec3>& walls) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->name = "walls";
    for (const Vec3& to : walls) {
      const Vec3 size = Vec3::Constant(half) + (wall - half) * to.cwiseAbs();
      const MeshPtr slab = box(size);
      const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
      for (const Vec3& v : slab->vertices) mesh->vertices.push_back(v + (half + gap + wall) * to);
      for (const auto& t : slab->triangles) mesh->triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    CellFront front = cells_of({"cube among walls", box(Vec3::Constant(half)), mesh, Vec3::Zero(), Pose{}, 0, 0});
    CHECK(front.one_sidedness(0) == 0);
    front.set_near({0});
    REQUIRE(front.certify(Pose{}, {Vec3(0.5 * gap, 0, 0), Vec3::Zero()}).status == CertifyStatus::certified);
    return front.one_sidedness(0);
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  CHECK(among({-z}) > 0.99);
  CHECK(among({-z, x}) == Approx(std::sqrt(0.5)).margin(0.1));
  CHECK(among({-z, x, -x, y, -y, z}) < 0.1);
  CHECK(among({x, -x, y, -y}) < 0.1);
}

TEST_CASE("a motion with room around it is certified by cells", "[patch]") {
  for (const Scene& scene : all_scenes()) {
    CAPTURE(scene.name);
    const Oracle oracle(scene.a, scene.b);
    double reach = 0;
    for (const Vec3& v : scene.a->vertices) reach = std::max(reach, (v - scene.center).norm());
    CellFront front = cells_of(scene);
    front.set_near({0});
    std::mt19937 rng(23);
    const double room = oracle.distance(scene.start);
    int asked = 0;
    for (int i = 0; i < 40; ++i) {
      const double size = 4 * room * std::pow(10.0, uniform(rng, -2, 0));
      const Displacement d{random_in_ball(rng, size), random_in_ball(rng, size / reach)};
      const double motion = d.dp.norm() + (reach + scene.center.norm()) * d.dr.norm();
      if (oracle.path_distance(scene.start, scene.center, d, 16) < motion / 8) continue;
      ++asked;
      REQUIRE(front.certify(scene.start, d, {1000000}).status == CertifyStatus::certified);
    }
    CHECK(asked >= 10);
  }
}

TEST_CASE("a certified motion keeps the clearance", "[patch]") {
  const Scene scene = all_scenes().back();
  const Oracle oracle(scene.a, scene.b);
  CellFront front = cells_of(scene);
  constexpr double kClearance = 2e-5;
  front.set_near({0});
  front.set_clearance(kClearance);
  std::mt19937 rng(29);
  Pose X = scene.start;
  int near_misses = 0;
  for (int i = 0; i < 200; ++i) {
    const double size = std::pow(10.0, uniform(rng, -2, 0));
    Displacement d{random_in_ball(rng, size * scene.move), random_in_ball(rng, size * scene.turn)};
    d.dp.z() -= 0.5 * size * scene.move;
    const CertifyReport report = front.certify(X, d);
    const Displacement made = 0.999999 * report.share * d;
    const double least = oracle.path_distance(X, scene.center, made, 8);
    REQUIRE(least >= kClearance * (1 - 1e-6));
    near_misses += least < 2 * kClearance;
    X = displaced(X, scene.center, made);
  }
  CHECK(near_misses > 50);
}

TEST_CASE("a sheet comes down on its die whatever the work that a call may do", "[patch]") {
  // The argument of docs/decisions: as long as there is room, calls that run out of work get on.
  const Scene scene = all_scenes().back();
  for (const int searches : {20, 200, 1 << 20}) {
    CAPTURE(searches);
    CellFront front = cells_of(scene);
    front.set_near({0});
    front.set_clearance(1.1e-6);
    Pose X = scene.start;
    int calls = 0;
    for (; X.p.z() > 5e-6 && calls < 4000; ++calls) {
      const Displacement d{Vec3(0, 0, 3e-6 - X.p.z()), Vec3::Zero()};
      const CertifyReport report = front.certify(X, d, {searches});
      X = displaced(X, scene.center, 0.999 * report.share * d);
    }
    INFO("after " << calls << " calls at " << X.p.z());
    CHECK(X.p.z() <= 5e-6);
    CHECK(front.cells() < 4 * static_cast<int>(scene.a->triangles.size()));
  }
}

TEST_CASE("small motions in contact are free: pressed, slid, turned and lifted again and again", "[patch]") {
  // What cells keep from call to call (planes that lose what comes against them, lists, larger pieces) is used up here.
  const Scene scene = all_scenes().back();
  const PatchTree a(scene.a), b(scene.b);
  const Oracle oracle(scene.a, scene.b);
  constexpr double kClearance = 1e-6;
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    CellFront front = cells_of(scene);
    front.set_near({0});
    front.set_clearance(kClearance);
    std::mt19937 rng(seed), ahead(seed + 100);
    Pose X = scene.start;
    int made = 0, cut = 0;
    for (int i = 0; i < 900; ++i) {
      const int phase = (i / 60) % 4;
      const double step = std::pow(10.0, uniform(rng, -6, -4));
      Displacement d{random_in_ball(rng, 0.2 * step), random_in_ball(rng, phase == 2 ? 20 * step : step)};
      d.dp.z() += phase == 3 ? 2 * step : -step;
      if (phase == 1) d.dp.x() += (i % 2 == 0 ? 1 : -0.5) * step;
      look_ahead(front, X, d, ahead);
      const CertifyReport report = front.certify(X, d, {i % 3 == 0 ? 1 : 4000});
      const Displacement moved = 0.999999 * report.share * d;
      const bool look = i % 6 == 0;
      if (look) REQUIRE(oracle.hits(X, scene.center, moved, 4) == 0);
      X = displaced(X, scene.center, moved);
      if (look) REQUIRE(oracle.distance(X) >= kClearance * (1 - 1e-5));
      made += report.share > 0.5;
      cut += report.status == CertifyStatus::out_of_budget;
    }
    require_cover(front, a, b);
    INFO(made << " made, " << cut << " cut");
    CHECK(made > 200);
    CHECK(cut > 10);
  }
}

TEST_CASE("what is proved ahead needs no search when the part moves", "[patch]") {
  const Scene scene = all_scenes().back();
  CellFront front = cells_of(scene);
  front.set_near({0});
  Pose X = scene.start;  // 0.2 mm above its seat
  const Displacement way{Vec3(0, 0, -1.5e-4), Vec3::Zero()};
  REQUIRE(front.prove_ahead(X, way, {1 << 20}).status == CertifyStatus::certified);
  CHECK(front.met() == 1);
  for (int i = 0; i < 10; ++i) {
    const CertifyReport report = front.certify(X, 0.1 * way, {0});
    REQUIRE(report.status == CertifyStatus::certified);
    X = displaced(X, scene.center, 0.1 * way);
  }
  // What is in the way is met where it is: the sheet rests 0.2 mm below its start.
  front.prove_ahead(scene.start, {Vec3(0, 0, -4e-4), Vec3::Zero()}, {1 << 20});
  CHECK(front.met() > 0.499);
  CHECK(front.met() < 0.6);
}

TEST_CASE("a part that comes back to where it was finds cells of before", "[patch]") {
  // Down to its seat, off it by more than its height, and down again: aside and turned on the way, so that some of the
  // cells hold no more.
  const Scene scene = all_scenes().back();
  const PatchTree a(scene.a), b(scene.b);
  const Oracle oracle(scene.a, scene.b);
  constexpr double kHigh = 0.01, kSeat = 5e-6, kClearance = 1e-6;
  constexpr int kSteps = 12;
  std::mt19937 rng(37);
  CellFront front = cells_of(scene);
  front.set_near({0});
  front.set_clearance(kClearance);
  Pose X = scene.start;
  X.p.z() = kHigh;
  /// Searches on the last part of the way: there most faces need cells of their own.
  const auto go = [&](const Pose& to) {
    int searches = 0, calls = 0;
    for (int i = 0; i < kSteps; ++i) {
      searches = 0;
      const Displacement left = displacement(X, to, scene.center);
      const double part = 1.0 / (kSteps - i);
      Displacement d{part * left.dp, part * left.dr};
      for (double share = 0; share < 1 && calls < 4 * kSteps; ++calls) {
        const CertifyReport report = front.certify(X, d);
        searches += report.searches;
        share = report.status == CertifyStatus::certified ? 1 : 0.999999 * report.share;
        REQUIRE(oracle.hits(X, scene.center, share * d, 2) == 0);
        X = displaced(X, scene.center, share * d);
        d = (1 - share) * d;
      }
    }
    REQUIRE(oracle.distance(X) >= kClearance * (1 - 1e-5));
    return searches;
  };
  const Pose seat{Quat::Identity(), Vec3(0, 0, kSeat)}, up{Quat::Identity(), Vec3(0, 0, kHigh)};
  const int first = go(seat);
  CHECK(X.p.z() < 2 * kSeat);
  go(up);
  const int merged = front.cells();
  CHECK(merged < static_cast<int>(scene.a->triangles.size()) / 4);
  CHECK(go(seat) < first / 2);
  for (int i = 0; i < 20; ++i) {
    const double size = std::pow(10.0, uniform(rng, -6, -4));
    go({rotation(random_in_ball(rng, 100 * size)), Vec3(0, 0, kHigh) + random_in_ball(rng, 10 * size)});
    if (i % 5 == 4) {
      front.forget_cut();
      front.set_near({0});
    }
    go({rotation(random_in_ball(rng, size)), Vec3(0, 0, kSeat) + random_in_ball(rng, size)});
  }
  go(up);
  CHECK(go(seat) < first / 2);
  require_cover(front, a, b);
  // Elsewhere the faces have other things near.
  for (int i = 0; i < 4; ++i) {
    const Vec3 aside(uniform(rng, -0.03, 0.03), uniform(rng, -0.03, 0.03), 0);
    for (const double height : {kHigh, kSeat}) go({Quat::Identity(), aside + Vec3(0, 0, height)});
    go({Quat::Identity(), aside + Vec3(0, 0, kHigh)});
    go(up);
  }
  go(up);
  front.clear();
  front.set_near({0});
  CHECK(go(seat) > 0.9 * first);
}

TEST_CASE("what goes off its seat and runs out of work begins anew with the pieces that it needs", "[patch]") {
  const Scene scene{"sheet on its die",
                    wave(0.1, 0.002, 0.05, 72),
                    wave(0.1, 0.002, 0.05, 72),
                    Vec3::Zero(),
                    Pose{Quat::Identity(), Vec3(0, 0, 2e-4)},
                    3e-4,
                    0.004};
  const PatchTree a(scene.a), b(scene.b);
  const Oracle oracle(scene.a, scene.b);
  constexpr double kSeat = 5e-6, kClearance = 1e-6;
  CellFront front = cells_of(scene);
  front.set_near({0});
  front.set_clearance(kClearance);
  Pose X = scene.start;
  int fewer = 0;
  const auto go = [&](double z, double step, int searches) {
    const double way = z < X.p.z() ? -1 : 1;
    for (int i = 0; way * (z - X.p.z()) > 1e-6 && i < 4000; ++i) {
      const Displacement d{Vec3(0, 0, way * std::min(step, std::abs(z - X.p.z()))), Vec3::Zero()};
      const int before = front.cells();
      // On the way down pieces are taken apart for what is ahead: they are smaller than they need to be yet.
      front.foresee({Vec3(0, 0, way < 0 ? 0.99 * (z - X.p.z()) : 0), Vec3::Zero()});
      const CertifyReport report = front.certify(X, d, {searches});
      fewer += front.cells() < before / 4;
      if (i % 40 == 0) REQUIRE(oracle.hits(X, scene.center, report.share * d, 2) == 0);
      X = displaced(X, scene.center, 0.999999 * report.share * d);
    }
    REQUIRE(oracle.distance(X) >= kClearance * (1 - 1e-5));
    require_cover(front, a, b);
  };
  // Little work a call on the way down: nothing begins anew while it comes nearer.
  go(kSeat, 2e-5, 200);
  CHECK(X.p.z() < 2 * kSeat);
  CHECK(front.cells() > 8000);
  CHECK(fewer == 0);
  go(1e-3, 1e-4, 50);
  CHECK(fewer == 1);
  CHECK(X.p.z() > 0.99e-3);
  CHECK(front.cells() < 3000);
  go(kSeat, 2e-5, 1 << 20);
  CHECK(X.p.z() < 2 * kSeat);
  CHECK(fewer == 1);
}

TEST_CASE("a part at rest costs no search", "[patch]") {
  const Scene scene = all_scenes().back();
  CellFront front = cells_of(scene);
  front.set_near({0});
  front.set_clearance(1.1e-6);
  Pose X = scene.start;
  X.p.z() = 1e-5;
  REQUIRE(front.certify(X, {}).status == CertifyStatus::certified);
  for (int i = 0; i < 50; ++i) {
    const CertifyReport report = front.certify(X, {});
    REQUIRE(report.status == CertifyStatus::certified);
    if (i > 20) REQUIRE(report.splits == 0);
  }
  CHECK(front.certify(X, {}).searches == 0);
}

TEST_CASE("a plate that swings over many blocks passes them together", "[patch]") {
  // Where it rocks about the last blocks that it lies on, no plane at rest is between its face and all the others: it
  // would be too high at one end. One that turns with the face is.
  const Blocks blocks(20, 10, 0.01);
  const double thickness = 0.005, gap = 1e-5;
  const Scene scene{"plate on blocks", box({0.1, 0.05, 0.5 * thickness}), blocks.mesh, Vec3::Zero(), Pose{}, 0, 0};
  const Oracle oracle(scene.a, scene.b);
  // Fewer pieces are measured, eight for a search, than a quarter of the blocks' faces.
  const int few = static_cast<int>(blocks.mesh->triangles.size()) / 4 / 8;
  std::mt19937 rng(31);
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const double aside = uniform(rng, 0.01, 0.04), tilt = uniform(rng, 0, 0.01), more = uniform(rng, 0.002, 0.02);
    const auto tilted = [&](double about, double angle) {
      const Quat q = rotation(Vec3(0, angle, 0));
      const Vec3 hinge(about, 0, gap);
      return Pose{q, hinge + q * (Vec3(aside, 0, 0.5 * thickness + gap) - hinge)};
    };
    const bool up = i % 2 == 0;
    const Pose X = tilted(blocks.edge, up ? tilt : tilt + more);
    const Displacement d = displacement(X, tilted(blocks.edge, up ? tilt + more : tilt), scene.center);
    CellFront front = cells_of(scene);
    front.set_near({0});
    front.set_clearance(1.1e-6);
    REQUIRE(front.certify(X, {}).status == CertifyStatus::certified);
    for (const double times : {0.0, 40.0}) {
      front.foresee(times * d);
      const CertifyReport report = front.certify(X, d);
      CHECK(report.status == CertifyStatus::certified);
      CHECK(report.searches < few);
    }
    CHECK(oracle.hits(X, scene.center, d, 8) == 0);
    // About a line farther in, it goes into the last blocks.
    const Pose flat = tilted(blocks.edge, 0);
    const Displacement in = displacement(flat, tilted(blocks.edge - 0.02, more), scene.center);
    REQUIRE(oracle.hits(flat, scene.center, in, 8) > 0);
    const CertifyReport report = front.certify(flat, in);
    CHECK(report.status == CertifyStatus::blocked);
    CHECK(oracle.hits(flat, scene.center, 0.999999 * report.share * in, 8) == 0);
  }
}

TEST_CASE("blocking triangles of cells stand in the way", "[patch]") {
  const Scene scene = scenes()[3];
  const Oracle oracle(scene.a, scene.b);
  CellFront front = cells_of(scene);
  front.set_near({0});
  const Displacement d{Vec3(0, 0, -0.02), Vec3::Zero()};
  const CertifyReport report = front.certify(scene.start, d);
  REQUIRE(report.status == CertifyStatus::blocked);
  REQUIRE(!front.blocking().empty());
  CHECK(report.share < 1);
  // The box is 9 mm above the plate.
  REQUIRE(oracle.hits(scene.start, scene.center, 0.999999 * report.share * d, 16) == 0);
  for (const FacePair& p : front.blocking()) {
    double low_a = 1, high_b = -1;
    for (int k = 0; k < 3; ++k) {
      low_a = std::min(low_a, (scene.start * scene.a->vertices[scene.a->triangles[p.a][k]]).z());
      high_b = std::max(high_b, scene.b->vertices[scene.b->triangles[p.b][k]].z());
    }
    REQUIRE(low_a > high_b);
    REQUIRE(low_a + d.dp.z() <= high_b);
  }
}

TEST_CASE("what a part that creeps lies on is told where time ends", "[patch]") {
  const Scene scene = all_scenes().back();
  constexpr double kClearance = 1.1e-6;
  CellFront front = cells_of(scene);
  front.set_near({0});
  front.set_clearance(kClearance);
  const auto down_from = [&](double height, double by, std::int64_t deadline_ns) {
    const Pose X{Quat::Identity(), Vec3(0, 0, height)};
    return front.certify(X, {Vec3(0, 0, -by), Vec3::Zero()}, {1 << 20, 32, deadline_ns});
  };
  constexpr std::int64_t kPast = 1;
  // High above, and where it comes by more than it may lie above: nothing is told.
  REQUIRE(down_from(2e-4, 1e-5, kNoDeadline).status == CertifyStatus::certified);
  CHECK(down_from(2e-4, 1.5e-4, kPast).status == CertifyStatus::out_of_budget);
  REQUIRE(down_from(1.6e-6, 0, kNoDeadline).status == CertifyStatus::certified);
  CHECK(down_from(1.6e-6, 5e-6, kPast).status == CertifyStatus::out_of_budget);
  CHECK(front.blocking().empty());
  const CertifyReport report = down_from(1.6e-6, 8e-7, kPast);
  CHECK(report.status == CertifyStatus::blocked);
  CHECK(report.exhausted);
  CHECK(report.share < 1);
  REQUIRE(!front.blocking().empty());
  CHECK(front.blocking().size() <= 8);
  const Pose X{Quat::Identity(), Vec3(0, 0, 1.6e-6)};
  for (const FacePair& pair : front.blocking()) {
    std::array<Vec3, 3> a, b;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = X * scene.a->vertices[scene.a->triangles[pair.a][k]];
      b[k] = scene.b->vertices[scene.b->triangles[pair.b][k]];
    }
    CHECK(distance(a, b) < 10 * kClearance);
  }
}

TEST_CASE("cells of several parts, near and not", "[patch]") {
  const auto a = std::make_shared<PatchTree>(box({0.02, 0.02, 0.001})),
             post = std::make_shared<PatchTree>(peg(0.001, 0.01, 200));
  std::vector<CellFront::FixedPart> parts;
  for (int i = 0; i < 100; ++i)
    parts.push_back(
        {post, Pose{rotation(Vec3(0, 0, 0.1 * i)), Vec3(0.004 * (i % 10) - 0.018, 0.004 * (i / 10) - 0.018, -0.011)}});
  CellFront front(a, Vec3::Zero(), parts, 8192, 32);
  std::vector<std::uint32_t> all(100), none;
  for (std::uint32_t i = 0; i < 100; ++i) all[i] = i;
  front.set_near(all);
  const Pose X{Quat::Identity(), Vec3(0, 0, 0.001)};
  // The plate's underside is 1 mm above the posts.
  CHECK(front.certify(X, {Vec3(0, 0, -0.9e-3), Vec3::Zero()}).status == CertifyStatus::certified);
  CHECK(front.certify(X, {Vec3(0, 0, -1.1e-3), Vec3::Zero()}).status == CertifyStatus::blocked);
  for (const FacePair& p : front.blocking()) CHECK(p.part < 100);
  front.set_near({7});
  CHECK(front.certify(X, {Vec3(0, 0, -1.1e-3), Vec3::Zero()}).status == CertifyStatus::blocked);
  for (const FacePair& p : front.blocking()) CHECK(p.part == 7);
  front.set_near(none);
  CHECK(front.certify(X, {Vec3(0, 0, -5e-3), Vec3::Zero()}).status == CertifyStatus::certified);
  front.set_near(all);
  CHECK(front.certify(X, {Vec3(0, 0, -1.1e-3), Vec3::Zero()}).status == CertifyStatus::blocked);
}

TEST_CASE("a front that is full says so and lets go what is free", "[patch]") {
  const Scene scene = all_scenes().back();
  CellFront front = cells_of(scene, 40);
  front.set_near({0});
  Pose X = scene.start;
  X.p.z() = 0.02;
  REQUIRE(front.certify(X, {}).status == CertifyStatus::certified);
  const Displacement d{Vec3(0, 0, -0.0199), Vec3::Zero()};
  const CertifyReport report = front.certify(X, d);
  CHECK(report.overflow);
  CHECK(report.status != CertifyStatus::certified);
  CHECK(report.share > 0);
  CHECK(front.certify(X, {Vec3(0, 0, 0.01), Vec3::Zero()}).status == CertifyStatus::certified);
}

TEST_CASE("cells allocate nothing and repeat", "[patch]") {
  const Scene scene = all_scenes().back();
  const auto run = [&] {
    CellFront front = cells_of(scene);
    const std::vector<std::uint32_t> near{0};
    std::mt19937 rng(41);
    std::vector<int> log;
    log.reserve(2000);
    const AllocGuard guard;
    front.set_near(near);
    for (int i = 0; i < 300; ++i) {
      const double size = std::pow(10.0, uniform(rng, -4, 0.5));
      const CertifyReport r = front.certify(
          scene.start, {random_in_ball(rng, size * scene.move), random_in_ball(rng, size * scene.turn)}, {2000});
      for (const int x : {static_cast<int>(r.status), r.pairs, r.searches, r.splits, r.merges}) log.push_back(x);
    }
    const auto allocations = guard.count();
    REQUIRE(allocations == 0);
    return log;
  };
  REQUIRE(run() == run());
}
