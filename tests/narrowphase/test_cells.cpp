// What free cells are made of: distances of many pieces at once, planes that lose what comes against them.
#include "catch.hpp"
#include "narrowphase/cell_anchor.hpp"
#include "narrowphase/cell_search.hpp"
#include "narrowphase/near_hulls.hpp"
#include "patch_oracle.hpp"
#include "patch_scenes.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

std::array<Vec3, 3> random_triangle(std::mt19937& rng, const Vec3& at, double size) {
  return {at + random_in_ball(rng, size), at + random_in_ball(rng, size), at + random_in_ball(rng, size)};
}

Hull random_box(std::mt19937& rng, const Vec3& at, double size) {
  const Mat3 R = rotation(random_in_ball(rng, 3)).toRotationMatrix();
  return Hull::box(at, {R.col(0), R.col(1), R.col(2)},
                   {size * uniform(rng, 0.1, 1), size * uniform(rng, 0.01, 1), size * uniform(rng, 0, 0.3)});
}

/// Corners of a hull.
std::vector<Vec3> corners(const Hull& h) {
  if (h.is_triangle()) return {h.corner(0), h.corner(1), h.corner(2)};
  std::vector<Vec3> out;
  for (int i = 0; i < 8; ++i) {
    Vec3 v = h.middle();
    for (int k = 0; k < 3; ++k) v += ((i >> k & 1) != 0 ? 1 : -1) * h.half(k) * h.axis(k);
    out.push_back(v);
  }
  return out;
}

/// A surface of the hull, for FCL.
MeshPtr surface(const Hull& h) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "hull";
  mesh->vertices = corners(h);
  if (h.is_triangle()) {
    mesh->triangles = {{0, 1, 2}};
  } else {
    for (const auto& q : {std::array<std::uint32_t, 4>{0, 1, 3, 2},
                          {4, 5, 7, 6},
                          {0, 1, 5, 4},
                          {2, 3, 7, 6},
                          {0, 2, 6, 4},
                          {1, 3, 7, 5}}) {
      mesh->triangles.push_back({q[0], q[1], q[2]});
      mesh->triangles.push_back({q[0], q[2], q[3]});
    }
  }
  return mesh;
}

void put(const Hull& b, const Vec3& origin, std::size_t i, NearHulls& out) {
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    for (int e = 0; e < 3; ++e)
      out.edge[static_cast<std::size_t>(e)][k][i] =
          static_cast<float>(b.is_triangle() ? b.corner(e)[c] - origin[c] : b.axis(e)[c]);
    out.center[k][i] = static_cast<float>(b.middle()[c]);
    out.half[k][i] = b.is_triangle() ? 0 : static_cast<float>(b.half(c));
  }
}

/// Gaps are measured in single precision, in which the normal of a thin triangle is right up to 1e-4 (m, of 0.05).
constexpr double kGapMargin = 5e-6;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// The line of the normal that a measure names.
Vec3 normal(const HullFrame& a, const Hull& b, const Nearness::Side& side, std::size_t i) {
  const int number = static_cast<int>(std::abs(side.normal[i]));
  if (number <= 3) return a.axis[static_cast<std::size_t>(number - 1)];
  if (!b.is_triangle()) return b.axis(number - 4);
  return (b.corner(1) - b.corner(0)).cross(b.corner(2) - b.corner(0)).normalized();
}

}  // namespace

TEST_CASE("what is kept in single precision is checked as it is kept", "[patch]") {
  std::mt19937 rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v = random_in_ball(rng, 1), kept = single(v);
    // 24 bits of a number's mantissa: nothing is left below.
    for (int c = 0; c < 3; ++c) {
      int exponent = 0;
      const double mantissa = std::ldexp(std::frexp(kept[c], &exponent), 24);
      REQUIRE(mantissa == std::round(mantissa));
      REQUIRE(std::abs(kept[c] - v[c]) <= std::ldexp(std::abs(v[c]), -24));
    }
  }
}

