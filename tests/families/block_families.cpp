// Families of parts with plane faces.
#include <array>
#include <map>
#include <vector>

#include "families/family_tools.hpp"
#include "models/mesh_builder.hpp"
#include "models/shapes.hpp"

namespace tegotae::test {
namespace {

using Point = Eigen::Vector2d;

/// A prism along y about the origin: `corners` of a convex section (x, z), counter-clockwise seen against y; every side
/// of the section in `parts` parts, the length in `rows`.
std::shared_ptr<const TriangleMesh> prism(const std::vector<Point>& corners, double length, int parts, int rows) {
  shapes::MeshBuilder b("prism");
  Point middle = Point::Zero();
  for (const Point& q : corners) middle += q / static_cast<double>(corners.size());
  const auto section = [&](double y) {
    shapes::Ring ring;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point &from = corners[i], &to = corners[(i + 1) % corners.size()];
      for (int k = 0; k < parts; ++k) {
        const Point q = from + (to - from) * k / parts;
        ring.push_back(b.vertex({q.x(), y, q.y()}));
      }
    }
    return ring;
  };
  // Seen against y, x goes to the left when z is up: rings from +y to -y are counter-clockwise along their way.
  shapes::Ring last = section(length / 2);
  b.disk(shapes::Ring(last.rbegin(), last.rend()), b.vertex({middle.x(), length / 2, middle.y()}));
  for (int i = 1; i <= rows; ++i) {
    shapes::Ring next = section(length / 2 - length * i / rows);
    b.band(last, next);
    last = std::move(next);
  }
  b.disk(last, b.vertex({middle.x(), -length / 2, middle.y()}));
  return std::make_shared<const TriangleMesh>(b.take());
}

/// A bar lattice of cells by cells by 1 open cubes of side `pitch`, its bars a third of that thick, centered in x and y
/// on z = 0 to its height.
class Lattice {
 public:
  Lattice(int cells, double pitch) : bar_(pitch / 3), n_{3 * cells + 1, 3 * cells + 1, 4} {
    for (int i = 0; i < n_[0]; ++i)
      for (int j = 0; j < n_[1]; ++j)
        for (int k = 0; k < n_[2]; ++k)
          if (solid({i, j, k})) add_cube({i, j, k});
  }
  TriangleMesh mesh;

 private:
  using Cell = std::array<int, 3>;

  bool solid(const Cell& c) const {
    int on = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (c[axis] < 0 || c[axis] >= n_[axis]) return false;
      on += c[axis] % 3 == 0;
    }
    return on >= 2;
  }
  std::uint32_t corner(const Cell& c) {
    const auto [it, added] = index_.try_emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(bar_ * Vec3(c[0] - 0.5 * n_[0], c[1] - 0.5 * n_[1], c[2]));
    return it->second;
  }
  /// The faces of a cube to where nothing is.
  void add_cube(const Cell& c) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        Cell beside = c;
        beside[axis] += side;
        if (solid(beside)) continue;
        Cell at = c;
        at[axis] += side > 0;
        std::array<std::uint32_t, 4> q{};
        for (int k = 0; k < 4; ++k) {
          Cell v = at;
          v[(axis + 1) % 3] += k == 1 || k == 2;
          v[(axis + 2) % 3] += k >= 2;
          q[static_cast<std::size_t>(k)] = corner(v);
        }
        if (side < 0) std::swap(q[1], q[3]);
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
      }
    }
  }

  double bar_;
  Cell n_;
  std::map<Cell, std::uint32_t> index_;
};

}  // namespace

