// Axes that the meshes are made about, found again from their triangles.
#include <algorithm>
#include <cmath>
#include <random>

#include "catch.hpp"
#include "core/numbers.hpp"
#include "curve/axis_search.hpp"
#include "models/gear.hpp"
#include "models/height_field.hpp"
#include "models/revolved.hpp"
#include "models/shapes.hpp"
#include "models/threaded.hpp"
#include "thread_families.hpp"

using namespace tegotae;
using namespace tegotae::test;
using namespace tegotae::shapes;

namespace {

TriangleMesh placed(TriangleMesh mesh, const Pose& X) {
  for (Vec3& v : mesh.vertices) v = X * v;
  return mesh;
}

TriangleMesh together(const std::vector<TriangleMesh>& parts) {
  TriangleMesh all;
  for (const TriangleMesh& m : parts) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), m.vertices.begin(), m.vertices.end());
    for (const auto& t : m.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

TriangleMesh noisy(TriangleMesh mesh, double sigma) {
  std::mt19937 rng(3);
  std::normal_distribution<double> noise(0, sigma);
  for (Vec3& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) v[i] += noise(rng);
  return mesh;
}

/// Where the mesh's own z axis lies after `X`, seen from a found axis: angle (rad) and distance (m) at `middle`.
struct Off {
  double angle, distance, pitch;
};
Off off(const ScrewAxis& found, const Pose& X, const Vec3& point = Vec3::Zero()) {
  const Vec3 z = X.q * Vec3::UnitZ(), p = X * point;
  return {std::asin(std::min(1.0, z.cross(found.direction).norm())), (p - found.origin).cross(found.direction).norm(),
          2 * kPi * found.rise};
}

const Pose kSomewhere{rotation(Vec3(0.7, -0.4, 1.1)), Vec3(0.03, -0.2, 0.11)};

struct Expected {
  const char* name;
  TriangleMesh mesh;
  double pitch, angle, distance, pitch_error;
};

std::vector<Expected> one_axis() {
  Bolt left;
  left.thread.left_hand = true;
  Nut fine;
  fine.thread.pitch = 0.001;
  fine.play = 5e-5;
  Bolt small;
  small.thread = {0.006, 0.001, false, 48, 2};
  small.head_width = 0.010;
  small.chamfer = 0.0005;
  Peg peg_of_few;
  peg_of_few.segments = 24;
  const std::vector<ProfilePoint> cone = {{0, 0}, {0.012, 0}, {0.004, 0.03}, {0, 0.03}};
  return {{"bolt", bolt({}), 0.002, 1e-3, 2e-5, 0.02},
          {"left-hand bolt", bolt(left), -0.002, 1e-3, 2e-5, 0.02},
          {"small bolt", bolt(small), 0.001, 5e-3, 5e-5, 0.05},
          {"nut", nut({}), 0.002, 3e-3, 5e-5, 0.05},
          {"fine nut", nut(fine), 0.001, 3e-3, 5e-5, 0.08},
          {"peg", peg({}), 0, 1e-6, 1e-7, 0},
          {"peg of 24 segments", peg(peg_of_few), 0, 1e-3, 1e-5, 0},
          {"cone", revolved("cone", cone, 64), 0, 1e-3, 1e-5, 0},
          {"bore", block_with_hole({}), 0, 1e-6, 1e-7, 0},
          {"gear", gear({}), 0, 1e-3, 1e-5, 0},
          {"socket", socket({}), 0, 1e-3, 1e-5, 0},
          {"rough bolt, 2 um", noisy(bolt({}), 2e-6), 0.002, 2e-3, 3e-5, 0.02},
          {"rough bolt, 5 um", noisy(bolt({}), 5e-6), 0.002, 4e-3, 5e-5, 0.05},
          {"rough peg, 5 um", noisy(peg({}), 5e-6), 0, 2e-3, 2e-5, 0},
          {"rough bore, 5 um", noisy(block_with_hole({}), 5e-6), 0, 2e-3, 2e-5, 0}};
}

}  // namespace

