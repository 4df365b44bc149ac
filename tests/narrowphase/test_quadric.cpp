// Heights over quadrics, by which looks at all faces tell whole nodes of curved surfaces apart: against distances of
// all triangles, and closed forms.
#include <algorithm>
#include <cmath>

#include "block_shapes.hpp"
#include "catch.hpp"
#include "patch_scenes.hpp"
#include "triangle_distance.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kFloor = 1.1e-6, kRadius = 0.05;
constexpr std::uint32_t kFan = FaceBlocks::kFan;

/// Open sheet of n × n fields over a square, as high as `height` says.
template <typename Height>
MeshPtr sheet(double size, int n, Height height) {
  auto mesh = std::make_shared<TriangleMesh>(*wave(size, 0, 1, n));
  for (Vec3& p : mesh->vertices) p.z() = height(p.x(), p.y());
  return mesh;
}

MeshPtr bowl(double size, int n) {
  return sheet(size, n, [](double x, double y) { return (x * x + y * y) / (2 * kRadius); });
}

struct Asked {
  std::uint32_t apart = 0;
  QuadricLanes::Field share;
};

/// Of eight nodes of B, those that are kept apart from one of A's.
Asked ask(const Blocks& a, std::uint32_t level, std::uint32_t node, const Way& way, const Blocks& b,
          std::uint32_t eight) {
  MovedSlabs moved;
  moved.set(a.slabs.lanes(level, node / kFan), way.start, way.end);
  Asked out;
  out.apart =
      kept_apart_by_heights(moved.slab(node % kFan), a.slabs.quadrics(level, node / kFan), node % kFan, moved.origin,
                            b.slabs.lanes(level, eight), b.slabs.quadrics(level, eight), kFloor, out.share);
  return out;
}

std::vector<Corners> faces_of(const Blocks& of, std::uint32_t level, std::uint32_t node) {
  const std::uint32_t each = level == 0 ? 1 : kFan;
  std::vector<Corners> out;
  for (std::uint32_t block = each * node; block < std::min(each * (node + 1), of.blocks.count()); ++block)
    for (std::uint32_t k = 0; k < of.blocks.faces(block); ++k) out.push_back(of.corners(block, k));
  return out;
}

/// How near (m) faces come on their way, at some places of it.
double nearest(const std::vector<Corners>& a, const Way& way, const std::vector<Corners>& b) {
  const auto ball = [](const Corners& c) {
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3;
    return std::pair{middle, std::max({(c[0] - middle).norm(), (c[1] - middle).norm(), (c[2] - middle).norm()})};
  };
  double least = 1;
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0})
    for (Corners at : a) {
      for (Vec3& p : at) p = way.at(p, s);
      const auto [middle, radius] = ball(at);
      for (const Corners& other : b) {
        const auto [of_other, reach] = ball(other);
        if ((middle - of_other).norm() < radius + reach + least) least = std::min(least, test::distance(at, other));
      }
    }
  return least;
}

Way straight(const Vec3& from, const Vec3& to) {
  return {{Mat3::Identity(), from}, {Mat3::Identity(), to}};
}

}  // namespace

TEST_CASE("faces that heights over quadrics tell apart are so all along their way") {
  std::mt19937 rng(71);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto saddle = [](double x, double y) { return (x * x - y * y + 0.6 * x * y) / (2 * kRadius); };
  const auto waves = [](double x, double y) { return 3e-3 * std::sin(70 * x) * std::cos(50 * y); };
  const std::vector<Blocks> shapes = {Blocks(bowl(0.06, 40)), Blocks(sheet(0.06, 40, saddle)),
                                      Blocks(sheet(0.06, 40, waves)), Blocks(knot(0.05, 0.012, 4000))};
  std::size_t told = 0, wrong = 0, tight = 0;
  for (int draw = 0; draw < 6000; ++draw) {
    // A node over another one, turned about the normal and a little else, or over itself; it moves along it and turns.
    const bool same = draw % 2 == 0;
    const Blocks &b = shapes[rng() % shapes.size()], &a = same ? b : shapes[rng() % shapes.size()];
    const std::uint32_t level = draw % 60 == 0 ? 1 : 0;
    const auto node = static_cast<std::uint32_t>(rng() % a.blocks.nodes(level)),
               other = same ? node : static_cast<std::uint32_t>(rng() % b.blocks.nodes(level));
    const Slab &slab = a.slabs.slab(level, node), &under = b.slabs.slab(level, other);
    const double size = slab.half.head<2>().maxCoeff(), side = rng() % 2 == 0 ? 1 : -1;
    const Vec3 normal = side * under.axes.col(2);
    const Mat3 upright = under.axes * rotation(Vec3(0, 0, same ? 0 : 2 * kPi * unit(rng))).toRotationMatrix();
    const Mat3 R = rotation(random_in_ball(rng, 0.3 * std::pow(unit(rng), 3))).toRotationMatrix() * upright *
                   slab.axes.transpose();
    const Mat3 turned = rotation(random_in_ball(rng, 0.2 * std::pow(unit(rng), 3))).toRotationMatrix() * R;
    const Vec3 beside = random_in_ball(rng, same ? 0.1 * size : size),
               along = random_in_ball(rng, 4 * size * unit(rng));
    const auto way = [&](double height) {
      const Vec3 from = under.center + beside + height * normal;
      return Way{{R, from - R * slab.center}, {turned, from + along - turned * slab.center}};
    };
    const auto is_told = [&](double height) {
      return (ask(a, level, node, way(height), b, other / kFan).apart >> (other % kFan) & 1) != 0;
    };
    // As near as it is told.
    double near = 0, far = 4 * size;
    if (!is_told(far) || is_told(near)) continue;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (near + far);
      (is_told(middle) ? far : near) = middle;
    }
    ++told;
    const double least = nearest(faces_of(a, level, node), way(far), faces_of(b, level, other));
    wrong += least < kFloor;
    tight += least < 0.2 * (slab.half.z() + under.half.z());
  }
  CHECK(wrong == 0);
  CHECK(told > 3500);
  CHECK(tight > 300);
}

