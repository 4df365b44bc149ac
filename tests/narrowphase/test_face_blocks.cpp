// Blocks of faces and their lanes, of which motions that are looked at as a whole are made: against exact tests of
// triangles.
#include <map>
#include <set>

#include "catch.hpp"
#include "core/numbers.hpp"
#include "narrowphase/beside_faces.hpp"
#include "narrowphase/surface_sweep.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kKeptApart = 1.1e-6;

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

TEST_CASE("blocks of what is round are drawn out along it, and flat for it") {
  // A tube of squares, two triangles each: around it, what is `n` squares wide is R (1 - cos(n pi / around)) deep.
  constexpr int kAround = 240, kAlong = 120;
  constexpr double kRadius = 0.1, kEdge = 2 * test::kPi * kRadius / kAround;
  TriangleMesh tube;
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * test::kPi * k / kAround;
      tube.vertices.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), i * kEdge);
    }
  const auto at = [](int i, int k) { return static_cast<std::uint32_t>(kAround * i + k % kAround); };
  for (int i = 0; i < kAlong; ++i)
    for (int k = 0; k < kAround; ++k) {
      tube.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
      tube.triangles.push_back({at(i + 1, k), at(i, k + 1), at(i + 1, k + 1)});
    }
  const PatchTree tree(std::make_shared<const TriangleMesh>(tube));
  const FaceBlocks blocks(tree);
  const BlockSlabs slabs(tree, blocks);
  const auto depth = [&](double squares) { return kRadius * (1 - std::cos(squares * test::kPi / kAround)); };
  double mean = 0;
  for (std::uint32_t b = 0; b < blocks.count(); ++b) mean += 2 * slabs.slab(0, b).half.z() / blocks.count();
  // Eight squares are four by two; as many blocks would lie either way if it did not matter.
  CHECK(mean < depth(3));
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
      const double share = apart_for(moved, other, kKeptApart);
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
            if (n % 50 == 0) near += nearly(corner, there, 6) < kKeptApart * (1 - 1e-6);
          }
        }
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(near == 0);
  CHECK(parted > 2000);
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
    const std::uint32_t open = not_kept_apart(moved, 0, lanes, shift, kKeptApart);
    for (std::uint32_t k = 0; k < blocks.faces(0); ++k) {
      std::array<float, 3> direction{};
      const bool planes = (open >> k & 1) == 0,
                 edges = edges_keep_apart(moved, 0, lanes, k, shift, kKeptApart, direction);
      apart += planes;
      by_edges += edges && !planes;
      if (!planes && !edges) continue;
      const Corners b = corners(*mesh, blocks.face(0, k), Pose{Quat::Identity(), -tree.origin()});
      if (edges) {
        const Vec3 told(direction[0], direction[1], direction[2]);
        CHECK(std::abs(told.norm() - 1) < 1e-5);
        not_along += gap_along(told, from, to, b) < 0.9 * kKeptApart;
      }
      for (int i = 0; i <= 8; ++i) {
        Corners a;
        for (std::size_t c = 0; c < 3; ++c) a[c] = from[c] + (i / 8.0) * (to[c] - from[c]);
        wrong += triangles_meet(a, b);
        // A face that is kept apart is no nearer than that.
        if (i % 8 == 0 && n % 50 == 0) near += nearly(a, b, 6) < kKeptApart;
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
  std::size_t near = 0, most = 0, guessed = 0, as_a_whole = 0, wrong = 0;
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
    beside.set(blocks, lanes, found.data(), static_cast<std::uint32_t>(found.size()), moved, origin, kKeptApart);
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
      for (std::uint32_t left = beside.open(k), bit = 0; left != 0;)
        if (const std::uint32_t open = beside.next_not_kept_apart(moved, k, guessed_n, left, bit); open != 0)
          told[beside.index(bit)] = open;
      for (std::uint32_t i = 0; i < found.size(); ++i) {
        const FaceLanes& b = lanes[found[i]];
        std::uint32_t open = not_kept_apart(moved, k, b, origin - b.origin, kKeptApart);
        near += open != 0;
        const std::uint32_t known = told.count(found[i]) != 0 ? told.at(found[i]) : 0;
        CHECK((known & ~open) == 0);
        // Places without a face repeat the last one.
        open &= ~known & ((1U << blocks.faces(found[i])) - 1);
        for (std::uint32_t f = 0; f < blocks.faces(found[i]); ++f) {
          if ((open >> f & 1) == 0) continue;
          const Corners other = corners(*mesh, blocks.face(found[i], f), Pose{Quat::Identity(), -tree.origin()});
          if (gap_along(guess, from, to, other) < 0.999 * kKeptApart) continue;
          open &= ~(1U << f);
          ++guessed;
        }
        if (open == 0) continue;
        // Boxes are told apart with less rounding.
        Eigen::AlignedBox3d box;
        for (std::uint32_t f = 0; f < blocks.faces(found[i]); ++f)
          for (int c = 0; c < 3; ++c) box.extend(tree.corner(blocks.face(found[i], f), c) - tree.origin());
        if ((way.min() - box.max()).cwiseMax(box.min() - way.max()).maxCoeff() > kKeptApart) continue;
        // Or a direction keeps one face apart from all of the others.
        for (std::uint32_t f = 0; f < blocks.faces(found[i]); ++f) {
          if ((open >> f & 1) == 0) continue;
          ++as_a_whole;
          const Corners other = corners(*mesh, blocks.face(found[i], f), Pose{Quat::Identity(), -tree.origin()});
          for (int s = 0; s <= 8; ++s) {
            Corners on_way;
            for (std::size_t c = 0; c < 3; ++c) on_way[c] = from[c] + (s / 8.0) * (to[c] - from[c]);
            wrong += triangles_meet(on_way, other) || (n % 20 == 0 && nearly(on_way, other, 6) < kKeptApart);
          }
        }
      }
      most = std::max(most, told.size());
    }
  }
  CHECK(near > 3000);
  CHECK(guessed > 200);
  CHECK(as_a_whole > 20);
  CHECK(wrong == 0);
  CHECK(most > 8);
}

