// Starts at gaps of a nanometer to two micrometers, features exactly in line: leaving must be possible, going in must
// not.
#include <cmath>

#include "bodies.hpp"
#include "catch.hpp"
#include "path_oracle.hpp"
#include "tegotae/loop/haptic_loop.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

struct Start {
  TriangleMesh below;  ///< its highest point at z = 0
  TriangleMesh held;
  Quat q;  ///< of the held body, whose lowest point is `drop` under its frame's origin
  double drop;
};

constexpr double kSide = 0.02;

TriangleMesh octahedron(double r) {
  TriangleMesh mesh;
  mesh.vertices = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// A prism along x (or y) with an edge up and an edge down.
TriangleMesh roof(bool along_x) {
  TriangleMesh mesh = box({kSide, kSide, kSide});
  const Eigen::AngleAxisd turn(M_PI / 4, along_x ? Vec3::UnitX() : Vec3::UnitY());
  const double r = std::sqrt(0.5) * kSide;
  for (Vec3& v : mesh.vertices) {
    v = turn * v;
    // The turned corners exactly in line.
    for (int k = 0; k < 3; ++k) {
      if (std::abs(v[k]) < 1e-9) v[k] = 0;
      if (std::abs(std::abs(v[k]) - r) < 1e-9) v[k] = std::copysign(r, v[k]);
    }
  }
  return mesh;
}

TriangleMesh lowered(TriangleMesh mesh, double by) {
  for (Vec3& v : mesh.vertices) v.z() -= by;
  return mesh;
}

Start start(const std::string& kind) {
  const double half = 0.5 * kSide, r = std::sqrt(0.5) * kSide;
  const TriangleMesh cube = box({kSide, kSide, kSide});
  if (kind == "vertex on vertex") return {lowered(octahedron(half), half), octahedron(half), Quat::Identity(), half};
  if (kind == "edge across edge") return {lowered(roof(true), r), roof(false), Quat::Identity(), r};
  if (kind == "edge along edge") return {lowered(roof(true), r), roof(true), Quat::Identity(), r};
  if (kind == "vertex on face") return {lowered(cube, half), octahedron(half), Quat::Identity(), half};
  if (kind == "edge on face") return {lowered(cube, half), roof(true), Quat::Identity(), r};
  if (kind == "face on face") return {lowered(cube, half), cube, Quat::Identity(), half};
  // Near coplanar: lower at one edge by 1e-6 rad.
  const double tilt = 1e-6;
  return {lowered(cube, half), cube, Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY())),
          half * (std::cos(tilt) + std::sin(tilt))};
}

}  // namespace

TEST_CASE("from nearly touching, exactly aligned starts the way out is open and the way in is shut", "[tunnelling]") {
  const std::string resolver = GENERATE("lp", "qp");
  const std::string kind = GENERATE("vertex on vertex", "edge across edge", "edge along edge", "vertex on face",
                                    "edge on face", "face on face", "tilted face on face");
  const double gap = GENERATE(1e-9, 1e-8, 1e-7, 1e-6, 1.5e-6, 2e-6);
  CAPTURE(resolver, kind, gap);
  const Start s = start(kind);
  Scene scene;
  scene.contact.resolver = resolver_kind(resolver);
  scene.contact.tick_budget = INFINITY;
  scene.parts.push_back({"below", shared(s.below), Pose{}, false});
  scene.parts.push_back({"held", shared(s.held), {s.q, {0, 0, s.drop + gap}}, true});
  const FclOracle oracle(scene);
  const Pose X0 = scene.parts.back().pose;
  const auto run = [&](const std::vector<Pose>& pen, bool stays_above) {
    HapticLoop loop(scene);
    Pose last = X0;
    for (const Pose& Y : pen) {
      const TickReport& r = loop.step(Y, 1e-3);
      REQUIRE(r.status != ResolveStatus::infeasible);
      REQUIRE(r.status != ResolveStatus::stalled);
      for (const Pose& X : r.substeps) {
        const auto look = [&](const Pose& P) {
          REQUIRE(oracle.intersecting(P).empty());
          if (stays_above) REQUIRE(lowest(s.held, P) > 0);
        };
        for (const PathKind path : {PathKind::center, PathKind::origin})
          for_poses_between(last, X, loop.center(), 4, path, look);
        look(X);
        last = X;
      }
    }
    return last;
  };
  std::vector<Pose> pen;
  SECTION("out") {
    for (int i = 1; i <= 30; ++i) pen.push_back({X0.q, X0.p + Vec3(0, 0, 1e-4 * i)});
    for (int i = 0; i < 20; ++i) pen.push_back(pen.back());
    const Pose X = run(pen, true);
    CHECK((X.p - pen.back().p).norm() < 1e-9);
    CHECK(X.q.angularDistance(pen.back().q) < 1e-7);
  }
  SECTION("out and turning") {
    for (int i = 1; i <= 30; ++i) pen.push_back({rotation(Vec3(0, 0, 0.01 * i)) * X0.q, X0.p + Vec3(0, 0, 1e-4 * i)});
    for (int i = 0; i < 20; ++i) pen.push_back(pen.back());
    const Pose X = run(pen, true);
    CHECK((X.p - pen.back().p).norm() < 1e-9);
  }
  SECTION("in") {
    // Straight down: the body may slip sideways off a point or an edge, but never into the one below.
    for (int i = 1; i <= 40; ++i) pen.push_back({X0.q, X0.p + Vec3(0, 0, -1e-4 * i)});
    const bool flat_below = kind.find("on face") != std::string::npos;
    run(pen, flat_below);
  }
  SECTION("in at once") {
    pen.assign(20, {X0.q, X0.p + Vec3(0, 0, -0.05)});
    run(pen, false);
  }
}
