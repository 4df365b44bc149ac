#include "models/threaded.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numbers.hpp"
#include "models/mesh_builder.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::shapes {
namespace {

/// Height of the sharp triangle over the pitch; of it a quarter is cut off at the root and an eighth at the crest.
const double kSharp = std::sqrt(3.0) / 2;
/// Profile points closer than this part of the pitch to an end are left out there.
constexpr double kEndGap = 1e-3;

/// The radius along the axis at the azimuth 0, one pitch long: crest, flank, root, flank.
struct Outline {
  std::vector<double> w, r;
};

Outline outline(const Thread& t, double wider) {
  const double crest = t.pitch / 8, root = t.pitch / 4, flank = (t.pitch - crest - root) / 2;
  const double major = t.diameter / 2 + wider, minor = major - 0.625 * kSharp * t.pitch;
  Outline o;
  const auto add = [&o](double w, double r) {
    o.w.push_back(w);
    o.r.push_back(r);
  };
  for (int i = 0; i <= t.rows; ++i) add(crest / 2 + flank * i / t.rows, major + (minor - major) * i / t.rows);
  for (int i = 0; i <= t.rows; ++i)
    add(crest / 2 + flank + root + flank * i / t.rows, minor + (major - minor) * i / t.rows);
  return o;
}

double radius_at(const Outline& o, double pitch, double w) {
  const double first = o.w.front();
  double u = w - pitch * std::floor((w - first) / pitch);  // in [first, first + pitch)
  for (std::size_t i = 0; i + 1 < o.w.size(); ++i)
    if (u <= o.w[i + 1]) return o.r[i] + (o.r[i + 1] - o.r[i]) * (u - o.w[i]) / (o.w[i + 1] - o.w[i]);
  return o.r.back();  // the crest, which closes the pitch
}

/// One side of a strip: the points of a column from its lower to its upper end. `line` numbers the helices.
struct Column {
  std::vector<long> line;
  Ring vertex;
};

/// The threaded wall between z0 and z1, its columns and the polygons at its ends. `radius(r, z)` is what the thread's
/// radius r becomes at the height z.
template <typename Radius>
class Wall {
 public:
  Wall(MeshBuilder& b, const Thread& t, double wider, double z0, double z1, Radius radius)
      : b_(b), t_(t), o_(outline(t, wider)), z0_(z0), z1_(z1), radius_(radius) {
    for (int i = 0; i < t.segments; ++i) columns_.push_back(column(i));
    for (const Column& c : columns_) {
      low.push_back(c.vertex.front());
      high.push_back(c.vertex.back());
    }
  }

  /// The band between neighboring columns, facing away from the axis or towards it.
  void close(bool outward) {
    const std::size_t n = columns_.size();
    for (std::size_t i = 0; i < n; ++i) {
      // The helices of the first column, met after a turn, have moved on by one pitch for each start.
      const bool seam = i + 1 == n;
      const long shift = seam ? (t_.left_hand ? 1 : -1) * t_.starts * static_cast<long>(o_.w.size()) : 0;
      strip(columns_[i], columns_[(i + 1) % n], shift, outward);
    }
  }

  Ring low, high;  ///< counter-clockwise from above

 private:
  Column column(int i) {
    Column c;
    const double turn = static_cast<double>(i) / t_.segments, angle = 2 * kPi * turn;
    const double rise = (t_.left_hand ? -1 : 1) * t_.starts * t_.pitch * turn;
    const auto add = [&](long line, double w) {
      const double z = w + rise;
      const double r = radius_(radius_at(o_, t_.pitch, w), z);
      c.line.push_back(line);
      c.vertex.push_back(b_.vertex({r * std::cos(angle), r * std::sin(angle), z}));
    };
    const double gap = kEndGap * t_.pitch;
    const long points = static_cast<long>(o_.w.size());
    add(kFirst, z0_ - rise);
    const long begin = static_cast<long>(std::floor((z0_ - rise) / t_.pitch)) - 1;
    const long end = static_cast<long>(std::ceil((z1_ - rise) / t_.pitch)) + 1;
    for (long k = begin * points; k < end * points; ++k) {
      const long turns = static_cast<long>(std::floor(static_cast<double>(k) / static_cast<double>(points)));
      const double w = o_.w[static_cast<std::size_t>(k - turns * points)] + t_.pitch * static_cast<double>(turns);
      if (w + rise > z0_ + gap && w + rise < z1_ - gap) add(k, w);
    }
    add(kLast, z1_ - rise);
    return c;
  }

