// Motions that are looked at as a whole: what is said to be free or met against exact tests of triangles and FCL.
#include <map>
#include <set>

#include "alloc_guard.hpp"
#include "catch.hpp"
#include "core/numbers.hpp"
#include "narrowphase/facing.hpp"
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

Pose random_start(std::mt19937& rng, const Scene& scene) {
  return displaced(scene.start, scene.center, {random_in_ball(rng, scene.move), random_in_ball(rng, scene.turn)});
}

Displacement random_motion(std::mt19937& rng, const Scene& scene, bool turns) {
  const Vec3 moved = random_in_ball(rng, 8 * scene.move);
  return {moved, turns ? random_in_ball(rng, scene.turn) : Vec3::Zero()};
}

Corners corners(const TriangleMesh& m, std::uint32_t face, const Pose& X) {
  const auto& t = m.triangles[face];
  return {X * m.vertices[t[0]], X * m.vertices[t[1]], X * m.vertices[t[2]]};
}

/// An upper bound of the distance of two triangles: of many points of both.
double nearly(const Corners& a, const Corners& b, int n) {
  const auto at = [n](const Corners& t, int i, int k) -> Vec3 {
    return t[0] + (1.0 * i / n) * (t[1] - t[0]) + (1.0 * k / n) * (t[2] - t[0]);
  };
  double least = 1e9;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; i + k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int l = 0; j + l <= n; ++l) least = std::min(least, (at(a, i, k) - at(b, j, l)).norm());
  return least;
}

}  // namespace

TEST_CASE("blocks have all faces once, and a walk finds the blocks that a box meets") {
  std::mt19937 rng(31);
  for (const MeshPtr& mesh : {wave(0.1, 0.01, 0.04, 40), knot(0.05, 0.006, 900), box({0.01, 0.02, 0.03})}) {
    const PatchTree tree(mesh);
    const FaceBlocks blocks(tree);
    std::set<std::uint32_t> seen;
    for (std::uint32_t b = 0; b < blocks.count(); ++b) {
      for (std::uint32_t k = 0; k < blocks.faces(b); ++k) {
        const std::uint32_t face = blocks.face(b, k);
        CHECK(seen.insert(face).second);
        for (int c = 0; c < 3; ++c)
          for (std::size_t i = 0; i < 3; ++i) {
            const double x = (tree.corner(face, c) - tree.origin())[static_cast<Eigen::Index>(i)];
            CHECK((x >= blocks.box(0, b).low[i] && x <= blocks.box(0, b).high[i]));
          }
      }
    }
    CHECK(seen.size() == mesh->triangles.size());
    for (int n = 0; n < 50; ++n) {
      AxisBox box = AxisBox::empty();
      box.add(random_in_ball(rng, 0.06), random_in_ball(rng, 0.06));
      std::set<std::uint32_t> expected, found;
      for (std::uint32_t b = 0; b < blocks.count(); ++b)
        if (blocks.box(0, b).overlaps(box)) expected.insert(b);
      BlockWalk walk;
      walk.start(blocks, box);
      std::array<std::uint32_t, 3> some;
      for (std::uint32_t count = 3; count == 3;) {
        count = walk.next(some.data(), 3);
        for (std::uint32_t i = 0; i < count; ++i) CHECK(found.insert(some[i]).second);
      }
      CHECK(found == expected);
      // The same under what a larger box meets of a higher level.
      AxisBox larger = box;
      larger.add(random_in_ball(rng, 0.06), random_in_ball(rng, 0.06));
      std::array<std::uint32_t, BlockWalk::kMostTops> tops;
      walk.start(blocks, larger, 1);
      const std::uint32_t tops_count = walk.next(tops.data(), BlockWalk::kMostTops);
      std::array<std::uint32_t, 4096> under;
      walk.start_under(tops.data(), tops_count, 1, blocks, box);
      const std::uint32_t count = walk.next(under.data(), 4096);
      if (tops_count < BlockWalk::kMostTops)
        CHECK(std::set<std::uint32_t>(under.begin(), under.begin() + count) == expected);
    }
  }
}

