// Leaving motions: which surfaces bound a solid, and motions that are certified by normals against sampled poses.
#include <algorithm>
#include <functional>
#include <map>

#include "alloc_guard.hpp"
#include "catch.hpp"
#include "models/shapes.hpp"
#include "narrowphase/facing.hpp"
#include "narrowphase/leaving.hpp"
#include "narrowphase/patch_motion_check.hpp"
#include "patch_oracle.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

constexpr double kSize = 0.02, kClearance = 1.1e-6;

Vec3 direction(std::mt19937& rng) {
  std::normal_distribution<double> normal;
  return Vec3(normal(rng), normal(rng), normal(rng)).normalized();
}

/// A grid that closes in the second direction, and in the first one or in a point at both ends.
MeshPtr tube(int n, int m, bool ring, const std::function<Vec3(int, int)>& at) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "tube";
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) mesh->vertices.push_back(at(i, k));
  const auto v = [&](int i, int k) { return static_cast<std::uint32_t>(i % n * m + k % m); };
  for (int i = 0; i < (ring ? n : n - 1); ++i)
    for (int k = 0; k < m; ++k) {
      mesh->triangles.push_back({v(i, k), v(i, k + 1), v(i + 1, k + 1)});
      mesh->triangles.push_back({v(i, k), v(i + 1, k + 1), v(i + 1, k)});
    }
  if (ring) return mesh;
  for (const int end : {0, n - 1}) {
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < m; ++k) middle += mesh->vertices[v(end, k)] / m;
    const auto tip = static_cast<std::uint32_t>(mesh->vertices.size());
    mesh->vertices.push_back(middle);
    for (int k = 0; k < m; ++k)
      mesh->triangles.push_back(end == 0 ? std::array<std::uint32_t, 3>{tip, v(0, k + 1), v(0, k)}
                                         : std::array<std::uint32_t, 3>{tip, v(end, k), v(end, k + 1)});
  }
  return mesh;
}

/// A ball with bumps and dents up to `depth` of its radius.
MeshPtr star(unsigned seed, double depth, int n) {
  std::mt19937 rng(seed);
  std::map<std::pair<int, int>, double> radius;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 2 * n; ++k) radius[{i, k}] = kSize / 2 * (1 - depth * uniform(rng, 0, 1));
  return tube(n, 2 * n, false, [&](int i, int k) -> Vec3 {
    const double u = kPi * (i + 0.5) / n, w = kPi * k / n;
    return radius[{i, k}] * Vec3(std::sin(u) * std::cos(w), std::sin(u) * std::sin(w), -std::cos(u));
  });
}

MeshPtr torus(int n, int m) {
  return tube(n, m, true, [=](int i, int k) -> Vec3 {
    const double u = 2 * kPi * i / n, w = -2 * kPi * k / m, r = 0.35 * kSize + 0.12 * kSize * std::cos(w);
    return {r * std::cos(u), r * std::sin(u), 0.12 * kSize * std::sin(w)};
  });
}

/// A rod with a coarse thread.
MeshPtr threaded() {
  return tube(25, 24, false, [](int i, int k) -> Vec3 {
    const double w = 2 * kPi * k / 24, turn = 4 * i / 24.0 - k / 24.0;
    const double r = kSize * (0.25 + 0.1 * std::abs(turn - std::round(turn)));
    return {r * std::cos(w), r * std::sin(w), kSize * (i / 24.0 - 0.5)};
  });
}

/// A slab with waves on both sides.
MeshPtr slab(double height, double waves, int n) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "slab";
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i <= n; ++i)
      for (int k = 0; k <= n; ++k) {
        const double x = kSize * (1.0 * i / n - 0.5), y = kSize * (1.0 * k / n - 0.5);
        mesh->vertices.emplace_back(
            x, y, height * std::sin(waves * x / kSize) * std::cos(waves * y / kSize) + (side - 0.5) * 0.2 * kSize);
      }
  const auto v = [&](int side, int i, int k) { return static_cast<std::uint32_t>((side * (n + 1) + i) * (n + 1) + k); };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh->triangles.push_back({a, b, c});
    mesh->triangles.push_back({a, c, d});
  };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      quad(v(1, i, k), v(1, i + 1, k), v(1, i + 1, k + 1), v(1, i, k + 1));
      quad(v(0, i, k), v(0, i, k + 1), v(0, i + 1, k + 1), v(0, i + 1, k));
    }
    quad(v(0, i, 0), v(0, i + 1, 0), v(1, i + 1, 0), v(1, i, 0));
    quad(v(0, i + 1, n), v(0, i, n), v(1, i, n), v(1, i + 1, n));
    quad(v(0, 0, i + 1), v(0, 0, i), v(1, 0, i), v(1, 0, i + 1));
    quad(v(0, n, i), v(0, n, i + 1), v(1, n, i + 1), v(1, n, i));
  }
  return mesh;
}