TEST_CASE("blocks of flat sheets are open to each other just where these come too near") {
  std::mt19937 rng(41);
  for (int n = 0; n < 200; ++n) {
    const Mat3 turned = rotation(random_in_ball(rng, 3)).toRotationMatrix();
    auto sheet = std::make_shared<TriangleMesh>(*wave(0.01, 0, 0.01, 8));
    for (Vec3& v : sheet->vertices) v = turned * v;
    const PatchTree tree(sheet);
    const FaceBlocks blocks(tree);
    std::vector<FaceLanes> lanes;
    std::vector<std::uint32_t> found;
    for (std::uint32_t b = 0; b < blocks.count(); ++b) {
      lanes.emplace_back(tree, blocks, b);
      found.push_back(b);
    }
    REQUIRE(found.size() > 4);
    // Above or below, aside, and at the end of the motion that far from each other.
    const Vec3 up = (n % 2 == 0 ? 1 : -1) * turned.col(2), aside = 0.003 * (turned * Vec3(uniform(rng, -1, 1), 1, 0));
    const bool apart = n % 4 < 2;
    const double at_end = apart ? uniform(rng, kKeptApart + 1e-6, 1e-4) : uniform(rng, -1e-4, kKeptApart - 1e-6);
    const Vec3 origin = aside + uniform(rng, 2e-4, 1e-3) * up, middle = lanes[0].origin + origin;
    MovedLanes moved;
    moved.set(lanes[0], {Mat3::Identity(), Vec3::Zero()}, {Mat3::Identity(), (at_end - origin.dot(up)) * up});
    BesideFaces beside;
    beside.set(blocks, lanes, found.data(), static_cast<std::uint32_t>(found.size()), moved, middle, kKeptApart);
    for (std::uint32_t k = 0; k < kBlockFaces; ++k) CHECK(beside.open(k) == (apart ? 0 : (1U << found.size()) - 1));
  }
}
