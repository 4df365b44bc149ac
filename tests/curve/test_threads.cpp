// Threads and gears of the model generator against their standards.
#include <cmath>
#include <map>

#include "catch.hpp"
#include "models/gear.hpp"
#include "models/threaded.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/mesh/mass.hpp"
#include "tegotae/mesh/report.hpp"

using namespace tegotae;
using namespace tegotae::shapes;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Every edge is used once each way: closed, and all faces turned alike.
bool closed(const TriangleMesh& m) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : m.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [e, n] : edges)
    if (n != 1 || edges.count({e.second, e.first}) == 0) return false;
  return true;
}

double volume(const TriangleMesh& m) {
  double sum = 0;
  for (const auto& t : m.triangles) sum += m.vertices[t[0]].dot(m.vertices[t[1]].cross(m.vertices[t[2]])) / 6;
  return sum;
}

/// Area of a thread's section: across the axis a thread of one start has the same area everywhere. From ISO 68-1:
/// r over a pitch goes from the major radius (an eighth) down to the minor one (a quarter) and up again.
double thread_section(double major, double pitch) {
  const double depth = 0.625 * std::sqrt(3.0) / 2 * pitch, minor = major - depth;
  const double flank = (major * major + major * minor + minor * minor) / 3;
  return kPi * (major * major / 8 + minor * minor / 4 + flank * 5 / 8);
}

}  // namespace

TEST_CASE("bolts and nuts are closed and have the volume of their thread", "[curve]") {
  for (const bool left : {false, true}) {
    Bolt b;
    b.chamfer = 0;
    b.thread = {0.016, 0.002, left, 192, 4};
    const TriangleMesh bolt_mesh = bolt(b);
    CHECK(closed(bolt_mesh));
    const double hexagon = std::sqrt(3.0) / 2 * b.head_width * b.head_width;
    CHECK(volume(bolt_mesh) == Approx(thread_section(0.008, 0.002) * b.length + hexagon * b.head_height).epsilon(1e-3));
    Nut n;
    n.chamfer = 0;
    n.thread = b.thread;
    const TriangleMesh nut_mesh = nut(n);
    CHECK(closed(nut_mesh));
    CHECK(volume(nut_mesh) ==
          Approx((std::sqrt(3.0) / 2 * n.width * n.width - thread_section(0.008 + n.play * std::sqrt(3.0), 0.002)) *
                 n.height)
              .epsilon(1e-3));
  }
  CHECK(closed(bolt({})));
  CHECK(closed(nut({})));
}

TEST_CASE("a thread's corners lie on its helicoid", "[curve]") {
  Bolt b;
  b.thread.left_hand = true;
  const double pitch = b.thread.pitch, crest = b.thread.diameter / 2, root = crest - 0.625 * std::sqrt(3.0) / 2 * pitch;
  const TriangleMesh m = bolt(b);
  int seen = 0;
  for (const Vec3& v : m.vertices) {
    const double r = v.head<2>().norm();
    if (v.z() < 0.003 || v.z() > b.length - 1e-6 || r > crest + 1e-9) continue;
    // Left hand: it rises against the angle. The distance along z from the middle of a crest:
    const double w = std::abs(std::remainder(v.z() + pitch * std::atan2(v.y(), v.x()) / (2 * kPi), pitch));
    const double expected = std::max(root, std::min(crest, crest - (w - pitch / 16) * std::sqrt(3.0)));
    REQUIRE(r == Approx(expected).margin(1e-9));
    ++seen;
  }
  CHECK(seen > 1000);
}

TEST_CASE("gears are closed, and their flanks are involutes of their base circle", "[curve]") {
  const Gear g;
  const TriangleMesh m = gear(g);
  CHECK(closed(m));
  const double pitch = g.module * g.teeth / 2, base = pitch * std::cos(g.pressure_angle);
  // The normal of an involute touches the base circle: so does, nearly, the one of the chord between two corners.
  int seen = 0;
  for (const auto& t : m.triangles) {
    const Vec3 &a = m.vertices[t[0]], &b = m.vertices[t[1]], &c = m.vertices[t[2]];
    const Vec3 n = (b - a).cross(c - a).normalized();
    const double low = std::min({a.head<2>().norm(), b.head<2>().norm(), c.head<2>().norm()});
    const double high = std::max({a.head<2>().norm(), b.head<2>().norm(), c.head<2>().norm()});
    if (std::abs(n.z()) > 0.1 || low < base - 1e-9 || high - low < 1e-5) continue;
    Vec3 middle = Vec3::Zero();
    int corners = 0;
    for (const Vec3* v : {&a, &b, &c}) {
      if (std::abs(v->z()) < 1e-9) middle += *v, ++corners;
    }
    if (corners != 2) continue;
    middle /= 2;
    REQUIRE(std::abs(middle.x() * n.y() - middle.y() * n.x()) == Approx(base).epsilon(0.01));
    ++seen;
  }
  CHECK(seen > 100);
}

TEST_CASE("impossible threads and gears are refused", "[curve]") {
  Bolt b;
  b.thread.segments = 50;
  CHECK_THROWS_AS(bolt(b), Error);
  Nut n;
  n.play = n.thread.pitch;
  CHECK_THROWS_AS(nut(n), Error);
  Gear g;
  g.bore = 1;
  CHECK_THROWS_AS(gear(g), Error);
}