MeshPtr turned_inside_out(const TriangleMesh& mesh) {
  auto out = std::make_shared<TriangleMesh>(mesh);
  for (auto& t : out->triangles) std::swap(t[0], t[1]);
  return out;
}

MeshPtr both(const TriangleMesh& a, const TriangleMesh& b, const Pose& pose) {
  auto out = std::make_shared<TriangleMesh>(a);
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  for (const Vec3& v : b.vertices) out->vertices.push_back(pose * v);
  for (const auto& t : b.triangles) out->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return out;
}

MeshPtr without_face(const TriangleMesh& mesh, std::size_t face) {
  auto out = std::make_shared<TriangleMesh>(mesh);
  out->triangles.erase(out->triangles.begin() + static_cast<std::ptrdiff_t>(face));
  return out;
}

/// A prism over a bow-tie, whose smaller lobe is inside out: closed, manifold, of positive volume.
MeshPtr bow_tie() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->name = "bow-tie";
  const std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d(0, 0), Eigen::Vector2d(3, 2), Eigen::Vector2d(3, 0),
                                                  Eigen::Vector2d(0, 1)};
  for (const double z : {0.0, 1.0})
    for (const auto& c : corners) mesh->vertices.emplace_back(0.005 * c.x(), 0.005 * c.y(), 0.005 * z);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t k = (i + 1) % 4;
    mesh->triangles.push_back({i, i + 4, k});
    mesh->triangles.push_back({k, i + 4, k + 4});
  }
  mesh->triangles.insert(mesh->triangles.end(), {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}});
  return mesh;
}

std::shared_ptr<const Facing> facing_of(const MeshPtr& mesh) {
  return Facing::of(mesh, std::make_shared<const PatchTree>(mesh));
}

std::vector<MeshPtr> bodies() {
  // The shared shapes of hole and knot look inwards.
  const MeshPtr cup = turned_inside_out(*hole(0.0045, 0.02, 600)),
                string = turned_inside_out(*knot(0.012, 0.0012, 900));
  return {box({0.01, 0.006, 0.004}),
          box({0.012, 0.012, 0.001}),
          peg(0.004, 0.02, 300),
          cup,
          star(1, 0.1, 8),
          star(2, 0.5, 9),
          star(3, 0.9, 7),
          torus(24, 12),
          slab(0.02 * kSize, 12.0, 12),
          slab(0.1 * kSize, 9.0, 10),
          string,
          threaded()};
}

