#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "mesh/precision.hpp"
#include "mesh/topology.hpp"
#include "tegotae/mesh/weld.hpp"

namespace tegotae {
namespace {

/// Cells of the tolerance pass, in tolerances: large enough that few vertices lie near a cell wall.
constexpr double kCellSize = 16.0;
/// So many vertices ahead memory is asked for what the table has for one: it is too large for a processor's caches.
constexpr std::size_t kAhead = 16;

std::uint64_t mix(std::uint64_t h, std::uint64_t v) {
  h = (h ^ v) * 0x9e3779b97f4a7c15ull;
  return h ^ (h >> 32);
}

using Key = std::array<std::int64_t, 3>;

/// Open-addressing table of vertex indices; entries of equal hash follow each other.
class VertexTable {
 public:
  explicit VertexTable(std::size_t n) {
    std::size_t size = 16;
    while (size < 2 * n) size *= 2;
    slots_.assign(size, kNone);
  }

  /// The first vertex filed under `key`'s hash that `same` accepts, or kNone.
  template <class Same>
  std::uint32_t find(const Key& key, const Same& same) const {
    for (std::size_t s = home(key);; s = (s + 1) & (slots_.size() - 1)) {
      if (slots_[s] == kNone || same(slots_[s])) return slots_[s];
    }
  }

  /// What find() will look at first is on its way.
  void fetch(const Key& key) const { __builtin_prefetch(&slots_[home(key)]); }

  void insert(const Key& key, std::uint32_t vertex) {
    std::size_t s = home(key);
    while (slots_[s] != kNone) s = (s + 1) & (slots_.size() - 1);
    slots_[s] = vertex;
  }

 private:
  std::size_t home(const Key& key) const {
    std::uint64_t h = 0;
    for (const std::int64_t k : key) h = mix(h, static_cast<std::uint64_t>(k));
    return h & (slots_.size() - 1);
  }
  std::vector<std::uint32_t> slots_;
};

Key bits(const Vec3& p) {
  Key key;
  for (int i = 0; i < 3; ++i) {
    const double x = p[i] + 0.0;  // -0 and 0 are one place
    std::memcpy(&key[i], &x, sizeof x);
  }
  return key;
}

/// For every vertex the first bit-equal one.
std::vector<std::uint32_t> first_equal(const std::vector<Vec3>& vertices) {
  VertexTable table(vertices.size());
  std::vector<std::uint32_t> first(vertices.size());
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (v + kAhead < vertices.size()) table.fetch(bits(vertices[v + kAhead]));
    const Key key = bits(vertices[v]);
    first[v] = table.find(key, [&](std::uint32_t other) { return bits(vertices[other]) == key; });
    if (first[v] == kNone) {
      table.insert(key, v);
      first[v] = v;
    }
  }
  return first;
}

/// Sends every representative in `first` to the first one within `tolerance` of it. A vertex that has been taken in
/// takes in no others, so nothing moves by more than the tolerance.
void join_near(const std::vector<Vec3>& vertices, double tolerance, std::vector<std::uint32_t>& first) {
  const double cell = kCellSize * tolerance;
  const auto key_of = [cell](const Vec3& p) {
    return Key{std::llround(p.x() / cell), std::llround(p.y() / cell), std::llround(p.z() / cell)};
  };
  std::size_t places = 0;
  for (std::uint32_t v = 0; v < vertices.size(); ++v) places += first[v] == v ? 1 : 0;
  VertexTable table(places);
  for (std::uint32_t v = 0; v < vertices.size(); ++v) {
    if (first[v] != v) continue;  // bit-equal to an earlier vertex
    const Vec3& p = vertices[v];
    const auto near = [&](std::uint32_t other) { return (vertices[other] - p).squaredNorm() <= tolerance * tolerance; };
    const Key lo = key_of(p - Vec3::Constant(tolerance)), hi = key_of(p + Vec3::Constant(tolerance));
    std::uint32_t found = kNone;
    for (std::int64_t x = lo[0]; x <= hi[0] && found == kNone; ++x) {
      for (std::int64_t y = lo[1]; y <= hi[1] && found == kNone; ++y) {
        for (std::int64_t z = lo[2]; z <= hi[2] && found == kNone; ++z) found = table.find({x, y, z}, near);
      }
    }
    if (found == kNone) {
      table.insert(key_of(p), v);
    } else {
      first[v] = found;
    }
  }
}

}  // namespace

TriangleMesh weld(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> first = first_equal(mesh.vertices);
  const double step = rounding_step(mesh);
  if (step > 0) join_near(mesh.vertices, step, first);

  TriangleMesh out;
  out.name = mesh.name;
  out.notes = mesh.notes;
  out.triangles.reserve(mesh.triangles.size());
  std::vector<std::uint32_t> index(mesh.vertices.size(), kNone);
  for (const auto& t : mesh.triangles) {
    std::array<std::uint32_t, 3> corners;
    for (int k = 0; k < 3; ++k) {
      // Two hops: to the first bit-equal vertex, and from there to the one it was joined to.
      const std::uint32_t v = first[first[t[k]]];
      if (index[v] == kNone) {
        index[v] = static_cast<std::uint32_t>(out.vertices.size());
        out.vertices.push_back(mesh.vertices[v]);
      }
      corners[k] = index[v];
    }
    out.triangles.push_back(corners);
  }
  return out;
}

}  // namespace tegotae
