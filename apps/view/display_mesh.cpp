#include "view/display_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace tegotae::view {
namespace {

constexpr int kMaxTries = 12;

DisplayMesh whole(const TriangleMesh& mesh) {
  DisplayMesh out;
  out.positions.reserve(3 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices)
    for (int i = 0; i < 3; ++i) out.positions.push_back(static_cast<float>(v[i]));
  out.indices.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
  return out;
}

/// Cells of `size` (m): each becomes one vertex, the mean of its own. Triangles that collapse go.
DisplayMesh clustered(const TriangleMesh& mesh, const Vec3& low, double size) {
  std::unordered_map<std::uint64_t, std::uint32_t> cells;
  std::vector<std::uint32_t> cell_of(mesh.vertices.size());
  std::vector<Vec3> sums;
  std::vector<int> counts;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 c = ((mesh.vertices[i] - low) / size).array().floor();
    const auto key = static_cast<std::uint64_t>(c.x()) << 42 | static_cast<std::uint64_t>(c.y()) << 21 |
                     static_cast<std::uint64_t>(c.z());
    const auto [at, fresh] = cells.try_emplace(key, static_cast<std::uint32_t>(sums.size()));
    if (fresh) {
      sums.push_back(Vec3::Zero());
      counts.push_back(0);
    }
    cell_of[i] = at->second;
    sums[at->second] += mesh.vertices[i];
    ++counts[at->second];
  }
  DisplayMesh out;
  for (std::size_t i = 0; i < sums.size(); ++i)
    for (int k = 0; k < 3; ++k) out.positions.push_back(static_cast<float>(sums[i][k] / counts[i]));
  for (const auto& t : mesh.triangles) {
    const std::uint32_t a = cell_of[t[0]], b = cell_of[t[1]], c = cell_of[t[2]];
    if (a != b && b != c && c != a) out.indices.insert(out.indices.end(), {a, b, c});
  }
  return out;
}

}  // namespace

DisplayMesh display_mesh(const TriangleMesh& mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) return whole(mesh);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  // Between cells that are surely too coarse and cells that are surely too fine (and 2^20 a side fit into a key).
  double coarse = (high - low).maxCoeff(), fine = coarse / (1 << 20);
  DisplayMesh best = clustered(mesh, low, coarse);
  for (int i = 0; i < kMaxTries; ++i) {
    const double size = std::sqrt(coarse * fine);
    DisplayMesh next = clustered(mesh, low, size);
    const bool fits = next.indices.size() <= 3 * most;
    (fits ? coarse : fine) = size;
    if (fits) best = std::move(next);
  }
  return best;
}

}  // namespace tegotae::view