/// How often the surface winds round `p`: the sum of the solid angles of its faces (van Oosterom and Strackee 1983).
double windings(const TriangleMesh& mesh, const Vec3& p) {
  double angle = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - p, b = mesh.vertices[t[1]] - p, c = mesh.vertices[t[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * kPi);
}

/// Two bodies and the certificate between them.
struct Couple {
  MeshPtr a, b;
  std::shared_ptr<const PatchTree> tree_a, tree_b;
  std::shared_ptr<const Facing> facing_a, facing_b;
  Oracle oracle;
  Vec3 center;
  double reach = 0;
  LeavingCheck check;

  Couple(const MeshPtr& held, const MeshPtr& fixed, const Vec3& held_center)
      : a(held),
        b(fixed),
        tree_a(std::make_shared<const PatchTree>(held)),
        tree_b(std::make_shared<const PatchTree>(fixed)),
        facing_a(Facing::of(held, tree_a)),
        facing_b(Facing::of(fixed, tree_b)),
        oracle(held, fixed),
        center(held_center) {
    for (const Vec3& v : a->vertices) reach = std::max(reach, (v - center).norm());
  }
  /// A start at a gap of about `gap` somewhere around B, coming from `from`.
  bool place(const Vec3& from, const Quat& q, double gap, Pose& X) const {
    const auto at = [&](double s) { return Pose{q, s * from}; };
    double far = 0.1, near = 0;
    if (oracle.meet(at(far))) return false;
    for (int k = 0; k < 50 && oracle.distance(at(far)) > 1.5 * gap; ++k) {
      // No farther than the distance: nothing is passed over.
      const double s = far - std::min(0.9 * oracle.distance(at(far)), far - near);
      if (oracle.meet(at(s))) break;
      far = s;
    }
    X = at(far);
    return oracle.distance(X) > 0.2 * gap && windings(*b, X * a->vertices[0]) < 0.5;
  }
  bool leaves(const Pose& X, const Displacement& d, double clearance, int most = LeavingCheck::kMostVisits,
              std::int64_t deadline_ns = kNoDeadline) {
    const Sweep sweep(X, d, center, *tree_b, reach, clearance);
    return check.leaves({tree_a.get(), facing_a.get()}, center, {tree_b.get(), facing_b.get()}, sweep, most,
                        deadline_ns);
  }
};

/// Asks about random motions from X, more of them to the side of `from`; every one that is certified is looked at by
/// both readings of its path. Returns how many were.
int judge_at(Couple& c, std::mt19937& rng, const Pose& X, const Vec3& from, int motions, int poses) {
  int accepted = 0;
  const double at_start = c.oracle.distance(X);
  for (int k = 0; k < motions; ++k) {
    const double length = kSize * std::pow(10.0, uniform(rng, -4, 0));
    Displacement d{length * (from + uniform(rng, 0, 1.2) * direction(rng)), Vec3::Zero()};
    if (k % 3 > 0) d.dr = std::pow(10.0, uniform(rng, -4, 0)) * length / kSize * (k % 3) * direction(rng);
    if (!c.leaves(X, d, kClearance)) continue;
    ++accepted;
    // A part of the pairs is not enough, and no pair is looked at for long after the deadline.
    const int pairs = c.check.visits();
    CHECK(c.leaves(X, d, kClearance, pairs));
    CHECK_FALSE(c.leaves(X, d, kClearance, pairs - 1));
    CHECK(c.leaves(X, d, kClearance, pairs, 1) == (pairs < 64));
    CHECK(c.oracle.hits(X, c.center, d, poses) == 0);
    if (k % 8 == 0)
      CHECK(c.oracle.path_distance(X, c.center, d, poses) >= std::min(at_start, kClearance) * (1 - 1e-3) - 1e-9);
  }
  return accepted;
}

int judge(Couple& c, std::mt19937& rng, int starts, int motions, int poses) {
  int accepted = 0;
  for (int i = 0; i < starts; ++i) {
    const Vec3 from = direction(rng);
    const Quat q = rotation(kPi * uniform(rng, 0, 1) * direction(rng));
    Pose X;
    if (c.place(from, q, std::pow(10.0, uniform(rng, -6, -3)), X))
      accepted += judge_at(c, rng, X, from, motions, poses);
  }
  return accepted;
}

/// From poses in which the bodies mate: a slab on one of the same shape, a peg in its hole.
int judge_mated(std::mt19937& rng, int starts, int motions, int poses) {
  const MeshPtr wavy = slab(0.05 * kSize, 9.0, 16), cup = turned_inside_out(*hole(0.0045, 0.02, 600));
  Couple slabs(wavy, wavy, {0.001, -0.002, 0.003}), fit(peg(0.00445, 0.02, 300), cup, {0, 0, 0.01});
  int accepted = 0;
  for (int i = 0; i < starts; ++i) {
    const double gap = std::pow(10.0, uniform(rng, -6, -3.5));
    accepted += judge_at(slabs, rng, {Quat::Identity(), {0, 0, 0.2 * kSize + gap}}, Vec3::UnitZ(), motions, poses);
    accepted += judge_at(fit, rng, {Quat::Identity(), {0, 0, gap - 0.02}}, Vec3::UnitZ(), motions, poses);
  }
  return accepted;
}

int judge_all(unsigned seed, int starts, int motions, int poses) {
  std::mt19937 rng(seed);
  int accepted = judge_mated(rng, 5 * starts, motions, poses);
  const std::vector<MeshPtr> all = bodies();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < all.size(); ++k) {
      Couple c(all[i], all[k], kSize * uniform(rng, 0, 1) * direction(rng));
      CAPTURE(i, k);
      accepted += judge(c, rng, starts, motions, poses);
    }
  return accepted;
}

