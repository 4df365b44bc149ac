// Families of surfaces over a square: the die faces up, the held part lies on it.
#include <cstdint>
#include <vector>

#include "families/family_tools.hpp"

namespace tegotae::test {
namespace {

using shapes::Height;

// The die is larger than the part by this factor, so that the part's rim never hangs over the die's and hooks under it.
constexpr double kDie = 1.2;

/// Cells along the part's side, a multiple of ten: the die's are then as large, and their corners meet at the seat.
int part_cells(int triangles) {
  return std::max(10, (grid_cells(triangles) + 5) / 10 * 10);
}

int die_cells(int cells) {
  return static_cast<int>(std::lround(kDie * cells));
}

/// The held part: an open sheet, or a solid of the given thickness whose lower face is `z`.
std::shared_ptr<const TriangleMesh> upper_part(double size, int cells, const Height& z, bool solid, double thickness) {
  const shapes::Grid grid = {size, size, cells, cells};
  const Height top = [&](double x, double y) { return z(x, y) + thickness; };
  return welded(solid ? shapes::slab(grid, z, top) : shapes::sheet(grid, z));
}

Height scaled(const Height& z, double factor) {
  return [=](double x, double y) { return factor * z(x, y); };
}

/// A die of height `z` (from -amplitude or 0 to amplitude, which it reaches) and a part of the same shape that is
/// flatter by the clearance, so that it rests higher by as much.
struct Mating {
  Height z;
  double amplitude, slope, curvature;  // the largest of each
  double thickness = 0.05;             // of the solids, of the size
  bool solid = false;
};

FamilyCase mating(const FamilyParameters& p, const Mating& m) {
  FamilyCase c = case_for(p);
  // A seed in two has other triangles above than below.
  const int cells = part_cells(p.triangles), above = choice(p, 0) ? cells + 7 : cells;
  const double side = kDie * p.size;
  const int below = add_tiles(c, side, die_cells(cells), m.z, m.solid, -2 * m.amplitude - m.thickness * p.size);
  c.gain = std::hypot(1, m.slope);
  c.sagitta =
      sagitta(m.curvature, std::sqrt(2.0) * side / below) + sagitta(m.curvature, std::sqrt(2.0) * p.size / above);
  c.rest = FamilyCase::Range{-p.clearance, -p.clearance};
  const double factor = 1 - p.clearance / m.amplitude;
  add_held(c, upper_part(p.size, above, scaled(m.z, factor), m.solid, m.thickness * p.size));
  return c;
}

std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16, x *= 0x7feb352dU, x ^= x >> 15, x *= 0x846ca68bU, x ^= x >> 16;
  return x;
}

/// White noise in [-1, 1) over points a cell apart.
Height white_noise(double cell, unsigned seed) {
  return [=](double x, double y) {
    const auto i = static_cast<std::uint32_t>(std::llround(2 * x / cell));
    const auto k = static_cast<std::uint32_t>(std::llround(2 * y / cell));
    return hash(hash(hash(seed) + i) + k) / 2147483648.0 - 1;
  };
}

struct Stroke {
  Eigen::Vector2d from, to;
};

/// Seven-segment digits of the seed in lines over the square of side `size`.
std::vector<Stroke> digits(const FamilyParameters& p, int columns, int lines) {
  // Segments: top, upper left, upper right, middle, lower left, lower right, bottom; one bit each.
  static const unsigned kSegments[] = {0x77, 0x24, 0x5d, 0x6d, 0x2e, 0x6b, 0x7b, 0x25, 0x7f, 0x6f};
  static const double kEnds[7][4] = {{0, 2, 1, 2}, {0, 1, 0, 2}, {1, 1, 1, 2}, {0, 1, 1, 1},
                                     {0, 0, 0, 1}, {1, 0, 1, 1}, {0, 0, 1, 0}};
  std::vector<Stroke> strokes;
  const double pitch = p.size / columns, width = 0.5 * pitch, line = p.size / lines, height = 0.3 * line;
  for (int n = 0; n < columns * lines; ++n) {
    const unsigned bits = kSegments[static_cast<int>(10 * draw(p, 10 + static_cast<unsigned>(n)))];
    const Eigen::Vector2d corner(pitch * (n % columns + 0.25) - p.size / 2, line * (n / columns + 0.2) - p.size / 2);
    for (int s = 0; s < 7; ++s) {
      if ((bits >> s & 1U) == 0) continue;
      const double* e = kEnds[s];
      strokes.push_back({corner + Eigen::Vector2d(width * e[0], height * e[1]),
                         corner + Eigen::Vector2d(width * e[2], height * e[3])});
    }
  }
  return strokes;
}

/// Strokes of the given half width raised to `height` over 0, with flanks `flank` wide.
Height raised(const std::vector<Stroke>& strokes, double half_width, double flank, double height) {
  return [=](double x, double y) {
    double nearest = 1e300;
    const Eigen::Vector2d q(x, y);
    for (const Stroke& s : strokes) {
      const Eigen::Vector2d along = s.to - s.from;
      const double t = std::clamp((q - s.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (q - s.from - t * along).norm());
    }
    return height * std::clamp((half_width + flank - nearest) / flank, 0.0, 1.0);
  };
}

}  // namespace

FamilyCase wave_on_die(const FamilyParameters& p) {
  constexpr int kCellsPerWave = 10;
  const int most = std::max(2, part_cells(p.triangles) / kCellsPerWave);
  const int count = std::min(most, 2 + static_cast<int>(13 * draw(p, 2)));
  Mating m;
  m.amplitude = std::max(0.01 * p.size, 2 * p.clearance);
  const double k = 2 * M_PI * count / p.size;
  m.z = shapes::waves(m.amplitude, p.size / count);
  m.slope = m.amplitude * k;
  m.curvature = m.amplitude * k * k;
  m.solid = choice(p, 1);
  return mating(p, m);
}

FamilyCase saddle_on_saddle(const FamilyParameters& p) {
  Mating m;
  m.amplitude = p.size / 8;
  m.z = [size = p.size](double x, double y) { return (x * x - y * y) / (2 * size); };
  m.slope = std::sqrt(0.5);
  m.curvature = 1 / p.size;
  m.solid = choice(p, 1);
  return mating(p, m);
}

/// A shell of 0.3 mm (at a size of 0.1 m) over a domed mold.
FamilyCase shell_on_mold(const FamilyParameters& p) {
  Mating m;
  m.amplitude = 0.15 * p.size;
  const double k = M_PI / p.size;
  m.z = [a = m.amplitude, k](double x, double y) { return a * std::cos(k * x) * std::cos(k * y); };
  m.slope = m.amplitude * k;
  m.curvature = m.amplitude * k * k;
  m.solid = true;
  m.thickness = 0.003;
  return mating(p, m);
}

/// Plane on plane, turned and shifted, so that neither edges nor corners meet.
FamilyCase flat_on_flat(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  const bool solid = choice(p, 1);
  const Height plane = [](double, double) { return 0.0; };
  const int cells = part_cells(p.triangles);
  // Twice as large, so that the part stays on it where it is turned and shifted.
  add_tiles(c, 2 * p.size, cells, plane, solid, -0.05 * p.size);
  c.seat = {Quat(Eigen::AngleAxisd(0.3 * draw(p, 2), Vec3::UnitZ())),
            p.size * Vec3(0.2 * draw(p, 3), 0.2 * draw(p, 4), 0)};
  c.flat = true;
  c.rest = FamilyCase::Range{0, 0};
  add_held(c, upper_part(p.size, cells, plane, solid, 0.05 * p.size));
  return c;
}

/// Raised digits under a part in which they are engraved, wider by the clearance. Both have the same grid, and no point
/// of the lower surface is higher than the same point of the upper one, so they rest on their planes.
FamilyCase text_on_text(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  const int cells = part_cells(p.triangles);
  const double cell = p.size / cells;
  const double flank = std::max(0.01 * p.size, 2 * cell), height = std::min(0.02 * p.size, 2 * flank);
  const auto strokes = digits(p, 2 + static_cast<int>(4 * draw(p, 2)), 2);
  const double half_width = 0.01 * p.size;
  FamilyParameters one = p;
  one.near = 1;
  c.parameters = one;
  add_tiles(c, kDie * p.size, die_cells(cells), raised(strokes, half_width, flank, height), choice(p, 1),
            -0.05 * p.size);
  c.gain = std::hypot(1, height / flank);
  c.rest = FamilyCase::Range{0, 0};
  add_held(c, upper_part(p.size, cells, raised(strokes, half_width + p.clearance, flank, height), choice(p, 1),
                         0.05 * p.size));
  return c;
}

/// Two rough planes; a seed in two has the same roughness on both, as an imprint has, and then they fit to the last
/// bit.
FamilyCase noise_on_noise(const FamilyParameters& p) {
  FamilyCase c = case_for(p);
  FamilyParameters one = p;
  one.near = 1;
  c.parameters = one;
  const bool imprint = choice(p, 0);
  const int cells = part_cells(p.triangles), above = imprint ? cells : cells + 3;
  const double amplitude = (0.01 + 0.1 * draw(p, 2)) * p.size / cells;
  const Height below = scaled(white_noise(p.size / cells, p.seed), amplitude);
  const Height other = scaled(white_noise(p.size / above, p.seed + 1), amplitude);
  add_tiles(c, kDie * p.size, die_cells(cells), below, choice(p, 1), -0.05 * p.size);
  c.gain = std::hypot(1, 3 * amplitude * cells / p.size);
  if (imprint)
    c.rest = FamilyCase::Range{0, 0};
  else
    c.rest = FamilyCase::Range{-2 * amplitude, 2 * amplitude};
  add_held(c, upper_part(p.size, above, imprint ? below : other, choice(p, 1), 0.05 * p.size));
  return c;
}

}  // namespace tegotae::test
