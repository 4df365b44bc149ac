#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/output_file.hpp"
#include "tegotae/import/write.hpp"

namespace tegotae {
namespace {

// Coordinates nearer to zero than this (file units) are noise and written as zero.
constexpr double kNoise = 1e-12;

/// The four bytes of a float or an integer, highest first: assimp 5.2 skips bytes at the start of a binary body that
/// look like line ends, and the highest byte of a float of a part's size never does, while the lowest may.
template <typename T>
void append(std::string& bytes, T value) {
  static_assert(sizeof(T) == 4);
  std::uint32_t word = 0;
  std::memcpy(&word, &value, 4);
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(word >> (24 - 8 * i)));
}

}  // namespace

void write_ply(const TriangleMesh& mesh, const std::string& path, double unit_in_m) {
  std::string bytes = "ply\nformat binary_big_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  bytes.reserve(bytes.size() + 12 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (const Vec3& p : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      const double x = p[k] / unit_in_m;
      append(bytes, std::abs(x) < kNoise ? 0.0f : static_cast<float>(x));
    }
  }
  for (const auto& t : mesh.triangles) {
    bytes.push_back(3);
    for (const std::uint32_t v : t) append(bytes, v);
  }
  write_file(path, bytes);
}

}  // namespace tegotae