TEST_CASE("measured distances are lower bounds, and gaps those along the named normals", "[patch]") {
  std::mt19937 rng(3);
  int close = 0;
  for (int round = 0; round < 400; ++round) {
    const bool a_is_box = round % 2 == 0, b_is_box = round % 4 < 2;
    // Far from the origin too, where numbers of single precision are micrometers apart: centers of boxes are such.
    const Vec3 where = round % 8 < 4 ? Vec3::Zero().eval() : random_in_ball(rng, 100);
    const Hull a = a_is_box ? random_box(rng, where, 0.01) : Hull::triangle(random_triangle(rng, where, 0.01));
    const Vec3 ahead = round % 3 == 0 ? Vec3::Zero().eval() : random_in_ball(rng, 0.02);
    const HullFrame frame(a, ahead);
    NearHulls near{};
    std::vector<Hull> b;
    for (std::size_t i = 0; i < kMeasured; ++i) {
      const Vec3 at = single(where + random_in_ball(rng, 0.04));
      b.push_back(b_is_box ? random_box(rng, at, 0.008) : Hull::triangle(random_triangle(rng, at, 0.008)));
      put(b.back(), frame.origin, i, near);
    }
    Nearness n;
    (b_is_box ? measure_boxes : measure_triangles)(frame, near, n);
    for (std::size_t i = 0; i < kMeasured; ++i) {
      const double bound = double{n.distance[i]};
      const Oracle oracle(surface(a), surface(b[i]));
      double truth = oracle.distance(Pose{});
      for (int k = 1; k <= 8 && !ahead.isZero(0); ++k)
        truth = std::min(truth, oracle.distance({Quat::Identity(), 0.125 * k * ahead}));
      REQUIRE(bound <= truth + 1e-12);
      close += bound > 0.6 * truth;
      for (const Nearness::Side* side : {&n.any, &n.upright}) {
        const Vec3 line = normal(frame, b[i], *side, i);
        double most = -kNone;
        for (const double sign : {1.0, -1.0}) {
          const Vec3 along = sign * line;
          double low = kNone, high = -kNone;
          for (const Vec3& p : corners(a)) low = std::min({low, along.dot(p), along.dot(p + ahead)});
          for (const Vec3& p : corners(b[i])) high = std::max(high, along.dot(p));
          most = std::max(most, low - high);
          // Planes of triangles may face either way.
          if (!b[i].is_triangle() || std::abs(side->normal[i]) < 4)
            REQUIRE((sign * double{side->normal[i]} < 0 || side->gap[i] == Approx(low - high).margin(kGapMargin)));
        }
        REQUIRE(side->gap[i] == Approx(most).margin(kGapMargin));
      }
      REQUIRE(n.upright.gap[i] <= n.any.gap[i]);
    }
  }
  CHECK(close > 1400);
}

TEST_CASE("a batch has all that is under its node once, as it is in the tree", "[patch]") {
  for (const Scene& scene : scenes()) {
    CAPTURE(scene.name);
    const PatchTree tree(scene.b);
    const PatchBatches batches(tree);
    PatchBatch made;
    for (std::uint32_t node = 0; node < tree.nodes().size(); ++node) {
      const PatchBatch& batch = batches.of(tree, node, made);
      REQUIRE((batch.count > 0 && batch.count <= kMeasured));
      std::vector<std::uint32_t> faces;
      for (std::size_t i = 0; i < batch.count; ++i) {
        const bool is_face = (batch.item[i] & CellItems::kFace) != 0;
        const std::uint32_t place = batch.item[i] & ~CellItems::kFace;
        REQUIRE(is_face == batch.faces);
        // A search that opens a piece gets on.
        REQUIRE((is_face || place > node));
        for (const std::uint32_t f : faces_under(tree, place, is_face)) faces.push_back(f);
        if (is_face) continue;
        const PatchNode& b = tree.nodes()[place];
        for (std::size_t c = 0; c < 3; ++c) {
          REQUIRE(batch.boxes.center[c][i] == b.center[c]);
          REQUIRE(batch.boxes.half[c][i] == b.half[c]);
          for (std::size_t k = 0; k < 3; ++k) REQUIRE(batch.boxes.edge[k][c][i] == b.axis[k][c]);
        }
      }
      std::vector<std::uint32_t> all = faces_under(tree, node, false);
      std::sort(faces.begin(), faces.end());
      std::sort(all.begin(), all.end());
      REQUIRE(faces == all);
    }
  }
}

