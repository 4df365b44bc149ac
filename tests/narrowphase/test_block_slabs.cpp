// Eight blocks at once, of which looks at all faces are made: against exact tests of triangles and closed forms.
#include <algorithm>

#include "block_shapes.hpp"
#include "catch.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kFloor = 1.1e-6;

/// How far (m) a plane across one of the two slabs keeps them apart at both ends.
double gap(const Slab& a, const Way& way, const Slab& b) {
  double best = -1;
  for (const Vec3& n : {Vec3(b.axes.col(2)), Vec3(way.start.R * a.axes.col(2))}) {
    const double reach_b = (n.transpose() * b.axes).cwiseAbs().dot(b.half);
    std::array<double, 2> off;
    std::array<double, 2> reach;
    for (std::size_t k = 0; k < 2; ++k) {
      const Mat3& R = k == 0 ? way.start.R : way.end.R;
      off[k] = n.dot(way.at(a.center, static_cast<double>(k)) - b.center);
      reach[k] = (n.transpose() * R * a.axes).cwiseAbs().dot(a.half) + reach_b;
    }
    best = std::max(
        {best, std::min(off[0] - reach[0], off[1] - reach[1]), std::min(-off[0] - reach[0], -off[1] - reach[1])});
  }
  return best;
}

/// Whether the boxes along the axes overlap of a block and of all that another passes, but for `slack` (m).
bool boxes_overlap(const Blocks& a, std::uint32_t block_a, const Way& way, const Blocks& b, std::uint32_t block_b,
                   double slack) {
  Eigen::AlignedBox3d passed, other;
  for (std::uint32_t k = 0; k < a.blocks.faces(block_a); ++k)
    for (const Vec3& p : a.corners(block_a, k)) passed.extend(way.at(p, 0)).extend(way.at(p, 1));
  for (std::uint32_t k = 0; k < b.blocks.faces(block_b); ++k)
    for (const Vec3& p : b.corners(block_b, k)) other.extend(p);
  return (passed.min() - other.max()).cwiseMax(other.min() - passed.max()).maxCoeff() < slack;
}

bool meet_on_way(const Blocks& a, std::uint32_t block_a, const Way& way, const Blocks& b, std::uint32_t block_b) {
  for (std::uint32_t k = 0; k < a.blocks.faces(block_a); k += 3)
    for (std::uint32_t l = 0; l < b.blocks.faces(block_b); l += 3)
      for (const double s : {0.0, 0.3, 0.7, 1.0}) {
        Corners at = a.corners(block_a, k);
        for (Vec3& p : at) p = way.at(p, s);
        if (triangles_meet(at, b.corners(block_b, l))) return true;
      }
  return false;
}

}  // namespace

TEST_CASE("blocks that are told apart eight at once do not meet on their way, and those that planes part are told") {
  std::mt19937 rng(52);
  std::size_t told = 0, open = 0, wrong = 0, missed = 0, of_planes = 0;
  for (const MeshPtr& mesh : {wave(0.1, 0.01, 0.04, 60), knot(0.05, 0.006, 4000)}) {
    const Blocks b(mesh);
    const std::uint32_t nodes = b.blocks.nodes(1);
    for (int n = 0; n < 150; ++n) {
      const auto node = static_cast<std::uint32_t>(rng() % nodes);
      const Mat3 R = rotation(random_in_ball(rng, 3)).toRotationMatrix();
      const Vec3 beside = b.slabs.slab(1, static_cast<std::uint32_t>(rng() % nodes)).center + random_in_ball(rng, 0.01);
      Way way;
      way.start = {R, beside - R * b.slabs.slab(1, node).center};
      way.end = {rotation(random_in_ball(rng, 0.2)).toRotationMatrix() * R, way.start.t + random_in_ball(rng, 0.01)};
      MovedSlabs eight;
      eight.set(b.slabs.lanes(0, node), way.start, way.end);
      std::vector<std::uint32_t> tops(nodes);
      for (std::uint32_t i = 0; i < nodes; ++i) tops[i] = i;
      for (std::uint32_t k = 0; k < FaceBlocks::kFan; ++k) {
        const std::uint32_t a = FaceBlocks::kFan * node + k;
        if (a >= b.blocks.count()) break;
        std::vector<std::uint32_t> left(b.blocks.count());
        const auto under = [&](std::uint32_t most) {
          return not_kept_apart_under(tops.data(), nodes, 1, b.blocks, b.slabs, eight.slab(k), eight.origin,
                                      eight.box(k, kFloor), kFloor, left.data(), most);
        };
        left.resize(under(b.blocks.count()));
        if (!left.empty()) CHECK(under(static_cast<std::uint32_t>(left.size()) - 1) == left.size());
        std::sort(left.begin(), left.end());
        open += left.size();
        for (std::uint32_t other = 0; other < b.blocks.count(); ++other) {
          const bool is_open = std::binary_search(left.begin(), left.end(), other);
          const double apart = gap(b.slabs.slab(0, a), way, b.slabs.slab(0, other));
          of_planes += apart > kFloor;
          missed += is_open && apart > kFloor + 1e-5 * 0.1;
          if (is_open) continue;
          // It is told by planes or by boxes.
          wrong += apart < kFloor && boxes_overlap(b, a, way, b, other, 0);
          if (!boxes_overlap(b, a, way, b, other, 0.002)) continue;
          ++told;
          if (rng() % 8 == 0) wrong += meet_on_way(b, a, way, b, other);
        }
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(missed == 0);
  CHECK(told > 10000);
  CHECK(of_planes > 10000);
  CHECK(open > 2000);
}

TEST_CASE("the balls about slabs hold their faces, and the box of a moved block those that are left") {
  std::mt19937 rng(53);
  const Blocks b(knot(0.05, 0.006, 2000));
  for (std::uint32_t block = 0; block < b.blocks.count(); ++block) {
    const SlabLanes& lanes = b.slabs.lanes(0, block / FaceBlocks::kFan);
    const std::uint32_t at = block % FaceBlocks::kFan;
    double farthest = 0;
    for (std::uint32_t k = 0; k < b.blocks.faces(block); ++k)
      for (const Vec3& p : b.corners(block, k)) farthest = std::max(farthest, (p - lanes.middle(at)).norm());
    CHECK(farthest <= lanes.radius(at));

    const FaceLanes faces(b.tree, b.blocks, block);
    const Mat3 R = rotation(random_in_ball(rng, 3)).toRotationMatrix();
    const Way way{{R, random_in_ball(rng, 0.01)}, {R, random_in_ball(rng, 0.01)}};
    MovedLanes moved;
    moved.set(faces, way.start, way.end);
    const auto skipped = static_cast<std::uint32_t>(rng()) & 0x7FFEU;
    const AxisBox box = moved.box_without(skipped);
    Eigen::AlignedBox3d expected;
    for (std::uint32_t k = 0; k < kBlockFaces; ++k) {
      if ((skipped >> k & 1) != 0) continue;
      for (const Vec3& p : b.corners(block, std::min(k, b.blocks.faces(block) - 1)))
        expected.extend(way.at(p - faces.origin, 0)).extend(way.at(p - faces.origin, 1));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      CHECK(std::abs(box.low[i] - expected.min()[axis]) < 1e-7);
      CHECK(std::abs(box.high[i] - expected.max()[axis]) < 1e-7);
    }
  }
}