TEST_CASE("the axis and the pitch of a part are found wherever it lies", "[curve]") {
  for (const Expected& e : one_axis()) {
    for (const Pose& X : {Pose{}, kSomewhere}) {
      CAPTURE(e.name, X.p.x());
      const auto axes = find_axes(placed(e.mesh, X));
      REQUIRE(!axes.empty());
      // The one of most surface.
      const Off o = off(axes[0], X);
      CAPTURE(o.angle, o.distance, o.pitch);
      CHECK(o.angle < e.angle);
      CHECK(o.distance < e.distance + 0.04 * e.angle);
      if (e.pitch == 0)
        CHECK(o.pitch == 0);
      else
        CHECK(o.pitch == Approx(e.pitch).epsilon(e.pitch_error));
    }
  }
}

TEST_CASE("the order of faces and vertices does not matter, to the last bit", "[curve]") {
  Peg fine;
  fine.segments = 160;
  fine.rings = 100;  // sampled
  for (const TriangleMesh& mesh : {placed(bolt({}), kSomewhere), placed(peg(fine), kSomewhere)}) {
    std::mt19937 rng(11);
    TriangleMesh other = mesh;
    std::vector<std::uint32_t> number(mesh.vertices.size());
    for (std::uint32_t i = 0; i < number.size(); ++i) number[i] = i;
    std::shuffle(number.begin(), number.end(), rng);
    for (std::size_t i = 0; i < number.size(); ++i) other.vertices[number[i]] = mesh.vertices[i];
    for (auto& t : other.triangles) {
      for (std::uint32_t& v : t) v = number[v];
      std::rotate(t.begin(), t.begin() + rng() % 3, t.end());
    }
    std::shuffle(other.triangles.begin(), other.triangles.end(), rng);
    other.name = "another name";
    const auto a = find_axes(mesh), b = find_axes(other);
    REQUIRE(!a.empty());
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      CHECK(a[i].origin == b[i].origin);
      CHECK(a[i].direction == b[i].direction);
      CHECK(a[i].rise == b[i].rise);
    }
  }
}

TEST_CASE("dirty meshes have their axes", "[curve]") {
  // A soup of separate triangles, some of them gone, turned over, repeated, without an area.
  const TriangleMesh clean = placed(bolt({}), kSomewhere);
  std::mt19937 rng(5);
  TriangleMesh soup;
  for (const auto& t : clean.triangles) {
    if (rng() % 5 == 0) continue;
    for (unsigned copies = 1 + (rng() % 10 == 0); copies > 0; --copies) {
      const auto first = static_cast<std::uint32_t>(soup.vertices.size());
      for (const std::uint32_t v : t) soup.vertices.push_back(clean.vertices[v]);
      if (rng() % 3 == 0)
        soup.triangles.push_back({first, first + 2, first + 1});
      else
        soup.triangles.push_back({first, first + 1, first + 2});
      if (rng() % 7 == 0) soup.triangles.push_back({first, first, first + 1});
    }
  }
  const auto axes = find_axes(soup);
  REQUIRE(!axes.empty());
  const Off o = off(axes[0], kSomewhere);
  CHECK(o.angle < 2e-3);
  CHECK(o.distance < 1e-4);
  CHECK(o.pitch == Approx(0.002).epsilon(0.03));
}