TEST_CASE("the first plane over a hull is over it", "[patch]") {
  std::mt19937 rng(9);
  int found = 0;
  for (int round = 0; round < 300; ++round) {
    KnownPlanes planes;
    planes.clear();
    const int count = round % (kCellPlanes + 1);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const Vec3 n = random_in_ball(rng, 1).normalized();
      for (int c = 0; c < 3; ++c) planes.n[static_cast<std::size_t>(c)][k] = n[c];
      planes.low_start[k] = uniform(rng, -0.01, 0.02);
      planes.low_end[k] = uniform(rng, -0.01, 0.02);
    }
    const Hull b = round % 2 == 0 ? random_box(rng, Vec3::Zero(), 0.008)
                                  : Hull::triangle(random_triangle(rng, Vec3::Zero(), 0.008));
    const auto gaps = [&](std::size_t k) {
      double top = -1;
      for (const Vec3& p : corners(b))
        top = std::max(top, planes.n[0][k] * p.x() + planes.n[1][k] * p.y() + planes.n[2][k] * p.z());
      return std::pair(planes.low_start[k] - top, planes.low_end[k] - top);
    };
    std::array<double, kCellPlanes> tops;
    const int k = first_above(planes, count, b, 1e-3, 2e-3, tops);
    for (int i = 0; i < std::min(k, count); ++i) {
      const auto [start, end] = gaps(static_cast<std::size_t>(i));
      REQUIRE((start < 1e-3 + 1e-12 || end < 2e-3 + 1e-12));
    }
    if (k == kCellPlanes) continue;
    ++found;
    const auto i = static_cast<std::size_t>(k);
    const auto [start, end] = gaps(i);
    REQUIRE(start >= 1e-3 - 1e-12);
    REQUIRE(end >= 2e-3 - 1e-12);
    REQUIRE(planes.low_start[i] - tops[i] == Approx(start).margin(1e-12));
  }
  CHECK(found > 100);
}

