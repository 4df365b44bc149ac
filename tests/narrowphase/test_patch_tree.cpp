#include <vector>

#include "catch.hpp"
#include "narrowphase/patch_tree.hpp"
#include "narrowphase/piece_counts.hpp"
#include "patch_shapes.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

/// Every node holds its triangles (by the definition of PatchNode, in double precision) and every triangle is in
/// exactly one leaf.
void check(const MeshPtr& mesh) {
  const PatchTree tree(mesh);
  std::vector<int> seen(mesh->triangles.size(), 0);
  struct Open {
    std::uint32_t node;
    std::vector<std::uint32_t> above;
  };
  std::vector<Open> stack{{0, {}}};
  double worst = 0;
  while (!stack.empty()) {
    Open o = stack.back();
    stack.pop_back();
    o.above.push_back(o.node);
    const PatchNode& n = tree.nodes()[o.node];
    REQUIRE(n.half[0] >= n.half[1]);
    REQUIRE(n.half[1] >= n.half[2]);
    if (!n.leaf()) {
      stack.push_back({n.first, o.above});
      stack.push_back({n.first + 1, o.above});
      continue;
    }
    REQUIRE(n.count <= kPatchLeaf);
    for (std::uint32_t i = 0; i < n.count; ++i) {
      const std::uint32_t f = tree.order()[n.first + i];
      ++seen[f];
      std::vector<PatchNode> boxes{tree.face_box(f)};
      for (std::uint32_t k : o.above) boxes.push_back(tree.nodes()[k]);
      for (const PatchNode& m : boxes) {
        Mat3 axes;
        axes << m.axis_vec(0), m.axis_vec(1), m.axis_vec(2);
        for (int c = 0; c < 3; ++c) {
          const Vec3 t = axes.inverse() * (tree.corner(f, c) - tree.origin() - m.center_vec());
          for (int i3 = 0; i3 < 3; ++i3) worst = std::max(worst, std::abs(t[i3]) - m.half[i3]);
        }
      }
    }
  }
  REQUIRE(worst <= 0);
  REQUIRE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  REQUIRE(static_cast<double>(tree.bytes()) <= 160.0 * static_cast<double>(mesh->triangles.size()) + 200);
}

}  // namespace

TEST_CASE("patch boxes hold their triangles, each in one leaf", "[patch]") {
  std::mt19937 rng(11);
  check(box({0.01, 0.02, 0.0001}));
  check(peg(0.01, 0.04, 3000));
  check(hole(0.01, 0.04, 3000));
  check(knot(0.05, 0.006, 3000));
  check(soup(rng, 2000, 0.1, 0.01));
  check(soup(rng, 1, 0.1, 0.01));
}

TEST_CASE("patch boxes hold triangles far from the file's origin and on one line", "[patch]") {
  auto far_away = std::make_shared<TriangleMesh>(*knot(0.05, 0.006, 1000));
  for (Vec3& v : far_away->vertices) v += Vec3(12.3, -4.5, 6.7);
  check(far_away);
  auto thread = std::make_shared<TriangleMesh>();
  for (int i = 0; i <= 40; ++i) thread->vertices.emplace_back(1e-3 * i, 2e-3 * i, 0);
  for (std::uint32_t i = 0; i + 2 <= 40; ++i) thread->triangles.push_back({i, i + 1, i + 2});
  check(thread);
  auto point = std::make_shared<TriangleMesh>();
  point->vertices.assign(3, Vec3(1, 2, 3));
  point->triangles.assign(30, {0, 1, 2});
  check(point);
}

TEST_CASE("patches of a peg are as wide as their sagitta allows", "[patch]") {
  // A wall of radius R is within the thickness t over a width of √(8 R t): a circumference takes 2 π R / √(8 R t)
  // strips.
  const double R = 0.01, t = 1e-4;
  const PatchTree tree(peg(R, 0.04, 20000));
  int strips = 0;
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const PatchNode& n = tree.nodes()[stack.back()];
    stack.pop_back();
    if (n.leaf() || 2 * n.half[2] <= t) {
      ++strips;
    } else {
      stack.push_back(n.first);
      stack.push_back(n.first + 1);
    }
  }
  const double ideal = 2 * kPi * R / std::sqrt(8 * R * t);
  REQUIRE(strips <= 3 * ideal + 2);
}

TEST_CASE("pieces are counted by how thick they may be", "[patch]") {
  for (const MeshPtr& mesh : {peg(0.01, 0.04, 20000), knot(0.03, 0.004, 5000), box({0.01, 0.02, 0.03})}) {
    const PatchTree tree(mesh);
    const PieceCounts counts(tree);
    const auto thickest = [&](std::uint32_t top) {
      float most = 0;
      std::vector<std::uint32_t> stack{top};
      while (!stack.empty()) {
        const PatchNode& n = tree.nodes()[stack.back()];
        stack.pop_back();
        most = std::max(most, n.half[2]);
        if (n.leaf()) continue;
        stack.push_back(n.first);
        stack.push_back(n.first + 1);
      }
      return most;
    };
    /// Down from the root to nodes all of which is thin enough, or to leaves.
    const auto walked = [&](double half_thickness) {
      int pieces = 0;
      std::vector<std::uint32_t> stack{0};
      while (!stack.empty()) {
        const std::uint32_t node = stack.back();
        const PatchNode& n = tree.nodes()[node];
        stack.pop_back();
        if (n.leaf() || thickest(node) <= half_thickness) {
          ++pieces;
        } else {
          stack.push_back(n.first);
          stack.push_back(n.first + 1);
        }
      }
      return pieces;
    };
    for (double half = 1e-10; half < 1; half *= 7) {
      CAPTURE(half);
      // Thicknesses within a fifth of each other count as one.
      CHECK(counts.at(half) <= walked(half / 1.2));
      CHECK(counts.at(half) >= walked(half * 1.2));
    }
    CHECK(counts.at(1) == 1);
  }
}

TEST_CASE("a mesh without triangles has no hierarchy", "[patch]") {
  REQUIRE_THROWS_AS(PatchTree(std::make_shared<TriangleMesh>()), Error);
}
