#include "import/part_file.hpp"

#include <cmath>
#include <limits>

#include "import/file_check.hpp"
#include "import/gltf_read.hpp"
#include "import/note_texts.hpp"
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

namespace {

/// Parts that their place leaves no volume are told; those without any extent, a way to hide a node, are left out.
void note_flat(PartFile& file) {
  constexpr double kFlat = 1e-9;  // of the cube of the largest entry; matrices are of floats
  ImportNotes notes;
  std::vector<PartFile::Placed> parts;
  for (PartFile::Placed& part : file.parts) {
    const Mat3 A = part.X.leftCols<3>();
    const double largest = A.cwiseAbs().maxCoeff();
    if (largest == 0)
      notes.add(note_texts::kScaledAway, '"' + part.name + '"');
    else if (std::abs((A / largest).determinant()) <= kFlat)
      notes.add(note_texts::kFlat, '"' + part.name + '"');
    if (largest != 0) parts.push_back(std::move(part));
  }
  file.parts = std::move(parts);
  notes.write_to(file.notes);
}

}  // namespace

PartFile read_part_file(const std::string& path) {
  PartFile file = lower_extension(path) == ".3mf" ? read_3mf(path) : read_gltf(path);
  note_flat(file);
  return file;
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