TEST_CASE("anchored gaps are no larger than the planes' own, wherever the piece has come", "[patch]") {
  std::mt19937 rng(21);
  const auto tree = std::make_shared<PatchTree>(box({0.1, 0.1, 0.1}));
  const Vec3 center(0.03, -0.02, 0.01);
  double tightest = 1;
  for (int round = 0; round < 300; ++round) {
    // A triangle of A (axes of A, from the center of mass), and planes under it.
    const Vec3 at = random_in_ball(rng, 0.1);
    const auto corner = random_triangle(rng, at, 0.005);
    const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3;
    double radius = 0;
    for (const Vec3& p : corner) radius = std::max(radius, (p - middle).norm());
    Pose X{rotation(random_in_ball(rng, 3)), random_in_ball(rng, 0.1)};
    double turned = uniform(rng, 0, 100);
    FreeCell cell;
    const int count = 1 + round % kCellPlanes;
    std::vector<double> offset;
    CellGaps gaps;
    gaps.fill(std::numeric_limits<float>::max());
    const auto sweep_of = [&](const Displacement& d) { return Sweep(X, d, center, *tree, 0.2, 0); };
    const Sweep first = sweep_of({});
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      const Vec3 n = random_in_ball(rng, 1).normalized();
      cell.nx[k] = static_cast<float>(n.x());
      cell.ny[k] = static_cast<float>(n.y());
      cell.nz[k] = static_cast<float>(n.z());
      double low = 1;
      for (const Vec3& p : corner)
        low = std::min(low, cell.normal(static_cast<int>(k)).dot(first.start.R * p + first.start.t));
      gaps[k] = std::pow(10.0, uniform(rng, -6, -3));
      offset.push_back(low - gaps[k]);
    }
    const CellAnchor anchor(gaps, middle, radius, first, turned);
    const auto true_gap = [&](const Mat3& R, const Vec3& t) {
      double least = 1;
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
        for (const Vec3& p : corner)
          least = std::min(least, cell.normal(static_cast<int>(k)).dot(R * p + t) - offset[k]);
      return least;
    };
    for (int i = 0; i < 30; ++i) {
      const double size = std::pow(10.0, uniform(rng, -7, -3));
      const Displacement d{random_in_ball(rng, size), random_in_ball(rng, (i % 3) * 10 * size)};
      const Sweep sweep = sweep_of(d);
      const AnchoredGap g = anchored_gap(cell, anchor, sweep, turned);
      REQUIRE(g.start <= true_gap(sweep.start.R, sweep.start.t));
      REQUIRE(g.end <= true_gap(sweep.end.R, sweep.end.t));
      if (i == 0 && d.dr.isZero(0)) tightest = std::min(tightest, true_gap(sweep.end.R, sweep.end.t) - g.end);
      const Pose end = displaced(X, center, d);
      for (int s = 1; s < 8; ++s) {
        const double u = s / 8.0, line = (1 - u) * g.start + u * g.end - 4 * g.bulge * u * (1 - u);
        const Placement arc = sweep.at(u);
        REQUIRE(line <= true_gap(arc.R, arc.t) + 1e-15);
        // The file frame's origin moves linearly.
        Pose P = displaced(X, center, u * d);
        P.p = X.p + u * (end.p - X.p);
        REQUIRE(line <= true_gap(P.q.toRotationMatrix(), P * center - tree->origin()) + 1e-15);
      }
      X = end;
      turned += d.dr.norm();
    }
  }
  // Nothing but rounding is lost where nothing turns.
  CHECK(tightest < 1e-8);
}

TEST_CASE("a piece is no farther from its corridor than is said, wherever it has come", "[patch]") {
  std::mt19937 rng(23);
  const auto tree = std::make_shared<PatchTree>(box({0.1, 0.1, 0.1}));
  const Vec3 center(0.03, -0.02, 0.01);
  double largest = 0;
  for (int round = 0; round < 300; ++round) {
    const auto corner = random_triangle(rng, random_in_ball(rng, 0.1), 0.005);
    const Vec3 middle = (corner[0] + corner[1] + corner[2]) / 3;
    double radius = 0;
    for (const Vec3& p : corner) radius = std::max(radius, (p - middle).norm());
    Pose X{rotation(random_in_ball(rng, 3)), random_in_ball(rng, 0.1)};
    double turned = uniform(rng, 0, 100);
    const auto sweep_of = [&](const Displacement& d) { return Sweep(X, d, center, *tree, 0.2, 0); };
    const Sweep first = sweep_of({});
    const Vec3 ahead = round % 4 == 0 ? Vec3::Zero().eval() : random_in_ball(rng, 0.002);
    const CellCorridor corridor(middle, radius, ahead, first, turned);
    // From the way on which a point of the piece is shifted, at the farthest.
    const auto off = [&](const Mat3& R, const Vec3& t) {
      double most = 0;
      for (const Vec3& p : corner) {
        const Vec3 moved = R * p + t - (first.start.R * p + first.start.t);
        double least = moved.norm();
        for (int k = 1; k <= 2000 && !ahead.isZero(0); ++k)
          least = std::min(least, (moved - k / 2000.0 * ahead).norm());
        most = std::max(most, least);
      }
      return most;
    };
    const double grid = ahead.norm() / 4000;  // what the points of the way are apart
    for (int i = 0; i < 12; ++i) {
      const double size = std::pow(10.0, uniform(rng, -7, -3));
      const Vec3 along = i % 2 == 0 ? Vec3(uniform(rng, 0, 0.2) * ahead) : random_in_ball(rng, size);
      const Displacement d{along, random_in_ball(rng, (i % 3) * 10 * size)};
      const Sweep sweep = sweep_of(d);
      const CorridorLoss loss = corridor_loss(corridor, sweep, turned);
      REQUIRE(loss.start >= off(sweep.start.R, sweep.start.t) - grid);
      REQUIRE(loss.end >= off(sweep.end.R, sweep.end.t) - grid);
      const Pose end = displaced(X, center, d);
      for (int s = 1; s < 4; ++s) {
        const double u = s / 4.0, line = (1 - u) * loss.start + u * loss.end + 4 * loss.bulge * u * (1 - u);
        const Placement arc = sweep.at(u);
        REQUIRE(line >= off(arc.R, arc.t) - grid);
        Pose P = displaced(X, center, u * d);
        P.p = X.p + u * (end.p - X.p);
        REQUIRE(line >= off(P.q.toRotationMatrix(), P * center - tree->origin()) - grid);
      }
      X = end;
      turned += d.dr.norm();
    }
    largest = std::max(largest, corridor_loss(corridor, sweep_of({}), turned).start);
  }
  CHECK(largest > 1e-4);
}