/// A tenon in a slot of three parts (floor and two jaws) with flanks of 60 degrees, pulled up until the flanks hold it.
FamilyCase dovetail(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  c.approach = Vec3::UnitZ();
  const double height = 0.2 * p.size, narrow = 0.12 * p.size, wide = narrow + height / std::sqrt(3.0);
  const double length = p.size, outside = 0.5 * p.size;
  const int parts = std::max(1, static_cast<int>(std::sqrt(p.triangles / 40.0)));
  const int rows = std::max(1, p.triangles / (8 * parts));
  const Point top_right(narrow, 0), low_right(wide, -height);
  const auto mirrored = [](const Point& q) { return Point(-q.x(), q.y()); };
  // From -x to +x below, then back above: counter-clockwise seen against y.
  add_fixed(c, prism({low_right, {outside, -height}, {outside, 0}, top_right}, 1.2 * length, parts, rows));
  add_fixed(c, prism({{-outside, -height}, mirrored(low_right), mirrored(top_right), {-outside, 0}}, 1.2 * length,
                     parts, rows));
  add_fixed(c, prism({{-outside, -1.5 * height}, {outside, -1.5 * height}, {outside, -height}, {-outside, -height}},
                     1.2 * length, parts, rows));
  // The tenon's flanks lie on the slot's, moved in by the clearance along their normals.
  const double in = p.clearance / std::sin(M_PI / 3), up = 0.1 * height, bottom = 0.85 * height;
  const auto half_width = [&](double depth) { return narrow + depth / std::sqrt(3.0) - in; };
  const Point low(half_width(bottom), -bottom), high(half_width(-up), up);
  c.start = 0.1 * height;
  c.gain = 2;
  c.guided = true;
  c.slide = 0.1 * p.size * Vec3::UnitY();
  c.flat = true;
  c.rest = FamilyCase::Range{2 * p.clearance, 2 * p.clearance};
  add_held(c, prism({mirrored(low), low, high, mirrored(high)}, length, parts, rows));
  return c;
}

FamilyCase lattice_on_lattice(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  constexpr double kTrianglesPerCell = 92;
  const int cells = std::max(1, static_cast<int>(std::sqrt(p.triangles / kTrianglesPerCell)));
  const double pitch = p.size / (cells + 1.0 / 3);
  const auto mesh = std::make_shared<const TriangleMesh>(std::move(Lattice(cells, pitch).mesh));
  const double height = 4 * pitch / 3;
  add_fixed(c, mesh);
  c.seat = {Quat(Eigen::AngleAxisd(choice(p, 0) ? 0.8 * draw(p, 2) : 0, Vec3::UnitZ())),
            Vec3(0.4 * pitch * draw(p, 3), 0.4 * pitch * draw(p, 4), height)};
  c.flat = true;
  c.rest = FamilyCase::Range{0, 0};
  add_held(c, mesh);
  return c;
}

/// A plate on blocks, each a part of its own; a seed in two has blocks of heights that differ by up to 20 um.
FamilyCase cover_on_blocks(const FamilyParameters& p) {
  constexpr double kUneven = 20e-6;
  FamilyCase c = case_for(p);
  const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(p.near))));
  const double pitch = p.size / side, width = 0.7 * pitch, thickness = 0.04 * p.size;
  const auto block = std::make_shared<const TriangleMesh>(shapes::box({width, width, width}));
  const double uneven = choice(p, 0) ? std::min(kUneven, 1e-3 * p.size) : 0;
  for (int i = 0; i < p.near; ++i) {
    const double low = uneven * draw(p, 10 + static_cast<unsigned>(i));
    add_fixed(c, block,
              {Quat::Identity(),
               {pitch * (i % side - 0.5 * (side - 1)), pitch * (i / side - 0.5 * (side - 1)), -width / 2 - low}});
  }
  c.seat.p.z() = thickness / 2;
  c.flat = true;
  c.rest = FamilyCase::Range{0, uneven};
  const int parts = std::max(1, static_cast<int>(std::sqrt(p.triangles / 4.0)));
  add_held(c, std::make_shared<const TriangleMesh>(shapes::box({p.size, p.size, thickness}, {parts, parts, 1})));
  return c;
}

}  // namespace tegotae::test