TEST_CASE("parts without a surface that turns have no axis", "[curve]") {
  CHECK(find_axes(box({0.04, 0.03, 0.02})).empty());
  CHECK(find_axes(box({0.04, 0.03, 0.02}, {9, 7, 5})).empty());
  CHECK(find_axes(placed(box({0.02, 0.02, 0.02}, {6, 6, 6}), kSomewhere)).empty());
  CHECK(find_axes(sheet({0.3, 0.3, 40, 40}, waves(0.003, 0.1))).empty());
  CHECK(find_axes(slab(
                      {0.1, 0.1, 20, 20}, [](double, double) { return 0.0; },
                      [](double x, double y) { return 0.01 + 0.5 * x * y; }))
            .empty());
  CHECK(find_axes(sphere(0.04, 64, 33)).empty());  // all axes through its center are alike
  CHECK(find_axes(torus_knot({})).empty());
  Knot fine;
  fine.along = 893;
  fine.around = 56;
  CHECK(find_axes(torus_knot(fine)).empty());
  CHECK(find_axes(TriangleMesh{}).empty());
}

TEST_CASE("a part with several axes has them all", "[curve]") {
  const Pose first{rotation(Vec3(0, 0, 0)), Vec3(0.1, 0, 0)}, second{rotation(Vec3(1.2, 0, 0)), Vec3(0, 0.1, 0)},
      third{rotation(Vec3(0, 0.8, 0.3)), Vec3(-0.1, 0, 0.02)};
  Nut n;
  n.thread.left_hand = true;
  const TriangleMesh mesh = together({placed(peg({}), first), placed(bolt({}), second), placed(nut(n), third)});
  const auto axes = find_axes(mesh);
  const Pose poses[] = {first, second, third};
  const double pitches[] = {0, 0.002, -0.002};
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(std::any_of(axes.begin(), axes.end(), [&](const ScrewAxis& a) {
      const Off o = off(a, poses[i]);
      return o.angle < 5e-3 && o.distance < 2e-4 && std::abs(o.pitch - pitches[i]) < 1e-4;
    }));
  }
}

namespace {

/// Whether one of the first axes is the thread's, and its rise over what it should be.
bool knows_thread(const TriangleMesh& mesh, const Pose& X, double scale, double lead, double& ratio) {
  const auto axes = find_axes(mesh);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, axes.size()); ++i) {
    const Off o = off(axes[i], X);
    if (o.angle > 5e-3 || o.distance > 1e-4 * scale || std::abs(o.pitch / scale / lead - 1) > 0.02) continue;
    ratio = o.pitch / scale / lead;
    return true;
  }
  return false;
}

/// Threads of any kind, in any place, order and size, clean and dirty: how many of `count` pairs are known on both
/// sides.
void check_families(unsigned seed, int count) {
  test::ThreadFamily family(seed);
  int missed = 0, unlike = 0;
  for (int i = 0; i < count; ++i) {
    const test::ThreadedPair pair = family.next();
    const bool dirty = family.one_in(3);
    double ratio[2] = {0, 0};
    int side = 0;
    for (const TriangleMesh* part : {&pair.screw, &pair.nut}) {
      TriangleMesh mesh = dirty ? family.soiled(*part) : family.shuffled(*part);
      const double scale = std::pow(10.0, family.between(-1.5, 2.0));
      const Vec3 turn = family.vector(2);
      const Pose X{rotation(turn), family.vector(0.1)};
      for (Vec3& v : mesh.vertices) v = X * Vec3(scale * v);
      const bool known = knows_thread(mesh, X, scale, pair.lead, ratio[side]);
      if (!known) UNSCOPED_INFO((side == 0 ? "screw: " : "nut: ") << pair.what << (dirty ? ", dirty" : ""));
      missed += !known;
      ++side;
    }
    unlike += ratio[0] != 0 && ratio[1] != 0 && std::abs(ratio[0] / ratio[1] - 1) > 0.01;
  }
  // What is missed is certified by planes alone, which is slower.
  CHECK(100 * missed <= 2 * 2 * count);
  CHECK(100 * unlike <= count);
}

}  // namespace

TEST_CASE("threads of any family are known from their triangles", "[curve]") {
  check_families(1, 30);
}
TEST_CASE("threads of any family are known from their triangles, at length", "[.long]") {
  check_families(2, 2000);
}
