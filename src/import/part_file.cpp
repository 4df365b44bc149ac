#include "import/part_file.hpp"

#include <limits>

#include "import/file_check.hpp"
#include "import/gltf_read.hpp"
#include "import/threemf_read.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

Matrix34 product(const Matrix34& a, const Matrix34& b) {
  Matrix34 c = a.leftCols<3>() * b;
  c.col(3) += a.col(3);
  return c;
}

bool is_part_file(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".gltf" || extension == ".glb" || extension == ".3mf";
}

PartFile read_part_file(const std::string& path) {
  return lower_extension(path) == ".3mf" ? read_3mf(path) : read_gltf(path);
}

void append(const TriangleMesh& from, const Matrix34& X, double unit, TriangleMesh& to) {
  const std::size_t base = to.vertices.size();
  // Indices are 32 bits wide, and so are half-edges (3 per triangle).
  constexpr std::size_t kMax = std::numeric_limits<std::uint32_t>::max() / 4;
  if (base + from.vertices.size() > kMax || to.triangles.size() + from.triangles.size() > kMax)
    throw Error(to.name + ": too large: more than a billion vertices or triangles");
  to.vertices.reserve(base + from.vertices.size());
  for (const Vec3& p : from.vertices) to.vertices.push_back(unit * (X.leftCols<3>() * p + X.col(3)));
  const bool mirrored = X.leftCols<3>().determinant() < 0;  // turns faces inside out
  const auto at = [base](std::uint32_t k) { return static_cast<std::uint32_t>(base + k); };
  for (const auto& t : from.triangles)
    to.triangles.push_back(mirrored ? std::array<std::uint32_t, 3>{at(t[0]), at(t[2]), at(t[1])}
                                    : std::array<std::uint32_t, 3>{at(t[0]), at(t[1]), at(t[2])});
}

}  // namespace tegotae