TEST_CASE("blocks are flat: no two sides of a sheet, no layers, no two directions in one") {
  // Thin plates one over the other, each of a few large faces.
  TriangleMesh plates;
  for (int i = 0; i < 8; ++i) {
    const MeshPtr plate = box({0.1, 0.08, 0.001});
    const auto first = static_cast<std::uint32_t>(plates.vertices.size());
    for (const Vec3& v : plate->vertices) plates.vertices.push_back(v + Vec3(0, 0, 0.005 * i));
    for (const auto& t : plate->triangles) plates.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const PatchTree tree(std::make_shared<const TriangleMesh>(plates));
  const FaceBlocks blocks(tree);
  const BlockSlabs slabs(tree, blocks);
  for (std::uint32_t b = 0; b < blocks.count(); ++b) CHECK(slabs.slab(0, b).half.z() < 1e-9);
}

TEST_CASE("slabs hold the faces of their blocks, and blocks that they keep apart do not meet") {
  std::mt19937 rng(35);
  int parted = 0, wrong = 0, near = 0;
  for (const MeshPtr& mesh : {wave(0.1, 0.01, 0.04, 24), knot(0.05, 0.006, 900), box({0.01, 0.02, 0.03})}) {
    const PatchTree tree(mesh);
    const FaceBlocks blocks(tree);
    const BlockSlabs slabs(tree, blocks);
    std::uint32_t each = 1;
    for (std::uint32_t level = 0; level < slabs.levels(); ++level, each *= FaceBlocks::kFan) {
      for (std::uint32_t b = 0; b < blocks.count(); ++b) {
        const Slab& slab = slabs.slab(level, b / each);
        for (std::uint32_t k = 0; k < blocks.faces(b); ++k) {
          for (int c = 0; c < 3; ++c) {
            const Vec3 at = slab.axes.transpose() * (tree.corner(blocks.face(b, k), c) - tree.origin() - slab.center);
            CHECK((slab.half - at.cwiseAbs()).minCoeff() >= 0);
          }
        }
      }
    }
    for (int n = 0; n < 4000; ++n) {
      const auto a = static_cast<std::uint32_t>(rng() % blocks.count()),
                 b = static_cast<std::uint32_t>(rng() % blocks.count());
      const Slab &slab = slabs.slab(0, a), &other = slabs.slab(0, b);
      const Mat3 from = rotation(random_in_ball(rng, 3)).toRotationMatrix();
      const Mat3 to = rotation(random_in_ball(rng, 0.3)).toRotationMatrix() * from;
      MovedSlab moved;
      moved.from = other.center + random_in_ball(rng, 0.02);
      moved.to = moved.from + random_in_ball(rng, 0.02);
      moved.axes = from * slab.axes;
      moved.from_axes = moved.axes * slab.half.asDiagonal();
      moved.to_axes = to * slab.axes * slab.half.asDiagonal();
      const double share = apart_for(moved, other, kClearance);
      if (share == 0) continue;
      ++parted;
      for (const double s : {0.0, 0.5 * share, share}) {
        for (std::uint32_t k = 0; k < blocks.faces(a); k += 3) {
          Corners corner;
          for (int c = 0; c < 3; ++c) {
            const Vec3 p = tree.corner(blocks.face(a, k), c) - tree.origin() - slab.center;
            const Vec3 start = from * p + moved.from, end = to * p + moved.to;
            corner[static_cast<std::size_t>(c)] = start + s * (end - start);
          }
          for (std::uint32_t l = 0; l < blocks.faces(b); l += 3) {
            const Corners there = corners(*mesh, blocks.face(b, l), Pose{Quat::Identity(), -tree.origin()});
            wrong += triangles_meet(corner, there);
            if (n % 50 == 0) near += nearly(corner, there, 6) < kClearance * (1 - 1e-6);
          }
        }
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(near == 0);
  CHECK(parted > 2000);
}

/// How far (m) a face is kept from another by a direction, where it comes from and where it goes to.
double gap_along(const Vec3& n, const Corners& from, const Corners& to, const Corners& other) {
  using AlongOne = Eigen::Matrix<double, 1, 1>;
  Eigen::AlignedBox1d a, b;
  for (std::size_t c = 0; c < 3; ++c) {
    a.extend(AlongOne(n.dot(from[c]))).extend(AlongOne(n.dot(to[c])));
    b.extend(AlongOne(n.dot(other[c])));
  }
  return std::max(a.min()[0] - b.max()[0], b.min()[0] - a.max()[0]);
}

TEST_CASE("faces that are kept apart do not meet on their straight ways, however small or far from the origin") {
  std::mt19937 rng(32);
  int apart = 0, by_edges = 0, wrong = 0, near = 0, not_along = 0;
  for (int n = 0; n < 6000; ++n) {
    const double size = std::pow(10.0, uniform(rng, -4, -1));
    const Vec3 far = random_in_ball(rng, 2);
    auto mesh = std::make_shared<TriangleMesh>(*soup(rng, 16, 1.5 * size, size));
    for (Vec3& v : mesh->vertices) v += far;
    const PatchTree tree(mesh);
    const FaceBlocks blocks(tree);
    const FaceLanes lanes(tree, blocks, 0);
    auto face = std::make_shared<TriangleMesh>(*soup(rng, 1, size, size));
    const Vec3 far_a = random_in_ball(rng, 2);
    for (Vec3& v : face->vertices) v += far_a;
    const PatchTree tree_a(face);
    const FaceLanes lanes_a(tree_a, FaceBlocks(tree_a), 0);
    const Vec3 origin = random_in_ball(rng, size), at = random_in_ball(rng, 1.5 * size);
    const Quat turned = rotation(random_in_ball(rng, 3));
    const Placement start{turned.toRotationMatrix(), at - origin};
    const Placement end{(rotation(random_in_ball(rng, 0.5)) * turned).toRotationMatrix(),
                        at + random_in_ball(rng, 0.5 * size) - origin};
    std::array<Vec3, 3> from, to;
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = tree_a.corner(0, c) - tree_a.origin() - lanes_a.origin;
      from[static_cast<std::size_t>(c)] = start.R * p + start.t + origin;
      to[static_cast<std::size_t>(c)] = end.R * p + end.t + origin;
    }
    MovedLanes moved;
    moved.set(lanes_a, start, end);
    const Vec3 shift = origin - lanes.origin;
    const std::uint32_t open = not_kept_apart(moved, 0, lanes, shift, kClearance);
    for (std::uint32_t k = 0; k < blocks.faces(0); ++k) {
      std::array<float, 3> direction{};
      const bool planes = (open >> k & 1) == 0,
                 edges = edges_keep_apart(moved, 0, lanes, k, shift, kClearance, direction);
      apart += planes;
      by_edges += edges && !planes;
      if (!planes && !edges) continue;
      const Corners b = corners(*mesh, blocks.face(0, k), Pose{Quat::Identity(), -tree.origin()});
      if (edges) {
        const Vec3 told(direction[0], direction[1], direction[2]);
        CHECK(std::abs(told.norm() - 1) < 1e-5);
        not_along += gap_along(told, from, to, b) < 0.9 * kClearance;
      }
      for (int i = 0; i <= 8; ++i) {
        Corners a;
        for (std::size_t c = 0; c < 3; ++c) a[c] = from[c] + (i / 8.0) * (to[c] - from[c]);
        wrong += triangles_meet(a, b);
        // A face that is kept apart is no nearer than that.
        if (i % 8 == 0 && n % 50 == 0) near += nearly(a, b, 6) < kClearance;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(near == 0);
  CHECK(not_along == 0);
  CHECK(apart > 20000);
  CHECK(by_edges > 500);
}

TEST_CASE("all that is beside a block is asked about, whatever of it is near") {
  std::mt19937 rng(39), rng_guess(40);
  std::size_t near = 0, most = 0, guessed = 0;
  for (int n = 0; n < 400; ++n) {
    const auto mesh = soup(rng, 300, 0.05, uniform(rng, 0.005, 0.05));
    const PatchTree tree(mesh);
    const FaceBlocks blocks(tree);
    std::vector<FaceLanes> lanes;
    for (std::uint32_t b = 0; b < blocks.count(); ++b) lanes.emplace_back(tree, blocks, b);
    const auto held = soup(rng, 16, 0.03, 0.02);
    const PatchTree tree_a(held);
    const FaceBlocks blocks_a(tree_a);
    const Vec3 origin = random_in_ball(rng, 0.05);
    const Placement start{rotation(random_in_ball(rng, 3)).toRotationMatrix(), Vec3::Zero()};
    const Placement end{start.R, random_in_ball(rng, 0.02)};
    MovedLanes moved;
    moved.set(FaceLanes(tree_a, blocks_a, 0), start, end);
    // Any number of blocks, in any order.
    std::vector<std::uint32_t> found(blocks.count());
    for (std::uint32_t b = 0; b < blocks.count(); ++b) found[b] = b;
    std::shuffle(found.begin(), found.end(), rng);
    found.resize(std::min<std::size_t>(found.size(), rng() % (BesideFaces::kMost + 1)));
    BesideFaces beside;
    beside.set(blocks, lanes, found.data(), static_cast<std::uint32_t>(found.size()), moved, origin, kClearance);
    const Vec3 origin_a = FaceLanes(tree_a, blocks_a, 0).origin;
    for (std::uint32_t k = 0; k < blocks_a.faces(0); ++k) {
      Eigen::AlignedBox3d way;
      Corners from, to;
      for (int c = 0; c < 3; ++c) {
        const Vec3 at = start.R * (tree_a.corner(blocks_a.face(0, k), c) - tree_a.origin() - origin_a) + origin;
        from[static_cast<std::size_t>(c)] = at;
        to[static_cast<std::size_t>(c)] = at + end.t;
        way.extend(at).extend(at + end.t);
      }
      const Vec3 guess = random_in_ball(rng_guess, 1).normalized();
      const std::array<float, 3> guessed_n = {static_cast<float>(guess.x()), static_cast<float>(guess.y()),
                                              static_cast<float>(guess.z())};
      std::map<std::uint32_t, std::uint32_t> told;
      for (std::uint32_t at = 0; at < beside.count(); ++at)
        if (const std::uint32_t open = beside.next_not_kept_apart(moved, k, guessed_n, at); open != 0) told[at] = open;
      for (std::uint32_t i = 0; i < found.size(); ++i) {
        const FaceLanes& b = lanes[found[i]];
        std::uint32_t open = not_kept_apart(moved, k, b, origin - b.origin, kClearance);
        near += open != 0;
        const std::uint32_t known = told.count(i) != 0 ? told.at(i) : 0;
        CHECK((known & ~open) == 0);
        // Places without a face repeat the last one.
        open &= ~known & ((1U << blocks.faces(found[i])) - 1);
        for (std::uint32_t f = 0; f < blocks.faces(found[i]); ++f) {
          if ((open >> f & 1) == 0) continue;
          const Corners other = corners(*mesh, blocks.face(found[i], f), Pose{Quat::Identity(), -tree.origin()});
          if (gap_along(guess, from, to, other) < 0.999 * kClearance) continue;
          open &= ~(1U << f);
          ++guessed;
        }
        if (open != 0) {
          // Boxes are told apart with less rounding.
          Eigen::AlignedBox3d box;
          for (std::uint32_t f = 0; f < blocks.faces(found[i]); ++f)
            for (int c = 0; c < 3; ++c) box.extend(tree.corner(blocks.face(found[i], f), c) - tree.origin());
          CHECK((way.min() - box.max()).cwiseMax(box.min() - way.max()).maxCoeff() > kClearance);
        }
      }
      most = std::max(most, told.size());
    }
  }
  CHECK(near > 3000);
  CHECK(guessed > 200);
  CHECK(most > 8);
}

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
      const FacePair met = sweep.blocking().back();
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