/// Two bowls that lie in each other, and by how much (m) their facets and what quadrics of whole nodes leave of a bowl
/// that is seen from the side may bring them nearer: by terms of the third order.
struct Bowls {
  static constexpr int kFields = 32;
  static constexpr double kSize = 0.02, kEdge = kSize / kFields;

  Blocks blocks{bowl(kSize, kFields)};

  double off(std::uint32_t level) const {
    double longest = 0;
    for (std::uint32_t node = 0; node < blocks.blocks.nodes(level); ++node)
      longest = std::max(longest, blocks.slabs.slab(level, node).half.head<2>().maxCoeff());
    const double slope = std::sqrt(0.5) * kSize / kRadius;
    return 1.5 * kEdge * kEdge / (4 * kRadius) + slope * std::pow(longest, 3) / (2 * kRadius * kRadius) + 3 * kFloor;
  }
};

TEST_CASE("nodes of bowls that lie in each other are told apart as near as they follow quadrics") {
  const Bowls bowls;
  const Blocks& b = bowls.blocks;
  for (const std::uint32_t level : {0U, 1U}) {
    CAPTURE(level, bowls.off(level));
    const double gap = bowls.off(level);
    const Way way = straight(Vec3(0, 0, gap), Vec3(2e-5, 0, gap));
    std::uint32_t told = 0, by_planes = 0;
    for (std::uint32_t node = 0; node < b.blocks.nodes(level); ++node) {
      MovedSlabs moved;
      moved.set(b.slabs.lanes(level, node / kFan), way.start, way.end);
      const std::uint32_t planes =
          kept_apart(moved.slab(node % kFan), moved.origin, b.slabs.lanes(level, node / kFan), kFloor);
      by_planes += planes >> (node % kFan) & 1;
      told += ask(b, level, node, way, b, node / kFan).apart >> (node % kFan) & 1;
    }
    CHECK(told > 0.8 * b.blocks.nodes(level));
    CHECK(by_planes == 0);
  }
}

TEST_CASE("how much of a motion heights allow is the closed form of bowls") {
  const double gap = 1e-4;
  const Bowls bowls;
  const Blocks& b = bowls.blocks;
  for (const std::uint32_t level : {0U, 1U}) {
    CAPTURE(level);
    std::uint32_t near = 0;
    for (std::uint32_t node = 0; node < b.blocks.nodes(level); ++node) {
      // Straight down, to as far below the other bowl as it was above.
      const Asked asked = ask(b, level, node, straight(Vec3(0, 0, gap), Vec3(0, 0, -gap)), b, node / kFan);
      CHECK((asked.apart >> (node % kFan) & 1) == 0);
      const double share = asked.share[node % kFan];
      CHECK(share < 0.5);
      near += share > 0.5 * (1 - bowls.off(level) / gap);
    }
    CHECK(near > 0.9 * b.blocks.nodes(level));
  }
}

TEST_CASE("faces that follow no quadric have none") {
  std::mt19937 rng(72);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Blocks flat(wave(0.06, 0, 1, 32)), noise(sheet(0.06, 32, [&](double, double) { return 2e-4 * unit(rng); })),
      steep(sheet(0.06, 32, [](double x, double) { return 40 * x * x; }));
  const auto fits = [](const Blocks& of) {
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < of.blocks.nodes(1); ++i)
      for (std::uint32_t k = 0; k < kFan; ++k) count += of.slabs.quadrics(0, i).fits >> k & 1;
    return count;
  };
  CHECK(fits(flat) == 0);
  CHECK(fits(noise) < noise.blocks.count() / 10);
  CHECK(fits(steep) > 0);
  CHECK(fits(Blocks(bowl(0.06, 32))) > 0);
}