/// A drum whose ends are fans about a corner of their rim.
MeshPtr rim_fans(std::uint32_t n) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (const double z : {0.0, 0.01})
    for (std::uint32_t i = 0; i < n; ++i)
      mesh->vertices.push_back({0.02 * std::cos(2 * kPi * i / n), 0.02 * std::sin(2 * kPi * i / n), z});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t k = (i + 1) % n;
    mesh->triangles.push_back({i, k, n + k});
    mesh->triangles.push_back({i, n + k, n + i});
    if (i == 0 || i + 1 == n) continue;
    mesh->triangles.push_back({0, k, i});
    mesh->triangles.push_back({n, n + i, n + k});
  }
  return mesh;
}

}  // namespace

TEST_CASE("a surface bounds a solid only where there is no doubt") {
  const auto all = bodies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(i);
    CHECK(windings(*all[i], all[i]->vertices[0] + 1e3 * Vec3::UnitX()) == Approx(0).margin(1e-6));
    CHECK(facing_of(all[i]));
    CHECK_FALSE(facing_of(turned_inside_out(*all[i])));
    CHECK_FALSE(facing_of(without_face(*all[i], i)));
  }
  const MeshPtr large = box({0.01, 0.01, 0.01}), small = box({0.004, 0.004, 0.004});
  const Pose same, beside{Quat::Identity(), {0.03, 0, 0}}, across{Quat::Identity(), {0.01, 0.001, 0.002}};
  CHECK_FALSE(facing_of(bow_tie()));
  CHECK_FALSE(facing_of(turned_inside_out(*bow_tie())));
  CHECK(facing_of(both(*large, *small, beside)));
  CHECK_FALSE(facing_of(both(*large, *small, across)));                            // walls cross
  CHECK_FALSE(facing_of(both(*large, *turned_inside_out(*small), beside)));        // one inside out
  CHECK_FALSE(facing_of(both(*large, *turned_inside_out(*small), same)));          // a cavity
  CHECK_FALSE(facing_of(both(*large, *small, same)));                              // a body in a body
  CHECK_FALSE(facing_of(both(*large, *large, {Quat::Identity(), {0.02, 0, 0}})));  // walls touch
  CHECK_FALSE(facing_of(both(*large, *large, same)));                              // twice the same
  // Two boxes over one edge, which then has four faces.
  auto edge = std::make_shared<TriangleMesh>(*both(*large, *large, {Quat::Identity(), {0.02, 0.02, 0}}));
  for (auto& t : edge->triangles)
    for (auto& v : t) v = v == 8 ? 3 : v == 12 ? 7 : v;
  CHECK_FALSE(facing_of(edge));
  // A dent that comes out on the other side.
  auto through = std::make_shared<TriangleMesh>(*star(4, 0.1, 8));
  through->vertices[50] *= -1.5;
  CHECK_FALSE(facing_of(through));
}

TEST_CASE("fans of needles bound solids where nothing comes through them") {
  // Each needle looked at against all of its fan would take minutes.
  CHECK(facing_of(std::make_shared<const TriangleMesh>(shapes::cylinder(0.02, 0.01, 60000))));
  const auto drum = std::make_shared<const TriangleMesh>(shapes::cylinder(0.02, 0.01, 3000));
  const MeshPtr small = box({0.001, 0.001, 0.001});
  CHECK(facing_of(both(*drum, *small, {Quat::Identity(), {0.004, 0.003, 0.0062}})));
  CHECK_FALSE(facing_of(both(*drum, *small, {Quat::Identity(), {0.004, 0.003, 0.005}})));  // through one fan
  // A corner of a wall of the drum pulled through the other fan.
  auto pulled = std::make_shared<TriangleMesh>(*drum);
  const auto rim = std::max_element(pulled->vertices.begin(), pulled->vertices.end(), [](const Vec3& a, const Vec3& b) {
    return a.z() + 0.1 * a.x() < b.z() + 0.1 * b.x();
  });
  rim->x() *= 0.5;
  rim->z() = -0.006;
  CHECK_FALSE(facing_of(pulled));
  // Fans about a corner of the rim, where walls meet them; and one of their needles folded back over the others.
  CHECK(facing_of(rim_fans(3000)));
  auto folded = std::make_shared<TriangleMesh>(*rim_fans(3000));
  std::swap(folded->vertices[1000], folded->vertices[1010]);
  CHECK_FALSE(facing_of(folded));
}