  void strip(const Column& a, const Column& b, long shift, bool outward) {
    const auto of_b = [&](std::size_t j) { return j == 0 || j + 1 == b.line.size() ? b.line[j] : b.line[j] + shift; };
    const auto face = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
      outward ? b_.face(p, q, r) : b_.face(p, r, q);
    };
    std::size_t i = 0, j = 0;
    while (i + 1 < a.line.size() || j + 1 < b.line.size()) {
      const bool a_left = i + 1 < a.line.size(), b_left = j + 1 < b.line.size();
      const bool go_a = a_left && (!b_left || a.line[i + 1] <= of_b(j + 1));
      const bool go_b = b_left && (!a_left || of_b(j + 1) <= a.line[i + 1]);
      if (go_b) face(a.vertex[i], b.vertex[j], b.vertex[j + 1]);
      if (go_a) face(a.vertex[i], b.vertex[go_b ? j + 1 : j], a.vertex[i + 1]);
      i += go_a;
      j += go_b;
    }
  }

  static constexpr long kFirst = -1000000000, kLast = 1000000000;
  MeshBuilder& b_;
  const Thread t_;
  const Outline o_;
  double z0_, z1_;
  Radius radius_;
  std::vector<Column> columns_;
};

Ring hexagon(MeshBuilder& b, double width, double z, int segments) {
  Ring out;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * kPi * i / segments;
    const double in_side = std::remainder(angle - kPi / 6, kPi / 3);
    const double r = 0.5 * width / std::cos(in_side);
    out.push_back(b.vertex({r * std::cos(angle), r * std::sin(angle), z}));
  }
  return out;
}

void check(const Thread& t, double length, double width) {
  const double depth = 0.625 * kSharp * t.pitch;
  if (!(t.pitch > 0 && t.diameter > 4 * depth)) throw Error("a thread needs a pitch, and a diameter of some pitches");
  if (t.segments < 12 || t.segments % 6 != 0) throw Error("a thread's number of segments must be a multiple of 6");
  if (t.rows < 1 || t.rows > 16) throw Error("a thread's flank has 1 to 16 rows");
  if (t.starts < 1 || t.starts > 8) throw Error("a thread has 1 to 8 starts");
  if (!(length > t.pitch)) throw Error("a thread must be longer than its pitch");
  if (!(width > 1.1 * t.diameter)) throw Error("a hexagon must be wider than its thread");
}

}  // namespace

TriangleMesh bolt(const Bolt& p) {
  check(p.thread, p.length, p.head_width);
  if (!(p.chamfer >= 0 && p.chamfer < p.thread.diameter / 4 && p.head_height > 0))
    throw Error("a bolt needs a head, and a chamfer smaller than a quarter of its diameter");
  if (!(p.shank >= 0 && p.runout >= 0 && p.length - p.shank - p.runout > p.thread.pitch))
    throw Error("a bolt's shank and run-out must leave a thread of some length");
  MeshBuilder b("bolt");
  const double major = p.thread.diameter / 2, tip = major - p.chamfer, depth = 0.625 * kSharp * p.thread.pitch;
  // The root rises along a cone, as a die leaves it.
  const double end = p.length - p.shank;
  const auto root = [=](double z) {
    if (z > end) return major;
    return p.runout > 0 ? major - depth * (end - z) / p.runout : 0.0;
  };
  Wall wall(b, p.thread, 0, 0, p.length, [=](double r, double z) { return std::min(std::max(r, root(z)), tip + z); });
  wall.close(true);
  b.disk(Ring(wall.low.rbegin(), wall.low.rend()), b.vertex({0, 0, 0}));
  const Ring under = hexagon(b, p.head_width, p.length, p.thread.segments);
  const Ring top = hexagon(b, p.head_width, p.length + p.head_height, p.thread.segments);
  b.band(wall.high, under);
  b.band(under, top);
  b.disk(top, b.vertex({0, 0, p.length + p.head_height}));
  return b.take();
}

TriangleMesh nut(const Nut& p) {
  check(p.thread, p.height, p.width);
  if (!(p.play >= 0 && p.play < p.thread.pitch / 8))
    throw Error("a nut's play must be smaller than an eighth of its pitch");
  if (!(p.chamfer >= 0 && 2 * p.chamfer < p.height && p.thread.diameter + 2 * p.chamfer < 0.95 * p.width))
    throw Error("a nut's chamfers do not fit");
  MeshBuilder b("nut");
  // A flank that stands back by dr leaves dr · tan 30° along the axis. Facets reach into the hole: corners go outward.
  const double wider = p.play * std::sqrt(3.0), stretch = 1 / std::cos(kPi / p.thread.segments);
  const double rim = p.chamfer > 0 ? p.thread.diameter / 2 + wider + p.chamfer : 0;
  Wall wall(b, p.thread, wider, 0, p.height, [=](double r, double z) {
    return stretch * std::max({r, rim - z, rim - (p.height - z)});
  });
  wall.close(false);
  const Ring low = hexagon(b, p.width, 0, p.thread.segments), high = hexagon(b, p.width, p.height, p.thread.segments);
  b.band(low, high);
  b.band(high, wall.high);
  b.band(wall.low, low);
  return b.take();
}

}  // namespace tegotae::shapes