TEST_CASE("a piece that goes along its corridor loses nothing", "[patch]") {
  std::mt19937 rng(24);
  const auto tree = std::make_shared<PatchTree>(box({0.1, 0.1, 0.1}));
  for (int round = 0; round < 100; ++round) {
    const Pose X{rotation(random_in_ball(rng, 3)), random_in_ball(rng, 0.1)};
    const Vec3 ahead = random_in_ball(rng, 0.01);
    const CellCorridor corridor(random_in_ball(rng, 0.1), 0.005, ahead, Sweep(X, {}, Vec3::Zero(), *tree, 0.2, 0), 0);
    const CorridorLoss loss =
        corridor_loss(corridor, Sweep(X, {uniform(rng, 0, 1) * ahead, Vec3::Zero()}, Vec3::Zero(), *tree, 0.2, 0), 0);
    REQUIRE(loss.start < 1e-10);
    REQUIRE(loss.end < 1e-10);
  }
}

TEST_CASE("a search that begins with a list looks at all of it", "[patch]") {
  // Nine faces are near by the list and are not; the tenth stands in the way.
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "faces";
  const auto add = [&](const Vec3& at) {
    const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
    for (const Vec3& v : {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0)}) mesh->vertices.push_back(at + v);
    mesh->triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < 9; ++i) add(Vec3(0.1 + 0.02 * i, 0, 0));
  add(Vec3(0, 0, 0));
  const PatchTree tree(mesh);
  const PatchBatches batches(tree);
  const std::array<Vec3, 3> face = {Vec3(0.002, 0.002, -0.001), Vec3(0.003, 0.002, 0.001), Vec3(0.002, 0.003, 0.001)};
  std::array<Vec3, 3> moved = face;
  for (Vec3& v : moved) v -= tree.origin();
  MovingHull a;
  a.start = a.end = Hull::triangle(moved);
  a.reach = a.radius = a.width = 0.005;
  const Sweep sweep(Pose{}, {}, Vec3::Zero(), tree, 0.01, 0);
  CellItems known;
  known.clear = 1;
  for (std::uint32_t f = 0; f < 10; ++f) {
    known.item[known.count] = f | CellItems::kFace;
    known.distance[known.count++] = f < 9 ? -1.0f : 0.0f;
  }
  CellSearch search;
  FreeCell cell;
  CHECK(search.find(a, &face, {&tree, &batches, 0, false, 0.005, &known, 0}, sweep, cell) ==
        CellSearch::Outcome::blocked);
  REQUIRE(search.blocking().size() == 1);
  CHECK(search.blocking()[0] == 9);
}