TEST_CASE("points are outside where nothing winds round them") {
  std::mt19937 rng(3);
  int inside = 0;
  for (const MeshPtr& mesh : bodies()) {
    const auto facing = facing_of(mesh);
    REQUIRE(facing);
    for (int i = 0; i < 400; ++i) {
      const Vec3 p = 0.6 * kSize * std::cbrt(uniform(rng, 0, 1)) * direction(rng);
      const double w = windings(*mesh, p);
      inside += w > 0.5;
      CHECK(facing->outside(p) == (w < 0.5));
    }
  }
  CHECK(inside > 500);
}

TEST_CASE("certified leaving motions meet nothing") {
  CHECK(judge_all(1, 2, 20, 12) > 1000);
}

TEST_CASE("the path along which the origin of the file goes straight is covered") {
  std::mt19937 rng(5);
  int free = 0;
  const int tries = 300;
  for (int i = 0; i < tries; ++i) {
    // A block a meter from that origin rises by less than its path arches down, or by a little more.
    auto far = std::make_shared<TriangleMesh>(*box({0.0002, 0.0002, 0.0002}));
    for (Vec3& v : far->vertices) v.z() -= 1;
    Couple c(far, box({0.01, 0.01, 0.01}), {0, 0, -1});
    const double turn = uniform(rng, 0.02, 0.1);
    const Pose X{Quat::Identity(), {0, 0, 1.0102 + 2e-6}};
    const Displacement d{{0, 0, 0.5 * uniform(rng, 0.1, 1.3) * turn * turn}, {0, turn, 0}};
    if (!c.leaves(X, d, kClearance)) continue;
    ++free;
    CHECK(c.oracle.hits(X, c.center, d, 24) == 0);
  }
  CHECK((free > tries / 20 && free < tries / 2));
}

TEST_CASE("a part that leaves many others need not be clear of them at the start, but outside") {
  // 36 posts side by side and a case around all of them, which is a solid block for who looks at its faces.
  std::vector<MeshPtr> mesh(36, box({0.001, 0.001, 0.002}));
  std::vector<Pose> pose;
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i <= 36; ++i) {
    pose.push_back({Quat::Identity(), {0.003 * (i % 6) - 0.0075, 0.003 * (i / 6) - 0.0075, -0.002}});
    near.push_back(i);
  }
  mesh.push_back(box({0.03, 0.03, 0.01}));
  pose.back() = Pose{};
  const MeshPtr lid = box({0.01, 0.01, 0.0005});
  PatchMotionCheck check(lid, Vec3::Zero(), 0.0142, mesh, pose, {});
  std::vector<FacePair> blocking;
  blocking.reserve(64);
  const double gap = 0.5e-6;  // below what motions keep
  const Displacement up{{1e-5, 0, 1e-4}, {1e-4, 0, 0}};
  const auto ask = [&](const Pose& X, bool trusted) {
    check.begin(near, kNoDeadline, OtherParts::far);
    if (trusted) check.trust_start();
    blocking.clear();
    const AllocGuard guard;
    const MotionAnswer answer = check.check(X, up, kClearance, blocking);
    CHECK(guard.count() == 0);
    return answer;
  };
  const Pose over_posts{Quat::Identity(), {0, 0, 0.0005 + gap}}, over_case{Quat::Identity(), {0, 0, 0.0105 + gap}},
      under_lid{Quat::Identity(), {0, 0, 0.0095 - gap}};
  CHECK(ask(over_posts, false) != MotionAnswer::free);
  CHECK(ask(over_posts, true) == MotionAnswer::free);
  CHECK(check.free_share() == 1);
  check.jumped();
  CHECK(ask(over_case, false) != MotionAnswer::free);
  CHECK(ask(over_case, true) == MotionAnswer::free);
  // In the case the faces over the lid look away from it as well.
  check.jumped();
  CHECK(ask(under_lid, true) != MotionAnswer::free);
  // What may be left out may overlap, so nothing is concluded from its faces.
  PatchMotionCheck without(lid, Vec3::Zero(), 0.0142, mesh, pose, {0});
  without.begin(near, kNoDeadline, OtherParts::far);
  without.trust_start();
  blocking.clear();
  CHECK(without.check(over_posts, up, kClearance, blocking) != MotionAnswer::free);
}

TEST_CASE("certified leaving motions meet nothing, at length", "[.long]") {
  CHECK(judge_all(2, 60, 60, 24) > 100000);
}
