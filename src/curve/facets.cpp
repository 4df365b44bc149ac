#include "curve/facets.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace tegotae {
namespace {

/// Facets that are looked at; of larger meshes a sample.
constexpr std::size_t kMaxFacets = 8000;

using Key = std::array<double, 9>;

/// The three corners, least first: the same for every order in which they are listed.
Key key_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  std::array<Vec3, 3> v{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  std::sort(v.begin(), v.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  return {v[0].x(), v[0].y(), v[0].z(), v[1].x(), v[1].y(), v[1].z(), v[2].x(), v[2].y(), v[2].z()};
}

std::uint64_t hash_of(const Key& key) {
  std::uint64_t h = 0x9e3779b97f4a7c15ull;
  for (const double x : key) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    h = (h ^ bits) * 0xd6e8feb86659fd93ull;
    h ^= h >> 29;
  }
  return h;
}

/// Numbers of the triangles that are looked at.
std::vector<std::uint32_t> sample(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> chosen(mesh.triangles.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  if (chosen.size() <= kMaxFacets) return chosen;
  std::vector<std::uint64_t> hash(chosen.size());
  for (const std::uint32_t t : chosen) hash[t] = hash_of(key_of(mesh, mesh.triangles[t]));
  std::vector<std::uint64_t> sorted = hash;
  std::nth_element(sorted.begin(), sorted.begin() + kMaxFacets, sorted.end());
  // Equal faces have equal hashes and stay or go together.
  const std::uint64_t bound = sorted[kMaxFacets];
  chosen.erase(std::remove_if(chosen.begin(), chosen.end(), [&](std::uint32_t t) { return hash[t] >= bound; }),
               chosen.end());
  return chosen;
}

}  // namespace

Facets::Facets(const TriangleMesh& mesh) {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      lo = lo.cwiseMin(mesh.vertices[v]);
      hi = hi.cwiseMax(mesh.vertices[v]);
    }
  }
  middle = 0.5 * (lo + hi);
  size = 0.5 * (hi - lo).norm();
  if (!(size > 0) || !std::isfinite(size)) return;
  std::vector<Key> keys;
  for (const std::uint32_t t : sample(mesh)) keys.push_back(key_of(mesh, mesh.triangles[t]));
  std::sort(keys.begin(), keys.end());
  for (const Key& k : keys) add({Vec3(k[0], k[1], k[2]), Vec3(k[3], k[4], k[5]), Vec3(k[6], k[7], k[8])});
}

void Facets::add(const std::array<Vec3, 3>& corners) {
  std::array<Vec3, 3> v;
  for (int i = 0; i < 3; ++i) v[i] = (corners[i] - middle) / size;
  Facet f;
  f.center = (v[0] + v[1] + v[2]) / 3;
  for (int i = 0; i < 3; ++i) f.edge[i] = v[(i + 1) % 3] - v[i];
  for (int i = 0; i < 3; ++i) f.corner[i] = f.center + (f.edge[(i + 2) % 3] - f.edge[i]) / 3;
  f.normal = f.edge[0].cross(f.edge[1]);
  const double length = f.normal.norm();
  const double longest = std::max({f.edge[0].squaredNorm(), f.edge[1].squaredNorm(), f.edge[2].squaredNorm()});
  if (!(length > 1e-6 * longest)) return;
  f.normal /= length;
  f.area = 0.5 * length;
  area += f.area;
  all.push_back(f);
}

}  // namespace tegotae
